"""Ray casting: textured quads, shading, shadows, rolling shutter, sensor."""
