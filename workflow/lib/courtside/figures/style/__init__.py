"""What figures share: style, bars, oblique views, stick figures, looks of sources.

style: `figure`, `save`, `side_colour`: one look for all figures, written with their numbers
bars: `draw`, `draw_level`, `mark`: medians with ranges
windows: `length_s`, `draw`, `known`, `a_minute`: long takes over time, window by window
oblique_view: `Sight`, `figures`, `floor`, `net`, `camera`, `finish`: a scene from above
picture_crops: `box`, `show`, `sticks`, `rings`: the part of a picture around a person
stick_figure, schematic_pose, joint_map: `stick`; `tpose`; `rows`, `cell`: skeletons drawn
court_plan, source_styles: `draw`; `looks`, `kind_of`: a court from above, colours of sources
"""
