"""What the study makes to look around in: written out for the tiny study."""

from dataclasses import replace

from courtside.study.targets import pages


def test_takes_with_a_skeleton_have_a_viewer(study):
    assert pages.every_viewer(study) == [
        "results/walk-4cams-tiny/takes/balancing/pages/viewer.blazepose-full.html",
        "results/players-tiny/takes/shot/pages/viewer.blazepose-full.html",
        "results/players-tiny/takes/rally/pages/viewer.blazepose-full.html",
        "results/single-view-tiny/takes/claps/pages/viewer.blazepose-full.html",
    ]


def test_videos_with_skeletons_are_made_of_the_takes_asked_for(study, studies):
    folder = "results/walk-4cams-tiny/takes/balancing/videos/file/all-robust"
    cameras = ("cam01", "cam02", "cam03", "cam04")
    expected = [f"{folder}/blazepose-full.{camera}.mp4" for camera in cameras]
    assert pages.every_overlay_video(study) == expected
    step = {**study.parameters["export_overlay_video"], "takes": []}
    assert pages.every_overlay_video(studies(export_overlay_video=step)) == []


def test_sessions_that_wait_for_clicks_have_a_page_for_them(study):
    assert pages.every_clicking_page(study) == []
    waiting = replace(study.sessions["plain-tiny"], unclicked="data/p.csv")
    study = replace(study, sessions={**study.sessions, "plain-tiny": waiting})
    assert pages.every_clicking_page(study) == ["results/plain-tiny/pages/clicking.html"]


def test_people_are_named_on_a_page_of_real_takes_and_of_takes_of_several(study):
    assert pages.every_people_page(study) == [
        "results/walk-4cams-tiny/takes/balancing/pages/people.html"
    ]
    session = study.sessions["players-tiny"]
    both = replace(session.takes["shot"], subjects=("p1", "p2"))
    assert pages.people_pages(session, both) == [
        "results/players-tiny/takes/shot/pages/people.html"
    ]
    shy = replace(session.subjects["p1"], consent=("analysis",))
    refused = replace(session, subjects={**session.subjects, "p1": shy})
    assert pages.people_pages(refused, both) == []
    assert (
        pages.people_pages(replace(session, subjects=session.subjects), session.takes["shot"]) == []
    )


def test_sessions_with_judged_takes_have_a_page_for_quality(study):
    assert pages.every_quality_page(study) == [
        "results/walk-4cams-tiny/pages/quality.html",
        "results/players-tiny/pages/quality.html",
    ]


def test_plans_are_drawn_twice(study):
    stems = ("results/plans/plain-a/growth", "results/plans/plain-a/map")
    expected = [f"{stem}.{suffix}" for stem in stems for suffix in ("pdf", "png", "csv")]
    assert pages.every_plan(study) == expected
