"""One module for each comparison: `NAME`, what `LIMIT` counts, what `BOUNDS` it, and `compare`."""
