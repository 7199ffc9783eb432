"""The data dictionary describes every column of every CSV, and what the JSON of cameras holds."""

import csv
import json
from fnmatch import fnmatchcase

import pytest

from courtside.geometry import camera
from fixtures.study.data_dictionary import (
    OF_FOOTWORK,
    OF_KINEMATICS,
    OF_NETWORKS,
    OF_VERDICTS,
    Dictionary,
)
from smoke.snakemake_runs import ROOT

DOCUMENTS = ("docs/results.md", "config/README.md")  # clicks are described where they are made

# Parts of these documents: a heading (all below it), `heading | first cell` (rows of a table below
# it), or `: words` (the paragraph that holds these words).
FRAMES, OF_CALIBRATION = "Columns of the frame table", "Columns of the evaluation"
MOVEMENT, TIDY = "Columns of the movement table", "Columns of the 3D CSV"
KINEMATICS, DEVICES = "Columns of the kinematics", "Columns of the devices' tables"
FOOTWORK = "Columns of the footwork"
TAKES, TOGETHER = "Columns of the evaluation of takes", "Columns of tables over takes and sessions"
FIGURES = "Columns of the figures' CSVs"
LABELS, QUANTILES = ": identify a row", ": are quantiles in percent"
SHAKE = ": `takes/<take>/shake/<camera>.csv`:"
SOURCE = [f"{DEVICES} | all", LABELS]
PATHS, DISTORTION = f"{DEVICES} | arcs...paths.csv", f"{DEVICES} | arcs...distortion.csv"
EVENTS = f"{DEVICES} | .events.csv"

