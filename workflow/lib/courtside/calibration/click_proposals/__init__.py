"""Court points proposed from the lines and posts in a picture."""
