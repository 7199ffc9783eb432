"""What a run was, told by made-up jobs with the attributes of Snakemake's."""

import json
import os
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from courtside.study import paths
from courtside.study.errors import InputError
from courtside.study.execution import verdicts
from courtside.study.provenance import run


def made_up(name, *outputs, script="draw.py", **params):
    rule = SimpleNamespace(name=name, script=script and f"../scripts/{script}")
    return SimpleNamespace(
        name=name,
        rule=rule,
        input=["in.csv"],
        output=list(outputs),
        log=[f"{name}.log"],
        params=params,
        products=lambda: [*outputs, f"{name}.log"],
    )


class Dag:
    """Jobs, of which some are finished."""

    def __init__(self, jobs, finished):
        self.jobs, self.done = jobs, finished
        self.derived_targetfiles = [path for job in jobs for path in job.output]

    def needrun_jobs(self, exclude_finished=True):
        return self.jobs

    def noneedrun_finished(self, job):
        return job in self.done

    finished = noneedrun_finished


def workflow(jobs=(), finished=(), failed=None, touch=False):
    settings = SimpleNamespace(configfiles=[], config={})
    scheduler = None if failed is None else SimpleNamespace(failed=failed)
    return SimpleNamespace(
        dag=Dag(list(jobs), list(finished)),
        persistence=SimpleNamespace(has_metadata=lambda job: True),
        scheduler=scheduler,
        touch=touch,
        config_settings=settings,
        configfiles=[],
    )


def test_a_job_becomes_plain_values():
    job = made_up("draw", "results/a.csv", code="abc", step={"n": 3})
    assert run.plain_job(job, Dag([job], [job]), touched=False) == {
        "rule": "draw",
        "script": "draw.py",
        "code": "abc",
        "inputs": ["in.csv"],
        "outputs": ["results/a.csv", "draw.log"],
        "params": {"step": {"n": 3}},
        "done": True,
        "made": True,
    }


def test_where_an_artefact_comes_from_is_no_setting_of_what_it_holds():
    job = made_up("fetch_net", "results/external/net.tflite", pin="0f", mirror_folder="/mirror")
    assert run.plain_job(job, Dag([job], [job]), touched=False)["params"] == {"pin": "0f"}


def test_files_that_were_only_touched_were_not_made():
    job = made_up("all", script=None)
    found = run.plain_job(job, Dag([job], [job]), touched=True)
    assert (found["script"], found["code"]) == (None, None)
    assert (found["done"], found["made"]) == (True, False)


def test_the_command_is_said_from_the_folder_of_the_repository(tmp_path, monkeypatch):
    study = tmp_path / "studies" / "mine"
    study.mkdir(parents=True)
    monkeypatch.chdir(study)
    changed = {"sessions": ["a"], "name": "b"}
    settings = SimpleNamespace(configfiles=[tmp_path / "config" / "tiny.yaml"], config=changed)
    assert run.repeating_command(settings, tmp_path) == [
        *("snakemake", "--directory", "studies/mine", "--configfile", "config/tiny.yaml"),
        *("--config", 'sessions=["a"]', "name=b"),
    ]
    plain = SimpleNamespace(configfiles=[], config={})
    assert run.repeating_command(plain, study) == ["snakemake"]


