"""Put a take into one HTML page to look around in: skeletons of several methods, cameras, court.

`layers` says of each its `file` and `name`, the index of its skeleton in `paths.skeletons`, and
whether it is `shown` at first; of a device also the `person`, its `source` in `paths.clocks`, and
whether it is to be `placed` onto the first layer. A device whose clock is not known is left out,
and the page says so.
"""

from courtside.calibration.court import court as court_files
from courtside.geometry import camera
from courtside.pages import page
from courtside.pages.viewer import layers as viewer_layers
from courtside.pages.viewer import viewer
from courtside.records.devices import clocks as sync
from courtside.records.keypoints import skeleton
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(paths, html, *, title, layers):
    skeletons = [skeleton.read(path) for path in paths.skeletons]
    _, clocks = sync.read(paths.clocks) if paths.clocks else ("", {})
    made, notes = [], []
    for layout in layers:
        name, clock = layout["name"], clocks.get(layout.get("source"))
        if clock and not clock.usable:
            notes.append(f"{name} is not shown: its clock is {clock.status} ({clock.note}).")
            continue
        layer = viewer_layers.read(
            layout["file"],
            name,
            skeletons[layout["skeleton"]],
            person=layout.get("person", ""),
            clock=clock,
            shown=layout["shown"],
        )
        made.append(viewer_layers.placed(layer, made[0]) if layout.get("placed") else layer)
    court = court_files.read(paths.court) if paths.court else None
    seen = camera.read_toml(paths.cameras) if paths.cameras else ()
    content = viewer.build(title, made, seen, court, notes)
    page.write(html, content)
    log.logger.info("%s: %d layers, %.1f MB", html, len(made), len(content) / 1e6)


if __name__ == "__main__":
    run(main, snakemake)
