//! JSON as people and `diff` like it: indented, with arrays of plain values on one line.
//!
//! Numbers are written with the fewest digits that read back as the same number. Keys stand in
//! the order in which the data declares them, so the same data gives the same bytes.

use std::io;

use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};

/// The JSON of `value`, with a line end after it.
///
/// A number that is not finite has no JSON and becomes `null`: whoever reads a number there fails
/// loudly.
///
/// # Panics
/// If a map in `value` has keys that are no text, which would be a fault of the program.
#[must_use]
pub fn json_text<T: Serialize + ?Sized>(value: &T) -> String {
    let mut bytes = Vec::new();
    value
        .serialize(&mut Serializer::with_formatter(&mut bytes, Lines::default()))
        .expect("plain data with text for keys has a JSON");
    bytes.push(b'\n');
    String::from_utf8(bytes).expect("JSON is UTF-8")
}

/// What was opened and how its children are laid out.
#[derive(Debug, Clone, Copy)]
struct Level {
    /// It has children.
    used: bool,
    /// Its children stand on lines of their own.
    broken: bool,
}

/// Objects and arrays of objects or arrays are broken into lines; arrays of plain values are not.
#[derive(Debug, Default)]
struct Lines {
    levels: Vec<Level>,
}

impl Lines {
    fn line<W: ?Sized + io::Write>(&self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b"\n")?;
        (0..self.levels.len()).try_for_each(|_| writer.write_all(b"  "))
    }

    /// Opens an object or an array; as the child of an array it stands on a line of its own.
    fn open<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        if let Some(parent) = self.levels.last_mut()
            && !parent.broken
        {
            parent.broken = true;
            self.line(writer)?;
        }
        self.levels.push(Level { used: false, broken: bracket == b"{" });
        writer.write_all(bracket)
    }

    fn close<W: ?Sized + io::Write>(&mut self, writer: &mut W, bracket: &[u8]) -> io::Result<()> {
        let level = self.levels.pop().unwrap_or(Level { used: false, broken: false });
        if level.used && level.broken {
            self.line(writer)?;
        }
        writer.write_all(bracket)
    }

    /// Separates a child from the one before it.
    fn child<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        let Some(level) = self.levels.last_mut() else { return Ok(()) };
        let first = !std::mem::replace(&mut level.used, true);
        let broken = level.broken;
        if !first {
            writer.write_all(if broken { b"," } else { b", " })?;
        }
        if broken { self.line(writer) } else { Ok(()) }
    }
}

impl Formatter for Lines {
    fn begin_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b"[")
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"]")
    }

    fn begin_array_value<W: ?Sized + io::Write>(
        &mut self,
        writer: &mut W,
        _first: bool,
    ) -> io::Result<()> {
        self.child(writer)
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open(writer, b"{")
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.close(writer, b"}")
    }

    fn begin_object_key<W: ?Sized + io::Write>(
        &mut self,
        writer: &mut W,
        _first: bool,
    ) -> io::Result<()> {
        self.child(writer)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::json_text;

    #[test]
    fn plain_arrays_stay_on_one_line_and_the_rest_is_indented() {
        let value = json!({"a": [1.5, 2.0, -0.1], "b": [[1, 2], [3, 4]], "c": [], "d": {},
                           "e": [{"f": null}]});
        let expected = concat!(
            "{\n",
            "  \"a\": [1.5, 2.0, -0.1],\n",
            "  \"b\": [\n",
            "    [1, 2],\n",
            "    [3, 4]\n",
            "  ],\n",
            "  \"c\": [],\n",
            "  \"d\": {},\n",
            "  \"e\": [\n",
            "    {\n",
            "      \"f\": null\n",
            "    }\n",
            "  ]\n",
            "}\n"
        );
        assert_eq!(json_text(&value), expected);
        assert_eq!(serde_json::from_str::<Value>(expected).unwrap(), value);
    }

    #[test]
    fn numbers_have_the_fewest_digits_that_read_back() {
        assert_eq!(
            json_text(&[0.1 + 0.2, 1e-9, 2.29, 3.0]),
            "[0.30000000000000004, 1e-9, 2.29, 3.0]\n"
        );
    }

    #[test]
    fn mixed_arrays_break_where_the_first_nested_value_stands() {
        let value = json!([1, [2], 3]);
        assert_eq!(serde_json::from_str::<Value>(&json_text(&value)).unwrap(), value);
    }
}
