//! Region and seams: from a validated surface to a disk.
