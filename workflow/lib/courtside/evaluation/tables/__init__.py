"""Tables of the study: calibration, players, racket.

angles: `read`, `table`: errors of joint angles
calibration: read, tidy, table: errors of calibrations; pick, summary, spread, structures_of: parts
    of it
players: `read`, `together`, `table`: errors of simulated players
racket: `read`, `table`: lengths of a racket
"""
