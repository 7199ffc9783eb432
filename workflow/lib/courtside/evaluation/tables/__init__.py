"""Tables of the study: calibration, ways to calibrate, players, racket, networks.

angles: `read`, `table`: errors of joint angles
calibration: read, tidy, table: errors of calibrations; pick, summary, spread, structures_of: parts
    of it
networks: `errors_3d`, `table`: networks on the same frames, with intervals
players: `read`, `together`, `table`: errors of simulated players
racket: `read`, `table`: lengths of a racket
ways: `from_quality`, `against_truth`, `accepted`: all calibrations of sessions side by side
"""
