//! Letters as lines, for machines and pictures that have no fonts.
//!
//! Capitals and figures on a grid of 4 by 6; small letters are smaller capitals. Words are as wide as in
//! Helvetica, so that they take the room that was kept for them.

use glam::DVec2;

use super::charset::ascii;
use crate::sheet::width::width;

/// Height of a capital over the size of the letters.
const CAPITAL: f64 = 0.72;
/// Height of a small letter over that of a capital.
const SMALL: f64 = 0.75;
/// Share of its width that a letter fills; the rest is the gap to the next.
const FILLED: f64 = 0.72;

/// The lines of words of a size in mm, turned by degrees about `at`, which is their middle or, if
/// `from_start`, their beginning.
pub(super) fn strokes(
    words: &str,
    at: DVec2,
    size: f64,
    angle: f64,
    from_start: bool,
) -> Vec<Vec<DVec2>> {
    let wide = width(words, size);
    let words = ascii(words);
    let turn = DVec2::from_angle(angle.to_radians());
    let share = wide / words.chars().map(breadth).sum::<f64>().max(f64::MIN_POSITIVE);
    let mut x = if from_start { 0.0 } else { -0.5 * wide };
    let mut lines = Vec::new();
    for c in words.chars() {
        let wide = share * breadth(c);
        let scale = if c.is_ascii_lowercase() { SMALL } else { 1.0 };
        let unit = DVec2::new(FILLED * wide / 4.0, CAPITAL * scale * size / 6.0);
        let corner = DVec2::new(x + 0.5 * (1.0 - FILLED) * wide, -0.35 * size);
        for line in letter(c.to_ascii_uppercase()).split(' ').filter(|line| line.len() > 2) {
            let digits: Vec<f64> =
                line.chars().filter_map(|d| d.to_digit(10)).map(f64::from).collect();
            let points = digits
                .chunks_exact(2)
                .map(|pair| at + turn.rotate(corner + unit * DVec2::new(pair[0], pair[1])));
            lines.push(points.collect());
        }
        x += wide;
    }
    lines
}

/// How broad a letter is beside a capital.
fn breadth(c: char) -> f64 {
    match c {
        ' ' | '.' | ',' | ':' | ';' | '\'' | '!' | '(' | ')' => 0.6,
        'm' | 'w' => 1.05,
        'a'..='z' => 0.9,
        'M' | 'W' => 1.15,
        _ => 1.0,
    }
}

/// The lines of a letter: pairs of digits x, y, a line a word.
fn letter(c: char) -> &'static str {
    match c {
        ' ' => "",
        'A' => "002640 1232",
        'B' => "000636454433033342413000",
        'C' => "4536160501103041",
        'D' => "00062644422000",
        'E' => "46060040 0333",
        'F' => "460600 0333",
        'G' => "45361605011030414323",
        'H' => "0006 4046 0343",
        'I' => "1030 2026 1636",
        'J' => "4641301001",
        'K' => "0006 460340",
        'L' => "060040",
        'M' => "0006234640",
        'N' => "00064046",
        'O' | '0' => "160501103041453616",
        'P' => "00063645443303",
        'Q' => "160501103041453616 2240",
        'R' => "00063645443303 2340",
        'S' => "453616050413334241301001",
        'T' => "0646 2620",
        'U' => "060110304146",
        'V' => "062046",
        'W' => "0610243046",
        'X' => "0046 0640",
        'Y' => "062346 2320",
        'Z' => "06460040",
        '1' => "152620 1030",
        '2' => "05163645440040",
        '3' => "0516364544334241301001",
        '4' => "30360242",
        '5' => "460604344341301001",
        '6' => "4536160501103041423303",
        '7' => "064610",
        '8' => "13040516364544331302011030414233",
        '9' => "0110304145361605041343",
        '.' => "2021",
        ',' => "2110",
        ':' => "2021 2425",
        ';' => "2110 2425",
        '-' => "0343",
        '+' => "0343 2125",
        '/' => "0046",
        '(' => "36252130",
        ')' => "16252110",
        '%' => "0046 0506161505 3031414030",
        '#' => "1016 3036 0242 0444",
        '=' => "0242 0444",
        '*' => "0343 1135 1531",
        '\'' => "2624",
        '"' => "1614 3634",
        '_' => "0040",
        '!' => "2622 2021",
        '?' => "05163645442322 2021",
        '<' => "450341",
        '>' => "054301",
        '&' => "4005162635120110203042",
        _ => "0006464000",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_l_by_hand_upright_and_turned() {
        // L is 556 thousandths wide; 72 % of it are filled; a capital is 7.2 of 10 high.
        let lines = strokes("L", DVec2::ZERO, 10.0, 0.0, false);
        let left = -0.5 * 5.56 + 0.14 * 5.56;
        let wanted = [(left, 3.7), (left, -3.5), (left + 0.72 * 5.56, -3.5)];
        assert_eq!(lines.len(), 1);
        for (p, q) in lines[0].iter().zip(wanted) {
            assert!(p.distance(q.into()) < 1e-9, "{p} {q:?}");
        }
        let turned = strokes("L", DVec2::ZERO, 10.0, 90.0, false);
        assert!(turned[0][0].distance(DVec2::new(-3.7, left)) < 1e-9, "{}", turned[0][0]);
    }

    #[test]
    fn every_printable_character_is_drawn_and_whole() {
        for c in '!'..='~' {
            for line in letter(c.to_ascii_uppercase()).split(' ').filter(|line| line.len() > 2) {
                assert!(
                    line.len() % 2 == 0 && line.chars().all(|d| d.is_ascii_digit()),
                    "{c} {line}"
                );
            }
            assert!(!strokes(&c.to_string(), DVec2::ZERO, 4.0, 0.0, true).is_empty(), "{c}");
        }
    }
}
