"""The virtual hall: walls, floor, furniture, textures, painted lines, net and bystanders.

All of it is textured parallelograms; where the court's lines and posts really are is part of the
truth.

- hall: `build`, `room`, `Scene`
- look: `draw`, `Look` (size, colours and patterns of a hall)
- painted_lines: `paint_court`, `misplacement`, `PaintedCourt`, `Net`
- furniture: `gear`, `posters`, `stands`, `stage`, `ceiling`, `net`, `crate`
- bystanders: `plan`, `quads`, `Person`
- textures: `planks`, `wall`, `window`, `poster`, `crate`, `cloth`, `paint`, `scale_contrast`
- quads: `Quad`, `box`
"""
