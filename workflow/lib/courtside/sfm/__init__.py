"""Structure from motion: which images, features, matches, maps, adjustment."""
