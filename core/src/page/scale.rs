//! Colour scales and the bands of values that are shown in one colour.
//!
//! Values are shown in bands with a line between them, so that they can be counted off in black
//! and white. Both scales have a lightness that only falls from little to much: cividis (Nuñez,
//! Anderton & Renslow, "Optimizing colormaps with consideration for color vision deficiency to
//! enable accurate interpretation of scientific data", PLoS ONE 13(7), 2018) and magma (S. van der
//! Walt & N. Smith, matplotlib 2015), here with the dark end for much, since the paper is white.
//! Limit: between its 17 published samples a scale is interpolated in sRGB.

/// A colour, red, green and blue.
pub(super) type Rgb = [u8; 3];

/// A sequential colour scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scale {
    /// For strain.
    Cividis,
    /// For pressure.
    Magma,
}

/// From little to much.
const CIVIDIS: [Rgb; 17] = [
    [254, 232, 56],
    [240, 216, 70],
    [222, 201, 88],
    [205, 187, 99],
    [188, 174, 108],
    [171, 160, 114],
    [155, 148, 118],
    [140, 136, 120],
    [125, 124, 120],
    [111, 112, 115],
    [97, 101, 111],
    [83, 90, 109],
    [67, 78, 108],
    [50, 67, 109],
    [26, 56, 111],
    [0, 46, 106],
    [0, 34, 78],
];

/// From little to much.
const MAGMA: [Rgb; 17] = [
    [252, 253, 191],
    [253, 226, 163],
    [254, 196, 136],
    [254, 167, 114],
    [252, 137, 97],
    [245, 107, 92],
    [231, 82, 99],
    [208, 65, 111],
    [183, 55, 121],
    [156, 46, 127],
    [131, 38, 129],
    [106, 28, 129],
    [81, 18, 124],
    [54, 16, 107],
    [29, 17, 71],
    [10, 8, 34],
    [0, 0, 4],
];

impl Scale {
    /// Its published name.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Cividis => "cividis",
            Self::Magma => "magma",
        }
    }

    /// The colour at `part` of the scale, from 0 (little) to 1 (much).
    pub(super) fn colour(self, part: f64) -> Rgb {
        let samples = match self {
            Self::Cividis => &CIVIDIS,
            Self::Magma => &MAGMA,
        };
        let place = part.clamp(0.0, 1.0) * (samples.len() - 1) as f64;
        let k = (place as usize).min(samples.len() - 2);
        let f = place - k as f64;
        let mix = |c: usize| {
            let (a, b) = (f64::from(samples[k][c]), f64::from(samples[k + 1][c]));
            (a + f * (b - a)).round() as u8
        };
        [mix(0), mix(1), mix(2)]
    }
}

/// Relative luminance of a colour (WCAG 2), from 0 to 1.
pub(super) fn luminance(colour: Rgb) -> f64 {
    let linear = |c: u8| {
        let c = f64::from(c) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2])
}

/// A colour as CSS writes it.
pub(super) fn css(colour: Rgb) -> String {
    format!("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2])
}

/// Most bands in one picture: more colours cannot be told apart.
const MOST_BANDS: f64 = 11.0;

/// Equal bands of values; the first is open below and the last open above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bands {
    /// The colour scale.
    pub(super) scale: Scale,
    /// Lower edge of the first band.
    pub(super) low: f64,
    /// Width of a band.
    pub(super) step: f64,
    /// Number of bands.
    pub(super) count: usize,
    /// Not above zero: what is below it counts as negative.
    pub(super) floor: f64,
}

/// What a value is shown as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    /// A band, from 0.
    Band(usize),
    /// Below the floor.
    Negative,
    /// No number.
    Unknown,
}

impl Bands {
    /// Bands of a round width, not less than `least`, over most of the values: all but the
    /// hundredth at either end, by weight. Values without a number are left out.
    pub(super) fn of(
        scale: Scale,
        values: impl Iterator<Item = (f64, f64)>,
        least: f64,
        floor: f64,
    ) -> Self {
        let mut sorted: Vec<(f64, f64)> =
            values.filter(|(value, weight)| value.is_finite() && *weight > 0.0).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let low = weighted_percentile(&sorted, 0.01).unwrap_or(0.0).max(0.0);
        let high = weighted_percentile(&sorted, 0.99).unwrap_or(0.0).max(low);
        let mut step = round_up((high - low) / (MOST_BANDS - 1.0)).max(least);
        // Values all alike are one band, not the edge between two.
        if high - low < 0.5 * step {
            let low = (0.5 * (low + high) - 0.5 * step).max(0.0);
            return Self { scale, low, step, count: 1, floor };
        }
        loop {
            let first = (low / step + 1e-9).floor();
            let count = (high / step - 1e-9).ceil() - first;
            if count <= MOST_BANDS {
                let count = count.max(1.0) as usize;
                return Self { scale, low: first * step, step, count, floor };
            }
            step = round_up(1.01 * step);
        }
    }

    /// What a value is shown as.
    pub(super) fn class(&self, value: f64) -> Class {
        if !value.is_finite() {
            Class::Unknown
        } else if value < self.floor {
            Class::Negative
        } else {
            let band = ((value - self.low) / self.step).max(0.0) as usize;
            Class::Band(band.min(self.count - 1))
        }
    }

