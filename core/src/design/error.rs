//! What can be wrong with a design file.

/// A design file that cannot be used, with the place in the file and the remedy.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DesignError {
    /// The text is no JSON, or has a key twice.
    #[error("line {line}, column {column}: the design cannot be read: {reason}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What the JSON reader says.
        reason: String,
    },
    /// A key that the design does not know; never ignored, for it may be a misspelt wish.
    #[error("`{path}` is not a known key; the nearest known key is `{nearest}`")]
    UnknownKey {
        /// The key with its place, for example `fabric.wrap`.
        path: String,
        /// The known key of that place nearest to it.
        nearest: String,
    },
    /// A key that every design needs.
    #[error("`{path}` is missing: {remedy}")]
    Missing {
        /// The key with its place.
        path: String,
        /// What to write.
        remedy: String,
    },
    /// A value that cannot be used.
    #[error("`{path}` is {value}: {remedy}")]
    Value {
        /// The key with its place, for example `pressures[1].kpa`.
        path: String,
        /// The value as JSON, shortened.
        value: String,
        /// What it may be.
        remedy: String,
    },
}

impl DesignError {
    pub(super) fn value(
        path: impl Into<String>,
        value: impl ToString,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Value { path: path.into(), value: value.to_string(), remedy: remedy.into() }
    }
}

impl From<&serde_json::Error> for DesignError {
    fn from(error: &serde_json::Error) -> Self {
        let text = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let reason = text.strip_suffix(&place).unwrap_or(&text).to_owned();
        Self::Syntax { line: error.line(), column: error.column(), reason }
    }
}
