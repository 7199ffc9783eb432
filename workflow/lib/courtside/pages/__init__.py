"""Pages in one HTML file each: clicking, viewer, report."""
