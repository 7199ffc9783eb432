"""The words at the end of a run: what was made and where, or what failed and what to do."""

import shutil

import pytest

from courtside.study.errors import SPARE_MEMORY
from courtside.study.execution import summary

MADE = [
    *(
        f"results/hall/takes/smash/figures/{name}.{form}"
        for name in "abcd"
        for form in ("png", "csv")
    ),
    "results/figures/e.png",
    "results/hall/takes/smash/pages/viewer.net.html",
    "results/hall/calibration/sfm-n40/cameras.toml",
    "results/hall/takes/smash/pose3d/sfm-n40/all/net.p1.trc",
    "results/hall/sfm/features.db",
]


def test_what_was_made_is_counted_by_kind():
    lines = summary.finished(MADE, 200.4).splitlines()
    assert lines[0] == "Courtside: finished, 13 files made in 3 min 20 s."
    assert "  figures (5): results/hall/takes/smash/figures/, results/figures/" in lines
    assert "  3D viewers (1): results/hall/takes/smash/pages/viewer.net.html" in lines
    assert "  calibrated cameras (1): results/hall/calibration/sfm-n40/cameras.toml" in lines
    assert not any("features.db" in line for line in lines)


@pytest.mark.parametrize(("n_failed", "words"), [(1, "1 take failed"), (3, "3 takes failed")])
def test_a_failed_take_is_not_called_finished(n_failed, words):
    first = summary.finished(MADE, 12.0, n_failed=n_failed).splitlines()[0]
    assert first == f"Courtside: 13 files made in 12 s, but {words}: see the end."


def test_many_folders_are_counted():
    made = [f"results/s{at}/figures/x.png" for at in range(9)]
    assert "s0/figures/, results/s1/figures/, results/s2/figures/ and 6 more" in summary.finished(
        made, 1
    )


def test_what_to_look_at_is_there(tmp_path):
    (tmp_path / "report.html").touch()
    there, gone = str(tmp_path / "report.html"), str(tmp_path / "gone.html")
    assert summary.finished(MADE, 1, [gone, there]).endswith(f"Look at {there}.")
    assert "Look at" not in summary.finished(MADE, 1, [gone])


def test_nothing_to_do_is_said():
    assert (
        summary.finished([], 3.0)
        == "Courtside: everything was there already, nothing had to be made."
    )


def test_a_failure_gives_the_fault_the_log_and_what_to_do(tmp_path):
    log = tmp_path / "take.log"
    log.write_text(
        "2026-01-01 10:00:00,000 INFO 3 of 9\n"
        "2026-01-01 10:00:01,000 ERROR smash.mp4: expected a video, found text; give a video\n"
        "Removing output files\n"
    )
    faults = [("detect_pose", [str(log)]), ("fetch_artefact", [])]
    text = summary.failed(faults, 12, 30, 61)
    assert "stopped after 12 of 30 jobs, 1 min 1 s" in text
    assert (
        f"detect_pose: smash.mp4: expected a video, found text; give a video (whole log: {log})"
        in text
    )
    assert "fetch_artefact: no log of its own" in text
    assert "same command again" in text and "snakemake --unlock" in text


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("one\ntwo\n\n", "two"),
        ("", f"its log is empty: it was killed, or disk or memory are full; {SPARE_MEMORY}"),
        (
            "2026-01-01 10:00:00,000 INFO 3 of 9\n",
            "it was killed, or ran out of memory; "
            "its last words: 2026-01-01 10:00:00,000 INFO 3 of 9",
        ),
    ],
)
def test_a_log_without_an_error_gives_its_last_line(tmp_path, content, expected):
    log = tmp_path / "take.log"
    log.write_text(content)
    assert f"rule: {expected} (whole" in summary.failed([("rule", [str(log)])], 0, 1, 1)


def test_every_failure_of_a_folder_of_faulty_files_is_told(tmp_path):
    logs = [tmp_path / f"take{number}.log" for number in range(19)]
    for log in logs:
        log.write_text(f"2026-01-01 10:00:00,000 ERROR {log.stem}.bvh: expected a BVH file\n")
    text = summary.failed([("import_device", [str(log)]) for log in logs], 0, 57, 1)
    assert all(f"{log.stem}.bvh: expected" in text for log in logs) and "more job" not in text


def test_more_failures_are_counted_with_the_places_of_their_logs(tmp_path):
    logs = [tmp_path / take / "import.log" for take in ("a", "b")]
    for log in logs:
        log.parent.mkdir()
        log.write_text("cut off\n")
    text = summary.failed([("rule", [])] * 20 + [("rule", [str(log)]) for log in logs], 0, 99, 1)
    assert text.count("rule: ") == 20
    assert f"and 2 more jobs (their logs: {logs[0]}, {logs[1]})" in text
    assert "\n  and 1 more job\n" in summary.failed([("rule", [])] * 21, 0, 99, 1)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(41.6, "42 s"), (60, "1 min 0 s"), (3599, "59 min 59 s"), (7500, "2 h 5 min")],
)
def test_durations_are_words(seconds, words):
    assert summary.duration(seconds) == words


def test_a_log_that_a_full_disk_left_empty_says_so(tmp_path, monkeypatch):
    log = tmp_path / "take.log"
    log.touch()
    usage = shutil.disk_usage(tmp_path)._replace(free=300_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: usage)
    (told,) = [
        line
        for line in summary.failed([("rule", [str(log)])], 0, 1, 1).splitlines()
        if line.startswith("  rule: ")
    ]
    assert told.startswith("  rule: its log could not be written: ")
    assert "expected at least 20 MB free on its disk, found 0.3 MB; free some room" in told
