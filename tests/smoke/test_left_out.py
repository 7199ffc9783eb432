"""What the rules leave out for want of consent, and what they say of it; nothing is run."""

import pytest
import yaml

from smoke.snakemake_runs import FOLDER, ROOT, copy_repository, planned, run

TAKE = "results/walk-4cams-tiny/takes/balancing"
METHOD = "file.all-robust.blazepose-full"
TRC = f"{TAKE}/pose3d/{METHOD.replace('.', '/')}.p1.trc"
PICTURED = {"draw_overlay": 1, "export_overlay_video": 4}


@pytest.fixture(scope="module")
def gym(tmp_path_factory):
    """Return a function: it returns a repository copy with the real person's consent as said."""
    root = tmp_path_factory.mktemp("gym")
    copy_repository(root)
    name = "config/sessions/walk-4cams-tiny.yaml"

    def agreed(consent):
        session = yaml.safe_load((ROOT / name).read_text())
        session["subjects"]["p1"] = {} if consent is None else {"consent": consent}
        (root / name).write_text(yaml.safe_dump(session))
        return root

    return agreed


@pytest.fixture(scope="module")
def unasked(gym):
    """Return what is planned for a person whose consent the session does not say."""
    return planned(root=gym(None))


def test_files_for_other_programs_wait_for_consent(gym, unasked):
    assert "export_take" not in unasked
    assert {name: unasked[name] for name in PICTURED} == PICTURED
    assert planned(root=gym(["analysis", "export"]))["export_take"] == 3  # one for each stage


def test_pictures_are_not_drawn_of_whom_they_may_not_show(gym):
    jobs = planned(root=gym(["analysis"]))
    assert set(PICTURED) & set(jobs) == set()
    assert jobs["draw_skeletons"] >= 1


def test_nothing_is_made_of_somebody_who_withdrew(gym, unasked):
    jobs = planned(root=gym([]))
    assert "import_cameras" in jobs  # those are nobody's
    assert "draw_skeletons" not in jobs
    assert unasked["extract_static"] - jobs["extract_static"] == 3  # from the videos of this take
    assert jobs["detect_pose"] < unasked["detect_pose"]


def test_what_lacks_consent_is_told_before_a_run_and_where_nothing_is_to_be_done(gym):
    root = gym(["analysis", "pictures"])
    drawn = [f"results/figures/court_points.tennis.{suffix}" for suffix in ("pdf", "png", "csv")]
    for path in (root / FOLDER / name for name in (TRC, *drawn)):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    listed = root / FOLDER / "results/run/without_consent/walk-4cams-tiny.txt"
    for options in (["-n"], []):
        done = run(*options, "--", drawn[0], root=root)
        said = done.stdout + done.stderr
        assert "Nothing to be done" in said
        assert said.count("in take balancing: p1 has not agreed to export (consent)") == 1
        assert said.count(TRC) == 1
        assert listed.exists() == (not options)
    assert listed.read_text().splitlines() == [TRC]


@pytest.mark.parametrize(
    ("consent", "target", "words"),
    [
        (["analysis"], TRC, "expected export in the consent of p1 for this file of take balancing"),
        (["analysis"], f"{TAKE}/figures/overlay.{METHOD}.png", "expected pictures in the consent"),
        (
            [],
            f"{TAKE}/figures/skeletons.{METHOD}.png",
            "expected analysis in the consent of p1, found none",
        ),
    ],
)
def test_a_file_asked_for_by_name_is_refused_in_one_line(gym, consent, target, words):
    done = run("-n", "--", target, root=gym(consent), check=False)
    assert done.returncode != 0
    message = (done.stdout + done.stderr).splitlines()
    assert sum(words in line for line in message) == 1
