//! Pressure and strain: the formulas, both ways.