    /// The colour of a band. The two ends of the scale are left out: they leave no room for
    /// shading, and its dark end none for lines.
    pub(super) fn colour(&self, band: usize) -> Rgb {
        let most = (self.count.max(2) - 1) as f64;
        self.scale.colour(0.02 + 0.86 * band as f64 / most)
    }

    /// Lower edge of a band; that of the one past the last is the upper edge of the last.
    pub(super) fn edge(&self, band: usize) -> f64 {
        self.low + self.step * band as f64
    }

    /// Decimals that an edge needs.
    pub(super) fn decimals(&self) -> usize {
        let whole = |value: f64| (value - value.round()).abs() < 1e-6;
        (0..3)
            .find(|&d| {
                let tens = 10f64.powi(d);
                whole(self.step * tens) && whole(self.low * tens)
            })
            .map_or(2, |d| d as usize)
    }
}

/// The smallest of 1, 2, 2.5 and 5 times a power of ten that is at least `value` (positive).
pub(super) fn round_up(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 0.0;
    }
    let power = 10f64.powf(value.log10().floor());
    let factors = [1.0, 2.0, 2.5, 5.0, 10.0];
    factors.map(|f| f * power).into_iter().find(|&r| r >= value * (1.0 - 1e-9)).unwrap_or(value)
}

/// The value below which `part` of the weight lies; `sorted` by value.
pub(super) fn weighted_percentile(sorted: &[(f64, f64)], part: f64) -> Option<f64> {
    let total: f64 = sorted.iter().map(|(_, weight)| weight).sum();
    let mut sum = 0.0;
    sorted
        .iter()
        .find(|(_, weight)| {
            sum += weight;
            sum >= part * total
        })
        .or(sorted.last())
        .map(|(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_scales_only_darken() {
        for scale in [Scale::Cividis, Scale::Magma] {
            let light: Vec<f64> =
                (0..=64).map(|k| luminance(scale.colour(f64::from(k) / 64.0))).collect();
            assert!(light.windows(2).all(|w| w[1] < w[0]), "{}", scale.name());
        }
    }

    #[test]
    fn neighbouring_bands_differ_in_grey() {
        for scale in [Scale::Cividis, Scale::Magma] {
            let bands = Bands { scale, low: 0.0, step: 1.0, count: 11, floor: 0.0 };
            // Lightness L* (CIE 1976) is what a copier and a colour-blind eye keep.
            let lightness: Vec<f64> =
                (0..11).map(|k| 116.0 * luminance(bands.colour(k)).cbrt() - 16.0).collect();
            assert!(lightness.windows(2).all(|w| w[0] - w[1] > 5.0), "{lightness:?}");
        }
    }

    #[test]
    fn bands_are_round_and_hold_the_values() {
        let values = (0..=200).map(|k| (9.3 + 0.06 * f64::from(k), 1.0));
        let bands = Bands::of(Scale::Cividis, values, 1.0, -0.5);
        assert_eq!((bands.low, bands.step, bands.count), (8.0, 2.0, 7));
        assert_eq!(bands.class(-0.4), Class::Band(0));
        assert_eq!(bands.class(10.0), Class::Band(1));
        assert_eq!(bands.class(9.99), Class::Band(0));
        assert_eq!(bands.class(40.0), Class::Band(6));
        assert_eq!(bands.class(3.0), Class::Band(0));
        assert_eq!(bands.class(-0.6), Class::Negative);
        assert_eq!(bands.class(f64::NAN), Class::Unknown);
    }

    #[test]
    fn one_value_everywhere_is_one_band_however_it_rounds() {
        let values = [20.0 - 1e-12, 20.0, 20.0 + 1e-12];
        let bands = Bands::of(Scale::Cividis, values.iter().map(|&v| (v, 1.0)), 1.0, 0.0);
        assert!(values.iter().all(|&v| bands.class(v) == Class::Band(0)));
        assert_eq!((bands.count, bands.decimals()), (1, 1));
        let nothing = Bands::of(Scale::Magma, std::iter::empty(), 1.0, 0.0);
        assert_eq!(nothing.count, 1);
    }

    #[test]
    fn a_spike_of_little_area_does_not_take_the_scale() {
        let values = (0..=100).map(|k| (f64::from(k) / 10.0, 1.0)).chain([(500.0, 0.1)]);
        let bands = Bands::of(Scale::Magma, values, 0.5, 0.0);
        assert!(bands.edge(bands.count) < 13.0, "{bands:?}");
        assert_eq!(bands.class(500.0), Class::Band(bands.count - 1));
    }

    #[test]
    fn percentiles_weigh() {
        let sorted = [(1.0, 1.0), (2.0, 8.0), (3.0, 1.0)];
        assert_eq!(weighted_percentile(&sorted, 0.05), Some(1.0));
        assert_eq!(weighted_percentile(&sorted, 0.5), Some(2.0));
        assert_eq!(weighted_percentile(&sorted, 0.95), Some(3.0));
        assert_eq!(weighted_percentile(&[], 0.5), None);
        assert_eq!([0.21, 1.0, 2.1, 26.0].map(round_up), [0.25, 1.0, 2.5, 50.0]);
    }
}
