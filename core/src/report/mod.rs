//! The report: every figure of a run as data.
