//! The pattern: outline, seams and their figures.
