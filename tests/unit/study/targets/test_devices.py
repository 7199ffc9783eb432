"""What the study makes of takes with devices: written out for the tiny study."""

from dataclasses import replace

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


def test_devices_are_exported_where_their_person_agreed(study):
    folder, depth = f"{TAKE}/devices", ("d415-depth.blazepose-full", "d415-rgb.blazepose-full")
    expected = {f"{folder}/mocopi.{suffix}" for suffix in ("trc", "c3d", "csv", "bvh", "glb")}
    expected |= {f"{folder}/{name}.{suffix}" for name in depth for suffix in ("bvh", "glb")}
    for name in ("d415-depth", "d415-rgb", "mocopi", "mocopi-corrected"):
        for folder, suffixes in (("pose3d_ik", "trc c3d csv mot osim"), ("motion", "bvh glb")):
            stem = f"{TAKE}/{folder}/devices/{name}/blazepose-full.p1"
            expected |= {f"{stem}.{suffix}" for suffix in suffixes.split()}
    found = devices.every_device_export(study)
    assert len(found) == len(set(found)) and set(found) == expected
    session = study.sessions["single-view-tiny"]
    subjects = {name: replace(s, consent=("analysis",)) for name, s in session.subjects.items()}
    silent = replace(study, sessions={session.name: replace(session, subjects=subjects)})
    assert devices.every_device_export(silent) == []


def test_other_networks_than_blazepose_make_no_metric_body(study):
    session = study.sessions["single-view-tiny"]
    parameters = {**session.parameters, "models": ["cpm-mobile-14"]}
    other = replace(study, sessions={session.name: replace(session, parameters=parameters)})
    made = [*devices.every_device_export(other), *devices.every_source_angle(other)]
    assert [path for path in made if "d415-depth" in path]
    assert [path for path in made if "d415-rgb" in path] == []


def test_joint_angles_are_measured_of_every_source(study):
    names = ("d415-depth", "d415-rgb", "mocopi", "mocopi-corrected")
    expected = [f"{TAKE}/motion/devices/{name}/blazepose-full.angles.csv" for name in names]
    assert devices.every_source_angle(study) == expected
    one = devices.device_takes(study)[0]
    suit = {"mocopi": one.take.devices["mocopi"]}
    alone = replace(one, take=replace(one.take, devices=suit))
    assert alone.fitted == ["mocopi"]


def test_body_frames_of_virtual_takes_are_evaluated(study):
    assert devices.every_body_frame(study) == [
        "results/single-view-tiny/evaluation/takes/claps/body_frames/blazepose-full.csv"
    ]
    real = replace(study.sessions["single-view-tiny"], virtual=None)
    assert devices.every_body_frame(replace(study, sessions={real.name: real})) == []


def test_a_study_without_devices_has_no_figure_of_them(studies):
    study = studies(sessions=["plain-tiny"])
    assert devices.thesis_take(study) is None
    assert devices.every_device_figure(study) == []
    assert devices.every_body_frame(study) == []
