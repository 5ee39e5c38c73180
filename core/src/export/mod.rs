//! Files from results: bytes in memory, no geometry decisions, no file system.