# Where a table is described: the first pattern that fits its path below results/.
PLACES = {
    "virtual/*/court_points.csv": ["Clicked court points"],
    "virtual/*/racket.csv": [": `racket.csv` of virtual takes"],
    "plans/*/growth.csv": [f"{FIGURES} | plans/\\<plan>/growth"],
    "plans/*/map.csv": [f"{FIGURES} | error_map"],
    "*/calibration/file/check.csv": ["Columns of the check of a calibration file"],
    "*/calibration/file/videos.csv": ["Columns of the check of videos"],
    "*/calibration/file/court.csv": ["Columns of the check by painted lines"],
    "*/calibration/*/refinement.csv": ["Columns of the refinement by people"],
    "*/calibration/*/knocks.csv": ["Columns of the knocks"],
    "*/pose2d_steadied/*.csv": [SHAKE],
    "*/calibration/*/proposals.csv": [": `calibration/<calibration>/proposals.csv`: `camera`"],
    "*/sfm/*.csv": [": `sfm/features.csv`:"],
    "*/frames/*.csv": [FRAMES],
    "*/static/*.csv": [MOVEMENT],
    "*/movement/*.csv": [MOVEMENT],
    "*/shake/*.csv": [SHAKE],
    "*/views/*.csv": [f"{TAKES} | views", LABELS],
    "*/takes/*/motion/*.angles.csv": ["Columns of the joint angles"],
    "*/devices/*.frames.csv": [f"{DEVICES} | devices/<device>.frames.csv"],
    "*/devices/*.csv": [TIDY],
    "*/sync/*.wrists.csv": [f"{DEVICES} | .wrists.csv", *SOURCE],
    "*/sync/*.checks.csv": [f"{DEVICES} | .checks.csv", *SOURCE],
    "*/sync/*.csv": [EVENTS, *SOURCE],
    "*/body/*.paths.csv": [PATHS, *SOURCE],
    "*/body/*.distortion.csv": [DISTORTION, *SOURCE],
    "*/evaluation/takes/*/sources/*.errors.csv": [f"{DEVICES} | .errors.csv", *SOURCE],
    "*/evaluation/takes/*/sources/*.angles.csv": [
        f"{DEVICES} | .angles.csv",
        f"{TAKES} | angles",
        *SOURCE,
    ],
    "*/evaluation/takes/*/body_frames/*.csv": [f"{DEVICES} | ../body_frames/<model>.csv", *SOURCE],
    "*/evaluation/takes/*/sources/*.parts.csv": [f"{DEVICES} | .parts.csv", *SOURCE],
    "*/evaluation/takes/*/sources/*.true_paths.csv": [PATHS, *SOURCE],
    "*/evaluation/takes/*/sources/*.true_distortion.csv": [DISTORTION, *SOURCE],
    **{
        f"*/evaluation/takes/*/{table}/*.csv": [f"{TAKES} | {table}", LABELS]
        for table in (
            *("errors", "gains", "clocks", "kinematics", "angles", "detection", "round_trip"),
            *("contacts", "strokes", "reactions"),
        )
    },
    "*/evaluation/racket.csv": [f"{TAKES} | evaluation/racket.csv", OF_CALIBRATION],
    "networks/*/joint_offsets.csv": [f"{TAKES} | joint_offsets"],
    "networks/*/joint_errors.csv": [f"{TAKES} | joint_errors"],
    "*/evaluation/takes/*/reliability/*.csv": [f"{TAKES} | reliability", LABELS],
    "*/evaluation/skin_depths.*.csv": [f"{TAKES} | skin_depths"],
    "*/evaluation/*.csv": [OF_CALIBRATION],
    "*/takes/*/kinematics/*.frames.csv": [KINEMATICS],
    "*/takes/*/kinematics/*.summary.csv": [": `.summary.csv`:"],
    "*/takes/*/kinematics/*.cutoffs.csv": [": `.cutoffs.csv`:"],
    "*/takes/*/footwork/*.csv": [FOOTWORK],
    "*/takes/*/strokes/*.reactions.csv": ["Columns of the reactions"],
    "*/takes/*/strokes/*.csv": ["Columns of the strokes"],
    "*/takes/*/pose3d*/*.csv": [TIDY],
    "*/takes/*/quality.csv": ["Columns of the verdicts"],
    "figures/calibration.csv": [f"{TOGETHER} | calibration.csv", OF_CALIBRATION],
    "figures/ways.csv": [f"{TOGETHER} | ways.csv"],
    "figures/players.csv": [f"{TOGETHER} | players.csv", f"{TAKES} | errors", LABELS],
    "figures/angles.csv": [f"{TOGETHER} | {end}.csv" for end in ("angles", "players")]
    + [f"{TAKES} | errors", LABELS],
    "figures/study.csv": [f"{TOGETHER} | study.csv"],
    "figures/clock_errors.csv": [f"{TOGETHER} | clock_errors.csv", f"{TAKES} | clocks", LABELS],
    "figures/reliability.csv": [
        f"{TOGETHER} | reliability.csv",
        f"{TAKES} | reliability",
        LABELS,
    ],
    "figures/agreement.pairs.csv": [f"{TOGETHER} | agreement.pairs.csv", LABELS],
    "figures/agreement*.csv": [f"{TOGETHER} | agreement.{end}.csv" for end in ("table", "pairs")],
    "figures/networks*.csv": [f"{TOGETHER} | networks.csv"],
    "figures/archive.csv": [f"{TOGETHER} | {end}.csv" for end in ("archive", "agreement.pairs")],
    "figures/badminton_fig05.csv": [f"{FIGURES} | badminton_fig05", LABELS],
    "figures/badminton_fig12.csv": [f"{FIGURES} | badminton_fig12", QUANTILES, OF_CALIBRATION],
    "figures/smoothness.csv": [f"{FIGURES} | smoothness"],
    "figures/thesis_fig3_?.csv": [f"{FIGURES} | thesis_fig3_1", PATHS, *SOURCE],
    "figures/court_points.*.csv": [f"{FIGURES} | court_points"],
    "figures/worlds*.csv": [f"{FIGURES} | worlds", QUANTILES],
    "figures/capture_*.csv": [f"{FIGURES} | capture_...", QUANTILES],
    **{
        f"*/figures/badminton_fig{n}.*": [f"{FIGURES} | badminton_fig{n}"]
        for n in ("06", "08", "09", "10")
    },
    "*/figures/badminton_fig11.*": [
        f"{FIGURES} | {name}" for name in ("badminton_fig11", "overlay")
    ],
    "*/figures/badminton_tab01.*": [f"{TAKES} | round_trip", LABELS],
    "*/figures/kinematics.*": [KINEMATICS],
    "*/figures/footwork.*": [FOOTWORK],
    "*/figures/rally.*": [f"{FIGURES} | rally"],
    "*/figures/strokes.*": [f"{FIGURES} | strokes"],
    "*/figures/shake.*": [f"{FIGURES} | shake", SHAKE],
    "*/figures/three_cameras.*": [f"{FIGURES} | three_cameras", f"{TAKES} | errors", LABELS],
    "*/figures/source_errors.*": [
        f"{FIGURES} | source_errors",
        f"{DEVICES} | .errors.csv",
        f"{DEVICES} | .parts.csv",
        f"{DEVICES} | .angles.csv",
        f"{TAKES} | angles",
        *SOURCE,
    ],
    "*/figures/wrist_arcs.*": [f"{FIGURES} | thesis_fig3_1", PATHS, *SOURCE],
    "*/figures/wrist_distance.*": [f"{FIGURES} | wrist_distance", EVENTS, *SOURCE],
    **{
        f"*/figures/{name}.*": [f"{FIGURES} | {name}", QUANTILES]
        for name in (
            *("overlay", "skeletons", "reprojection", "visibility", "skeleton_plates"),
            *("coverage", "error_map", "growth"),
        )
    },
}
# Where the measures of a table are described. Those of comparisons are measures of `study.csv`.
MEASURES = {
    "*/takes/*/kinematics/*.summary.csv": OF_KINEMATICS,
    "*/takes/*/footwork/*.summary.csv": OF_FOOTWORK,
    "*/takes/*/quality.csv": OF_VERDICTS,
    "figures/study.csv": OF_KINEMATICS + OF_FOOTWORK,
    "figures/networks*.csv": OF_NETWORKS,
}


