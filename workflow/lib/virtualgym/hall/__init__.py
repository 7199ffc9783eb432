"""The hall: walls, furniture, textures, painted lines, bystanders."""
