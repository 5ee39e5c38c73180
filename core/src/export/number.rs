//! Numbers of text formats: fixed decimals, one zero.

use std::fmt::Write as _;

/// Decimals up to which the quick way works.
const MOST_DECIMALS: usize = 9;

/// Below this a number with [`MOST_DECIMALS`] decimals fits 64 bits as a whole one.
const LARGEST: f64 = 1e9;

/// `value` with fixed decimals; what rounds to zero has no sign, so equal shapes give equal bytes.
#[must_use]
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let mut text = String::new();
    push_fixed(&mut text, value, decimals);
    text
}

/// Appends what [`fixed`] gives.
pub(super) fn push_fixed(text: &mut String, value: f64, decimals: usize) {
    if let Some(units) = units(value, decimals) {
        if value < 0.0 && units > 0 {
            text.push('-');
        }
        let one = 10u64.pow(decimals as u32);
        push_whole(text, units / one, 1);
        if decimals > 0 {
            text.push('.');
            push_whole(text, units % one, decimals);
        }
        return;
    }
    let start = text.len();
    // Writing to a string cannot fail.
    let _ = write!(text, "{value:.decimals$}");
    let zero = text[start..].bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
    if zero && text[start..].starts_with('-') {
        text.remove(start);
    }
}

/// Appends a whole number with at least `width` digits.
pub(super) fn push_whole(text: &mut String, mut number: u64, width: usize) {
    let mut digits = [b'0'; 20];
    let mut start = digits.len();
    while number > 0 {
        start -= 1;
        digits[start] += (number % 10) as u8;
        number /= 10;
    }
    let start = start.min(digits.len() - width);
    text.push_str(std::str::from_utf8(&digits[start..]).unwrap_or_default());
}

/// The size of `value` in units of its last decimal, correctly rounded: the same as the standard
/// library's, exactly and without its arithmetic of many digits. `None` where that is needed: large
/// or no numbers, and those half-way between two.
fn units(value: f64, decimals: usize) -> Option<u64> {
    if decimals > MOST_DECIMALS || value.is_nan() || value.abs() >= LARGEST {
        return None;
    }
    let bits = value.to_bits();
    let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    // The value is mantissa / 2^shift; below 1e9 the shift is 23 at least.
    let mantissa = if exponent == 0 { fraction } else { fraction | 1 << 52 };
    let shift = 1075 - exponent.max(1);
    // Less than 2^83.
    let scaled = u128::from(mantissa) * u128::from(10u64.pow(decimals as u32));
    if shift > 100 {
        return Some(0);
    }
    let rest = scaled & ((1 << shift) - 1);
    let half = 1u128 << (shift - 1);
    let whole = (scaled >> shift) as u64;
    (rest != half).then_some(if rest > half { whole + 1 } else { whole })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_sign_and_decimals_are_fixed() {
        assert_eq!(fixed(-0.0, 3), "0.000");
        assert_eq!(fixed(-4e-10, 9), "0.000000000");
        assert_eq!(fixed(-6e-10, 9), "-0.000000001");
        assert_eq!(fixed(-12.5, 2), "-12.50");
        assert_eq!(fixed(0.1 + 0.2, 9), "0.300000000");
    }

    #[test]
    fn every_number_is_written_as_the_standard_library_writes_it() {
        let standard = |value: f64, decimals: usize| {
            let text = format!("{value:.decimals$}");
            match text.strip_prefix('-') {
                Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
                _ => text,
            }
        };
        let special = [0.0, 5e-324, 0.5, 1.5, 2.5, 0.1, 0.25, 1.0 / 1024.0, 4.999_999_999_5, 1e9];
        let special =
            special.into_iter().chain([1e300, f64::INFINITY, f64::NAN, 999_999_999.999_999_9]);
        // splitmix64 (Steele, Lea, Flood 2014): numbers of all sizes.
        let mut state = 1u64;
        let random = (0..20_000).map(move |k| {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            (z as f64 / 2f64.powi(64)) * 10f64.powi(k % 24 - 12)
        });
        for value in special.chain(random).flat_map(|x| [x, -x]) {
            for decimals in [0, 1, 2, 3, 9, 12] {
                assert_eq!(fixed(value, decimals), standard(value, decimals), "{value:e}");
            }
        }
    }

    #[test]
    fn whole_numbers_have_all_their_digits() {
        let text = |number, width| {
            let mut text = String::new();
            push_whole(&mut text, number, width);
            text
        };
        assert_eq!([text(0, 1), text(7, 3), text(120, 1)], ["0", "007", "120"]);
        assert_eq!(text(u64::MAX, 1), u64::MAX.to_string());
    }
}