def faults(results, dictionary):
    """Return what the dictionary lacks of CSVs below a folder, and how many it was asked for."""
    found, n_tables = set(), 0
    for path in sorted(results.rglob("*.csv")):
        name = path.relative_to(results).as_posix()
        if name.startswith("external/"):
            continue
        n_tables += 1
        with path.open(newline="") as stream:
            reader = csv.DictReader(stream)
            columns = list(reader.fieldnames or [])
            described = next((MEASURES[key] for key in MEASURES if fnmatchcase(name, key)), ())
            measures = dict.fromkeys(row["measure"] for row in reader) if described else ()
        fitting = next((key for key in PLACES if fnmatchcase(name, key)), None)
        if fitting is None:
            found.add(f"{name}: no place in the dictionary")
            continue
        lacking = dictionary.undescribed(columns, PLACES[fitting])
        found |= {f"{fitting}: {column}" for column in lacking}
        lacking = dictionary.undescribed(measures, described)
        found |= {f"{fitting}: measure {measure}" for measure in lacking}
    return sorted(found), n_tables


@pytest.fixture(scope="module")
def dictionary():
    return Dictionary("\n".join((ROOT / name).read_text() for name in DOCUMENTS))


def test_every_part_that_tables_are_sent_to_is_there(dictionary):
    named = [*PLACES.values(), *MEASURES.values()]
    places = {place for some in named for place in some}
    assert [place for place in sorted(places) if not dictionary.part(place).strip()] == []


def test_every_column_of_the_study_is_described(tiny_study, dictionary):
    found, n_tables = faults(tiny_study, dictionary)
    assert found == []
    assert n_tables > 60


def keys(report, names):
    """Yield the keys of a JSON file at all depths, but for names of cameras and points."""
    for key, value in report.items():
        if key not in names:
            yield key
        if isinstance(value, dict):
            yield from keys(value, names)


def test_every_key_of_a_calibration_s_quality_is_described(tiny_study, dictionary):
    found = set()
    for path in tiny_study.glob("*/calibration/*/quality.json"):
        report = json.loads(path.read_text())
        cameras = camera.read_toml(path.with_name("cameras.toml"))
        names = {one.name for one in cameras} | set(report.get("left_out", ()))
        found |= set(keys(report, names))
    assert len(found) > 20
    assert dictionary.undescribed(found, ["Cameras", "Quality of a calibration"]) == []


def test_a_column_that_nobody_described_is_found(tmp_path, dictionary):
    movement = tmp_path / "gym" / "static" / "left.csv"
    movement.parent.mkdir(parents=True)
    movement.write_text("camera,shift_x_px,shift_z_px\n")
    (tmp_path / "gym" / "new.csv").write_text("a\n")
    assert faults(tmp_path, dictionary)[0] == [
        "*/static/*.csv: shift_z_px",
        "gym/new.csv: no place in the dictionary",
    ]


def test_a_measure_that_nobody_described_is_found(tmp_path, dictionary):
    folder = tmp_path / "gym" / "takes" / "t"
    (folder / "kinematics").mkdir(parents=True)
    known = "measure,value\nneck_ground_distance_in_gaps,1\nleft_knee_flexion_min,2\n"
    (folder / "kinematics" / "a.summary.csv").write_text(known + "neck_height_max,3\n")
    (folder / "quality.csv").write_text("measure,value\nwhole,1\nviews_2,1\nviews_9,1\n")
    assert faults(tmp_path, dictionary)[0] == [
        "*/takes/*/kinematics/*.summary.csv: measure neck_height_max",
        "*/takes/*/quality.csv: measure views_9",
    ]
