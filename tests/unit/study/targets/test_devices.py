"""What the study makes of takes with devices: written out for the tiny study."""

from courtside.study.targets import devices

TAKE = "results/single-view-tiny/takes/claps"


def test_takes_with_devices_are_measured_with_the_first_network(study):
    (one,) = devices.device_takes(study)
    assert one.labels == {"session": "single-view-tiny", "take": "claps"}
    assert one.model == "blazepose-full"


def test_figures_of_devices_and_of_the_thesis(study):
    stems = [
        f"{TAKE}/figures/{name}.blazepose-full"
        for name in (
            "wrist_distance.devices",
            "wrist_distance.events",
            "wrist_arcs",
            "skeleton_plates",
            "source_errors",
        )
    ]
    stems += [f"results/figures/{n}" for n in ("thesis_fig3_1", "thesis_fig3_2", "smoothness")]
    expected = [f"{stem}.{suffix}" for stem in stems for suffix in ("pdf", "png", "csv")]
    assert devices.every_device_figure(study) == expected


def test_body_frames_of_virtual_takes_are_evaluated(study):
    assert devices.every_body_frame(study) == [
        "results/single-view-tiny/evaluation/takes/claps/body_frames/blazepose-full.csv"
    ]


def test_a_study_without_devices_has_no_figure_of_them(studies):
    study = studies(sessions=["plain-tiny"])
    assert devices.thesis_take(study) is None
    assert devices.every_device_figure(study) == []
    assert devices.every_body_frame(study) == []
