//! Numbers of text formats: fixed decimals, one zero.

/// `value` with fixed decimals; what rounds to zero has no sign, so equal shapes give equal bytes.
#[must_use]
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::fixed;

    #[test]
    fn zero_has_no_sign_and_decimals_are_fixed() {
        assert_eq!(fixed(-0.0, 3), "0.000");
        assert_eq!(fixed(-4e-10, 9), "0.000000000");
        assert_eq!(fixed(-6e-10, 9), "-0.000000001");
        assert_eq!(fixed(-12.5, 2), "-12.50");
        assert_eq!(fixed(0.1 + 0.2, 9), "0.300000000");
    }
}