def test_sidecars_tell_the_command_and_the_configuration(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results").mkdir()
    for name in ("in.csv", "results/a.csv", "draw.log"):
        (tmp_path / name).write_text("x")
    job = made_up("draw", "results/a.csv", code="abc")
    run.record(workflow([job], [job]), tmp_path, {"sessions": []}, ["config/models.yaml"])
    found = json.loads((tmp_path / "results" / "run" / "provenance.json").read_text())
    assert found["command"] == "snakemake"


def test_sidecars_that_cannot_be_written_are_told_in_one_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results").write_text("no folder")
    job = made_up("draw", "results/a.csv")
    with pytest.raises(InputError, match=r"results/run: provenance not written: .* mend this"):
        run.record(workflow([job], [job]), tmp_path, {}, [])


def changed_during_a_run(tmp_path, monkeypatch, finished):
    """Return the workflow, and the states before it, of a run during which its input changed."""
    monkeypatch.chdir(tmp_path)
    for name in ("in.csv", "results/a.csv", "draw.log"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("x")
    os.utime("in.csv", (1000, 1000))
    job, other = made_up("draw", "results/a.csv"), made_up("next", "results/b.csv")
    other.input = ["results/a.csv"]
    flow = workflow([job, other], [job] if finished else [])
    before = run.states(flow)
    assert before == {"in.csv": (1, 1000 * 10**9)}
    assert run.unsure(flow, tmp_path, before) == run.changed_since(before) == []
    Path("results/a.csv").write_text("made")
    Path("in.csv").write_text("of another size, with an older date")
    os.utime("in.csv", (900, 900))
    return flow, before


def test_an_input_that_changed_during_a_run_has_no_checksum_and_is_told(tmp_path, monkeypatch):
    flow, before = changed_during_a_run(tmp_path, monkeypatch, finished=True)
    (line,) = run.unsure(flow, tmp_path, before)
    assert line.startswith("Warning: in.csv changed during this run")
    assert line.endswith(": snakemake --forcerun results/a.csv")
    run.record(flow, tmp_path, {}, [], run.changed_since(before))
    sidecar = json.loads(Path("results/run/provenance/a.csv.json").read_text())
    assert sidecar["inputs"] == {"in.csv": None}
    kept = Path(paths.CHECKSUMS)
    assert not kept.exists() or "in.csv" not in json.loads(kept.read_text())["files"]


def test_an_input_of_jobs_that_were_not_run_may_change(tmp_path, monkeypatch):
    flow, before = changed_during_a_run(tmp_path, monkeypatch, finished=False)
    assert run.changed_since(before) == ["in.csv"]
    assert run.unsure(flow, tmp_path, before) == []


def test_the_end_says_what_was_made(tmp_path):
    job = made_up("draw", "results/x/figures/a.png")
    words = run.ending(workflow([job], [job]), tmp_path, 42, [])
    assert "1 file made in 42 s" in words
    assert "results/x/figures/a.png" in words


def test_a_report_of_an_earlier_run_is_not_to_be_looked_at(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    job, report = made_up("draw", "results/a.png"), made_up("build_report", "results/report.html")
    end = {"repository": tmp_path, "seconds": 42, "look_at": ["results/report.html", "no.csv"]}
    assert "report" not in run.ending(workflow([job], [job]), **end)
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "report.html").touch()
    both = workflow([job, report], [job, report])
    assert run.ending(both, **end).endswith("Look at results/report.html.")
    one = workflow([job], [job])
    one.config_settings.configfiles = [tmp_path / "config" / "north hall.yaml"]
    command = "snakemake report --configfile 'config/north hall.yaml'"
    last = run.ending(one, **end).splitlines()[-1]
    assert last == f"results/report.html is of an earlier run; {command} makes it anew."
    assert "report" not in run.ending(workflow(), **end)  # nothing was made: it may be of this run


def test_the_end_names_what_this_run_made_to_look_at(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    viewers = [f"{take}.html" for take in ("a", "b", "c")]
    look_at = ["players.csv", "ways.csv"]
    jobs = [made_up("build", path) for path in (*viewers, *look_at)]
    for job in jobs:
        (tmp_path / job.output[0]).touch()
    only = workflow(jobs, jobs)
    monkeypatch.setattr(only.dag, "needrun_jobs", lambda exclude_finished: [*jobs[1:3], jobs[4]])
    said = run.ending(only, tmp_path, 42, look_at, viewers=viewers)
    assert said.endswith("Look at ways.csv, b.html.")


def test_the_end_says_what_failed(tmp_path):
    jobs = [made_up("draw", "a.png"), made_up("draw_all", "b.png")]
    words = run.ending(workflow(jobs, jobs[:1], failed=jobs[1:]), tmp_path, 42, [])
    assert "stopped after 1 of 2 jobs" in words
    assert "draw_all: no log of its own" in words


def test_sessions_that_wait_for_clicks_are_told(study):
    assert run.waiting_for_clicks(study) == []
    waiting = replace(study.sessions["plain-tiny"], unclicked="data/p.csv")
    (line,) = run.waiting_for_clicks(replace(study, sessions={"plain-tiny": waiting}))
    assert line.startswith("plain-tiny: court points are not clicked yet: open results/plain-tiny/")
    assert line.endswith("save them as data/p.csv, and give the same command again")


def test_warnings_about_cameras_of_recorded_takes_are_told(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["plain-tiny"]
    recorded = replace(session, virtual=None, calibration_file="c.toml")
    ways = recorded.take_calibrations()
    assert ways
    study = replace(study, sessions={"north": replace(recorded, name="north")})
    assert run.warnings(study) == []
    quality = tmp_path / f"results/north/calibration/{ways[0]}/quality.json"
    quality.parent.mkdir(parents=True)
    quality.write_text(json.dumps({"f_px": 1}))
    assert run.warnings(study) == []
    quality.write_text(json.dumps({"warnings": ["camera left moved", "b", "c", "d", "e"]}))
    said = run.warnings(study)
    where = f"results/north/calibration/{ways[0]}/quality.json"
    assert said[0] == f"Warning: north: camera left moved; see {where}"
    assert said[3:] == [f"Warning: north: 2 more, see {where}"]
    quality.write_text(json.dumps({"warnings": [], "remarks": ["cameras refined by people"]}))
    assert run.warnings(study) == [f"north: cameras refined by people; see {where}"]
    virtual = {"north": replace(recorded, name="north", virtual={"seed": 1})}
    assert run.warnings(replace(study, sessions=virtual)) == []


def test_pictures_that_a_model_of_photos_lost_are_told(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["plain-tiny"]
    study = replace(study, sessions={"plain-tiny": replace(session, cameras={})})
    assert run.lost_pictures(study) == []
    summary = tmp_path / "results/plain-tiny/sfm/global-n12-o0/summary.json"
    summary.parent.mkdir(parents=True)
    summary.write_text(json.dumps({"n_images": 12, "n_registered": 12}))
    assert run.lost_pictures(study) == []
    summary.write_text(json.dumps({"n_images": 12, "n_registered": 6}))
    (line,) = run.lost_pictures(study)
    assert line.startswith("plain-tiny: 6 of 12 pictures not in the model global-n12-o0:")


def test_photos_that_a_model_of_fixed_cameras_lost_are_named(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["plain-tiny"]
    study = replace(study, sessions={"plain-tiny": session})
    variants = [vars(variant) for variant in session.variants()]
    models = [Path(paths.SFM_SUMMARY.format(session="plain-tiny", **one)) for one in variants]

    def told(own_name):
        lost = {"frames/walk/000004.png": own_name}
        for model in models:
            model.parent.mkdir(parents=True, exist_ok=True)
            model.write_text(json.dumps({"n_images": 13, "n_registered": 12, "unregistered": lost}))
        return run.lost_pictures(study)

    (line,) = told("06.jpg")
    assert line.startswith(f"plain-tiny: 1 of 13 pictures not in the model {models[0].parts[-2]}")
    assert " (06.jpg is frames/walk/000004.png): too little overlap" in line
    assert line.endswith("; add pictures in between, or leave it out")
    assert told("") == []  # a frame of a video


def test_what_is_left_out_for_want_of_consent_is_told_with_what_remains(
    study, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    assert run.left_out(study) == []
    session = study.sessions["walk-4cams-tiny"]
    subjects = {"p1": replace(session.subjects["p1"], consent=())}
    withdrawn = replace(session, subjects=subjects, takes={}, withheld=session.takes)
    study = replace(study, sessions={"walk-4cams-tiny": withdrawn})
    line = "nothing is made of take balancing: p1 has not agreed to analysis (consent)"
    assert run.left_out(study) == [f"walk-4cams-tiny: {line}"]
    made = "results/walk-4cams-tiny/takes/balancing"
    (tmp_path / made).mkdir(parents=True)
    pages = "results/walk-4cams-tiny/pages"
    (line,) = run.left_out(study)[1:]
    assert line == (
        f"walk-4cams-tiny: {made} was made before: delete it, {pages} and results/report.html, "
        "which may show it"
    )
    (tmp_path / made).rmdir()
    Path(pages).mkdir()
    for path in (f"{pages}/quality.html", "results/report.html"):
        Path(path).touch()
    (line,) = run.left_out(replace(study, sessions={"walk-4cams-tiny": withdrawn}))[1:]
    assert line == (
        "walk-4cams-tiny: 1 file that persons have not agreed to was made before, "
        f"{pages}/quality.html: delete all that results/run/without_consent/walk-4cams-tiny.txt "
        "lists, and results/report.html, which may show them"
    )


def test_takes_that_a_session_no_longer_has_are_told(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = replace(study, sessions={"plain-tiny": study.sessions["plain-tiny"]})
    Path("results/plain-tiny/takes/old").mkdir(parents=True)
    (line,) = run.left_out(study)
    assert line.startswith("plain-tiny: results/plain-tiny/takes/old belongs to no take of")


def test_cameras_that_a_take_no_longer_has_are_told(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = replace(study, sessions={"players-tiny": study.sessions["players-tiny"]})
    take = next(iter(study.sessions["players-tiny"].takes))
    folder = Path(f"results/players-tiny/takes/{take}/movement")
    folder.mkdir(parents=True)
    (folder / "old.csv").touch()
    line = (
        f"players-tiny: {folder.parent.as_posix()} has files of old, which this take does not have"
    )
    assert run.left_out(study) == run.remaining(study) == [f"{line}: delete them"]


def test_files_that_persons_no_longer_agree_to_are_listed(study, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = study.sessions["walk-4cams-tiny"]
    only = {name: replace(one, consent=("analysis",)) for name, one in session.subjects.items()}
    study = replace(study, sessions={"walk-4cams-tiny": replace(session, subjects=only)})
    n_told = len(run.left_out(study))
    take = Path("results/walk-4cams-tiny/takes/balancing")
    way = "file/all-robust/blazepose-full"
    gone = [take / "pose3d" / f"{way}.p1.trc", take / "pages" / "people.html"]
    gone += [take / "figures" / f"overlay.{way.replace('/', '.')}.png"]
    gone += [take / "videos" / f"{way}.cam01.mp4"]
    allowed = [take / "pose3d" / f"{way}.npz", take / "pages" / "viewer.blazepose-full.html"]
    allowed += [take / "figures" / f"skeletons.{way.replace('/', '.')}.png"]
    for path in (*gone, *allowed):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    *others, line = run.left_out(study)
    assert len(others) == n_told
    assert line.startswith("walk-4cams-tiny: 4 files that persons have not agreed to were made")
    listed = Path("results/run/without_consent/walk-4cams-tiny.txt")
    assert listed.read_text().splitlines() == sorted(path.as_posix() for path in gone)
    told = run.remaining(study)[-1]
    assert told.startswith("walk-4cams-tiny: 4 files that persons have not agreed to are here")
    for path in gone:
        path.unlink()
    assert run.remaining(study) == []
    assert len(run.left_out(study)) == n_told
    assert not listed.exists()


def test_takes_of_this_run_are_told_with_their_verdicts(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files = [f"results/hall/takes/{take}/quality.csv" for take in ("a", "b")]
    head = ",".join([*verdicts.WAY, *verdicts.COLUMNS])
    for path, word in zip(files, ("good", "failed"), strict=True):
        (tmp_path / path).parent.mkdir(parents=True)
        row = f"file,all-robust,net,all,all,whole,,,,{word},clock,Camera c1 is {word}."
        (tmp_path / path).write_text(f"{head}\n{row}\n", encoding="utf-8")
    judged = [made_up("judge_take", path) for path in files]
    (message, n_failed), other = run.verdicts(workflow(judged)), made_up("draw", "x/quality.csv")
    assert n_failed == 1 and message[0] == "Verdicts on takes: 1 good, 1 failed."
    assert message[1].startswith("  failed: hall/b")
    assert run.verdicts(workflow([judged[0], other])) == (["Verdicts on takes: 1 good."], 0)
    words = run.ending(workflow(judged, judged, failed=[]), tmp_path, 3.0, [], 1)
    assert words.startswith("Courtside: 2 files made in 3 s, but 1 take failed")
