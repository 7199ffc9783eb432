"""Numbers of the README and of docs/measured/: each from its source, kept in one register.

register: `Number`, `Source`, `listed`, `read`, `write`, `stale`: the register, and what it rests on
document_tables: `View`, `render`, `fill`: tables of documents, filled from the register
views: `VIEWS`: the columns of each table; stated_views: those of stated numbers
study: `numbers`, `summary`, `write`, `filled`, `report`: all of them
calibration: `calibrations`, `ways`, `growth`, `strengths`, `capture`
players: `sessions`, `takes`, `angles`, `measures`, `held`
footage: `corrections`, `joints`, `views`: raw and corrected joints, real beside virtual
networks: `virtual`: networks on the same frames
published: `walk`, `racket`, `round_trip`, `table_1`
devices: `sources`, `body_frames`
stated: `numbers`: measured by hand or by benchmarks, or published by others
"""
