//! Coordinates in mm, rounded so that the unit in which they were given leaves no trace.
//!
//! Converting metres or inches leaves differences of about 1e-13 mm on a limb. A fit of thousands
//! of steps, in which nodes come and go, makes 1e-6 mm of them. So surface and design come in on
//! one grid of a millionth of a millimetre: nothing to a limb, and no more than 0.001 1/m in the
//! curvature of a mesh with 2 mm edges. Numbers of up to six decimals stay as they were typed.

use glam::DVec3;

use crate::units::LengthUnit;

/// Steps of the grid in one mm.
const PER_MM: f64 = 1e6;

/// The grid's step, in mm.
pub(crate) const GRID: f64 = 1.0 / PER_MM;

/// From this share of a step on a number is rounded up. Not one half: decimals of seven digits and
/// many 32-bit numbers lie exactly there and would go either way after a conversion. The golden
/// ratio's share is as far as can be from decimal and from binary fractions.
const UP_FROM: f64 = 0.618_033_988_749_895;

/// A point of a file in mm, on the grid.
pub(crate) fn in_mm(point: DVec3, unit: LengthUnit) -> DVec3 {
    on_grid(point, unit.millimetres())
}

/// A point in mm from one in a unit of so many mm, rounded to the grid of a millionth of a
/// millimetre on which surfaces and designs lie.
#[must_use]
pub fn on_grid(point: DVec3, mm_per_unit: f64) -> DVec3 {
    let scale = mm_per_unit * PER_MM;
    // Adding 0 makes −0 the 0 that it equals.
    DVec3::from_array(
        point.to_array().map(|x| (x * scale + (1.0 - UP_FROM)).floor() / PER_MM + 0.0),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_decimals_stay_as_they_were_typed() {
        for x in [12.1, -0.000_001, 285.927_032, 0.3, -1_999.999_999] {
            assert_eq!(in_mm(DVec3::splat(x), LengthUnit::Millimetre).x, x);
        }
        assert_eq!(in_mm(DVec3::splat(-0.0), LengthUnit::Metre).x.to_bits(), 0.0f64.to_bits());
    }

    #[test]
    fn every_unit_gives_the_same_bits_also_for_halves_of_a_step() {
        let halves = (0..2000).map(|k| 4.0 + (2 * k + 1) as f64 * 0.5e-6);
        let floats = (0..2000).map(|k| f64::from(4.0f32 + k as f32 * 2f32.powi(-21)));
        for x in halves.chain(floats) {
            let p = DVec3::new(x, -x, 50.0 * x);
            let want = in_mm(p, LengthUnit::Millimetre);
            assert!((want - p).abs().max_element() < GRID);
            for unit in LengthUnit::ALL {
                assert_eq!(in_mm(p / unit.millimetres(), unit), want, "{x} {unit:?}");
            }
        }
    }

    #[test]
    fn what_is_no_number_stays_none() {
        let p = in_mm(DVec3::new(f64::NAN, f64::INFINITY, 1e300), LengthUnit::Inch);
        assert!(p.x.is_nan() && p.y.is_infinite() && p.z > 1e300);
    }
}
