//! How wide words are: the widths of Helvetica, which the fonts that stand in for it share.

/// Widths of the characters from space to tilde, in thousandths of the size.
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// Width of any other character, in thousandths: a wide letter's.
const OTHER: u16 = 667;

/// Width of words of a size, in the unit of the size.
#[must_use]
pub fn width(words: &str, size: f64) -> f64 {
    let of = |c: char| {
        let place = (c as usize).checked_sub(0x20);
        place.and_then(|i| WIDTHS.get(i)).copied().unwrap_or(OTHER)
    };
    words.chars().map(|c| f64::from(of(c))).sum::<f64>() * size / 1000.0
}

/// The words in lines no wider than `most`, broken between words; a word that is wider is cut.
#[must_use]
pub fn wrapped(words: &str, size: f64, most: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split_whitespace() {
        let mut rest = word;
        if let Some(line) = lines.last_mut() {
            let longer = format!("{line} {word}");
            if width(&longer, size) <= most {
                *line = longer;
                continue;
            }
        }
        while width(rest, size) > most && rest.chars().count() > 1 {
            let fits = |n: usize| width(&rest.chars().take(n).collect::<String>(), size) <= most;
            let count = (1..rest.chars().count()).take_while(|&n| fits(n)).last().unwrap_or(1);
            let cut = rest.char_indices().nth(count).map_or(rest.len(), |(i, _)| i);
            lines.push(rest[..cut].to_owned());
            rest = &rest[cut..];
        }
        lines.push(rest.to_owned());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_by_hand() {
        // T 611, o 556, p 556.
        assert!((width("Top", 10.0) - 17.23).abs() < 1e-9);
        assert!((width("ä", 1.0) - 0.667).abs() < 1e-9);
        assert_eq!(width("", 10.0), 0.0);
    }

    #[test]
    fn lines_are_broken_between_words_and_long_words_are_cut() {
        assert_eq!(wrapped("one two  three", 10.0, 40.0), ["one two", "three"]);
        let cut = wrapped("iiiiiiiiii a", 10.0, 10.0);
        assert_eq!(cut, ["iiii", "iiii", "ii", "a"]);
        assert!(wrapped("  ", 1.0, 1.0).is_empty());
    }
}
