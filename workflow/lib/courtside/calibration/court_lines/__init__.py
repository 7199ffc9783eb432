"""A camera found from the painted lines of a court in its picture, without a click.

ridges: find, segments: thin bright or dark lines of a picture, and straight pieces of them
floor_frames: find: directions of the floor and focal lengths that straight pieces agree on
views: Views, Samples: many cameras at once, and points along a court's lines
evidence: fields, score, Evidence: how much of a court's lines is seen where cameras expect them
placements: find: places of cameras that put lines of the court on lines of the picture
refinement: refine, uncertainty: a camera moved until the lines fit, and how surely they give it
search: find, Candidate: the cameras that explain a picture best
edges: measure, Edges: where a picture shows painted lines, stretch by stretch
walk_and_lines: of_pictures, Told: what lines tell of the cameras of a walk
verdict: judge, Verdict: found, ambiguous or not found, and why; ends of symmetric courts
"""
