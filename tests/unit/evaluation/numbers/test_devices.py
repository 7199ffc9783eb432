"""Numbers of devices: all limb joints, in both frames."""

from courtside.evaluation.numbers import devices


def test_sources_and_body_frames_are_all_shown(source, value):
    found = devices.sources(source)
    assert {n.part for n in found} == {"body_median", "body_p95", "root_median", "root_p95"}
    assert value(found, "`single-view/claps`: `mocopi`", "body_median").printed == "340"
    frames = devices.body_frames(source)
    assert value(frames, "`single-view/claps`: `mocopi`", "angle").printed == "3.0"
