//! Texts for formats that hold few characters: what is put in place of the others.

/// The nearest words of 7-bit characters: accents go, ligatures are spelt out, `?` stands for the rest.
#[must_use]
pub(crate) fn ascii(text: &str) -> String {
    text.chars().map(ascii_of).collect()
}

fn ascii_of(c: char) -> String {
    if (' '..='~').contains(&c) {
        return c.to_string();
    }
    // Pairs of the characters of a script's Latin letters and what they become.
    const NEAREST: [(&str, &str); 30] = [
        ("äæ", "ae"),
        ("ÄÆ", "Ae"),
        ("öœ", "oe"),
        ("ÖŒ", "Oe"),
        ("ü", "ue"),
        ("Ü", "Ue"),
        ("ß", "ss"),
        ("àáâãåāăą", "a"),
        ("ÀÁÂÃÅĀĂĄ", "A"),
        ("çćč", "c"),
        ("ÇĆČ", "C"),
        ("èéêëēęě", "e"),
        ("ÈÉÊËĒĘĚ", "E"),
        ("ìíîïīı", "i"),
        ("ÌÍÎÏĪİ", "I"),
        ("ñńň", "n"),
        ("ÑŃŇ", "N"),
        ("òóôõøōő", "o"),
        ("ÒÓÔÕØŌŐ", "O"),
        ("ùúûūůű", "u"),
        ("ÙÚÛŪŮŰ", "U"),
        ("ýÿ", "y"),
        ("ÝŸ", "Y"),
        ("šśş", "s"),
        ("ŠŚŞ", "S"),
        ("žźż", "z"),
        ("ŽŹŻ", "Z"),
        ("ł", "l"),
        ("Ł", "L"),
        ("×·", "x"),
    ];
    let dash = matches!(c, '\u{2010}'..='\u{2015}' | '\u{2212}');
    let space = c.is_whitespace() || c.is_control();
    match NEAREST.iter().find(|(from, _)| from.contains(c)) {
        Some((_, to)) => (*to).to_owned(),
        None if dash => "-".to_owned(),
        None if space => " ".to_owned(),
        None => "?".to_owned(),
    }
}

/// The text as bytes of the code page 1252, with `?` for what it does not hold; and whether it held all.
#[must_use]
pub(crate) fn latin(text: &str) -> (Vec<u8>, bool) {
    /// What stands at 0x80 and after.
    const UPPER: &str = "€\u{81}‚ƒ„…†‡ˆ‰Š‹Œ\u{8d}Ž\u{8f}\u{90}‘’“”•–—˜™š›œ\u{9d}žŸ";
    let mut whole = true;
    let bytes = text
        .chars()
        .map(|c| match c {
            ' '..='~' | '\u{a0}'..='\u{ff}' => c as u32 as u8,
            '\u{2212}' => b'-',
            _ if c.is_whitespace() => b' ',
            _ if c.is_control() => b' ',
            _ => match UPPER.chars().position(|upper| upper == c) {
                Some(place) => 0x80 + place as u8,
                None => {
                    whole = false;
                    b'?'
                }
            },
        })
        .collect();
    (bytes, whole)
}

/// The text of a DXF file: 7 bits, other characters as AutoCAD writes them, `\U+00E4`.
#[must_use]
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            ' '..='~' => out.push(c),
            _ if c.is_control() => out.push(' '),
            _ => {
                // Beyond 16 bits as the pair of UTF-16.
                for unit in c.encode_utf16(&mut [0; 2]) {
                    out.push_str(&format!("\\U+{unit:04X}"));
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accents_go_and_what_is_unknown_is_a_question_mark() {
        assert_eq!(
            ascii("Käte Müßig \u{2013} Łódź Ñandú 3 \u{d7} 膝\n"),
            "Kaete Muessig - Lodz Nandu 3 x ? "
        );
        assert_eq!(ascii("plain ~ text"), "plain ~ text");
    }

    #[test]
    fn latin_letters_keep_their_bytes() {
        assert_eq!(latin("ä€–"), (vec![0xe4, 0x80, 0x96], true));
        assert_eq!(latin("a膝"), (b"a?".to_vec(), false));
    }

    #[test]
    fn dxf_escapes_are_those_of_autocad() {
        assert_eq!(escaped("Kä\n膝😀"), "K\\U+00E4 \\U+819D\\U+D83D\\U+DE00");
    }
}
