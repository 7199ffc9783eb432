"""Calibration of a camera from the painted lines of a court in its picture, without a click.

ridges: find, segments: thin bright or dark lines of a picture, and straight pieces of them
floor_frames: find: directions of the floor and focal lengths that straight pieces agree on
views: Views, Samples: many cameras at once, and points along a court's lines
evidence: fields, score, Evidence: the share of a court's lines that the picture shows
placements: find: camera positions that project lines of the court onto lines of the picture
refinement: refine, uncertainty: a camera adjusted until the lines fit, and its uncertainty
search: find, fault, Candidate: the cameras that explain a picture best, and why one is rejected
edges: measure, Edges: painted lines measured in a picture, stretch by stretch
walk_and_lines: adjust_and_check, of_pictures, LineConstraints: cameras of a walk adjusted
    together with lines
verdict: examine, judge, Verdict: found, ambiguous or not found, and why; ends of symmetric courts
"""
