"""Task panels, one a file."""
