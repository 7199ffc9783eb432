"""Tables that numbers come from: written out for the tiny study."""

from courtside.study.targets import numbers

PLAYERS = "results/players-tiny/evaluation/takes"
WAY = "known18.blazepose-full"


def test_tables_are_those_of_the_study_without_pictures(study):
    found = numbers.every_table(study)
    assert len(found) == len(set(found))
    assert {path.rpartition(".")[2] for path in found} == {"csv"}
    assert "results/figures/players.csv" in found and "results/figures/networks.table.csv" in found
    assert "results/plain-tiny/evaluation/known.csv" in found
    assert f"{PLAYERS}/shot/errors/{WAY}.csv" in found
    assert f"{PLAYERS}/shot/round_trip/{WAY}.csv" in found
    assert f"{PLAYERS}/shot/errors/sfm-n40.blazepose-full.csv" not in found


def test_tables_follow_the_configuration(study, studies):
    fewer = numbers.every_table(studies(sessions=["plain-tiny"]))
    assert set(fewer) < set(numbers.every_table(study))
    assert not [path for path in fewer if "/takes/" in path]


def test_takes_of_the_figure_of_cameras_have_their_measures_with_every_fusion(study):
    kinematics = [p for p in numbers.every_table(study) if f"{PLAYERS}/shot/kinematics/" in p]
    (session, take), *_ = study.named_takes(study.parameters["draw_three_cameras"]["takes"])
    every = session.fusions() + session.fusions("compared_fusions")
    assert take.name == "shot" and len(kinematics) == len(set(every))
    assert all(any(f"/{fusion}/" in path for path in kinematics) for fusion in every)
