"""Structure from motion: the only room that uses pycolmap."""
