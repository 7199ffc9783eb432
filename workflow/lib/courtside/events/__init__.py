"""T-poses and claps: found in every source, timed by the contact of the hands."""
