//! The fit: moving the woven nodes on the surface until the springs have their wanted lengths.
