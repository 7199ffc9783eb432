"""Rendering by ray casting: hall, players, shadows, rolling shutter and sensor.

- hall_renderer: `Renderer` (pictures of a hall, also from a moving camera)
- background: `look`, `Backdrop`, `write`, `read` (an empty hall as a fixed camera sees it)
- player_renderer: `Film`, `Grain` (pictures of players before a backdrop)
- coverage: `cover`
- rolling_shutter: `follow`, `Moving`, `Screen`, `shown`, `bounds`
- shadows: `cast`, `Shadow`
- shading: `Exposure`, `cross`
- textured_quads: `Surfaces`, `View`, `shade`, `Atlas`, `pack`
- rays: `grid`, `of_camera`, `Rays`
- lamps: `light`, `Light`, `lit`, `readout` (flicker, exposure, readout times)
- sensor: `develop`, `line_kernel`
"""
