"""The files that rules pass to one another, with units, checked when read.

npz: `read`, `write`: arrays with stated keys, shapes and kinds; `read_record`,
    `write_record`: records
tables: `read`, `write`, `joined`, `labels_first`: CSV tables
footwork: `Contacts`, `read_contacts`, `read_steps`, `read_events`: contact of the feet, stances
strokes: `read`, `read_reactions`: strokes, and reactions to them
study_table: `of_take`, `read`: all measures of all takes in one table
user_tables: `lines`, `table`, `known`, `number`: CSV tables that people write

Folders: `keypoints` (skeletons, people), `cameras` (clicks, frames, footage), `devices` (motion,
clocks), `truth` (of simulated sessions; for evaluation only).
"""
