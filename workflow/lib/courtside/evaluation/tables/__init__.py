"""Tables of the study: calibration, players, racket."""
