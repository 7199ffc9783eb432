"""Who is who across cameras and over time."""
