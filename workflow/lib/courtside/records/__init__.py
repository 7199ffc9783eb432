"""What rules hand to each other: files with their units, checked when read."""
