//! What the scan's noise allows: a surface to measure on, and the radius at which its curvature is
//! known.

use crate::geometry::{curvature_noise, noise, smooth};
use crate::parameters::{Denoise, Parameters};
use crate::surface::Surface;
use crate::warning::Warning;

/// Noise up to this, in mm, is left: over 10 mm on edges of 2 mm it blurs curvature by 0.7 1/m, 3 to
/// 5 % of a limb's.
const HARMLESS_MM: f64 = 0.05;

/// Curvature should be known to this standard deviation, in 1/mm: 5 to 8 % of a limb's 15 to 25 1/m.
const BLUR: f64 = 0.0012;

/// The radius grows no further than this, in mm: beyond, a wrist is half a patch.
const LARGEST_MM: f64 = 20.0;

/// A surface fit to be measured.
pub(crate) struct Calm {
    /// The surface smoothed, if it was noisy.
    pub smoothed: Option<Surface>,
    /// Radius over which its curvature is read, in mm.
    pub radius: f64,
    /// What was done.
    pub warning: Option<Warning>,
}

/// Smooths a noisy scan, and chooses the radius of curvature that its noise allows.
pub(crate) fn calm(surface: &Surface, parameters: &Parameters) -> Calm {
    let radius = parameters.curvature_radius;
    let noise = if parameters.denoise == Denoise::Off { 0.0 } else { noise(surface) };
    if noise <= HARMLESS_MM {
        return Calm { smoothed: None, radius, warning: None };
    }
    // The blur falls with the cube of the radius: its square, and the root of the number of vertices.
    let excess = curvature_noise(surface, noise, radius) / BLUR;
    let allowed = (radius * excess.cbrt()).clamp(radius, LARGEST_MM.max(radius));
    let smoothed = Some(smooth(surface, radius));
    let message = format!(
        "the scan's noise is about {noise:.2} mm: its surface was smoothed over {radius:.0} mm, and \
         curvature is read over {allowed:.1} mm, at which it is known to about {:.1} per m; \
         bony crests narrower than that are flattened, check the pressure there",
        1000.0 * curvature_noise(surface, noise, allowed)
    );
    let warning = Some(Warning::new("noisy_scan", message));
    Calm { smoothed, radius: allowed, warning }
}
