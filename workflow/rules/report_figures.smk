"""Input functions of the report: every figure of the study, with the caption of the rule that draws it.

Inputs: the checked configuration, all rules. Outputs: none. Steps: pictures, captions, their parameters.
"""

from types import SimpleNamespace

CAPTION_PARAMETERS = ("networks", "source", "step", "blur_faces")  # those that captions ask for


def report_pictures():
    """Return the PNG of every figure of the study."""
    lists = (
        every_figure,
        every_shake,
        every_players_figure,
        every_device_figure,
        every_study_figure,
    )
    found = [path for one in (*lists, every_plan) for path in one() if path.endswith(".png")]
    return list(dict.fromkeys(found))


def reported_figure(path):
    """Return a figure for the report: its picture, and the caption, wildcards and parameters of its rule."""
    drawn_by = next(rule for rule in workflow.rules if rule.is_producer(path))
    wildcards = SimpleNamespace(**drawn_by.get_wildcards(path))
    caption = next(
        output.flags["report"].caption for output in drawn_by.output if output.match(path)
    )
    params = {
        name: value(wildcards) if callable(value) else value
        for name, value in drawn_by.params.items()
        if name in CAPTION_PARAMETERS
    }
    place = Path(path).parts
    stem = path.removesuffix(".png")
    return {
        "png": path,
        "caption": os.path.relpath(REPOSITORY / "workflow" / "report" / Path(caption).name),
        "wildcards": vars(wildcards),
        "params": params,
        "session": {"figures": "", "plans": "planned sessions"}.get(place[1], place[1]),
        "take": place[3] if place[2] == "takes" else "",
        "links": [
            (from_report(f"{stem}.csv"), "numbers (CSV)"),
            (from_report(f"{stem}.pdf"), "PDF"),
        ],
    }
