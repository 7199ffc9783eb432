"""The tables of the documents: which columns each shows of a table of the register."""

from courtside.evaluation.numbers import stated_views
from courtside.evaluation.numbers.document_tables import View
from courtside.evaluation.numbers.stated_views import made
from courtside.study.methods import STAGE_WORDS

STAGES = tuple(STAGE_WORDS.values())
HALL, HALLS = "^`", "^all "


def _walk(name: str) -> str:
    return f"{{{name}}} / {{{name}_p95}} / {{{name}_points}}"


def _interval(name: str) -> str:
    return f"{{{name}}} ({{{name}_from}} to {{{name}_to}})"


def _stages(pattern: str) -> dict[str, str]:
    return {stage: pattern.replace("STAGE", stage) for stage in STAGES}


WALKS = {
    "walk18": "walk + 18 clicks",
    "walk3": "walk + 3 clicks",
    "known18": "18 points, no walk",
}
LENSES = {"board18": "18 points, known lens"}
PUBLISHED = {"paper": "the published walk, re-enacted"}


def _over_halls(ways: dict[str, str]) -> dict[str, str]:
    return {
        "over": "{row}",
        **{words: f"{_interval(name)}, worst {{{name}_worst}}" for name, words in ways.items()},
        "walk + 18 less 18 points": _interval("walk18_less_known18"),
        "walk + 3 less 18 points": _interval("walk3_less_known18"),
    }


STRENGTHS = {
    "session, clicks": "{row}",
    **{
        words: f"{{{part}_median}} / {{{part}_p95}}; {{{part}_coverage}} %"
        for part, words in {
            "walk18": "walk + 18 clicks",
            "walk8": "walk + 8 clicks",
            "walk3": "walk + 3 clicks",
        }.items()
    },
    "18 points, no walk": "{known18_median} / {known18_p95}",
    "trials": "{walk18_median.n}",
}

ANGLES = {
    "knee flexion": "knee_flexion",
    "hip flexion": "hip_flexion",
    "elbow flexion": "elbow_flexion",
    "shoulder elevation": "shoulder_elevation",
    "trunk lean": "trunk_lean",
}

SHOWN = {
    "summary": {"what was measured": "{row}", "error": "{error}"},
    "halls-strengths": STRENGTHS,
    "calibration-ways": {
        "way; session": "{row}",
        "trial RMS, median / 95 %": "{median} / {p95}",
        "95 % of points, median over trials": "{points}",
        "X_o, Y_o on the floor, median": "{xy}",
        "trials, failed": "{median.n}, {median.n_failed}",
    },
    "calibration-growth": {
        "session, choices of images": "{row}",
        "trial RMS, median / 95 %": "{median} / {p95}",
        "stated 90 % hold, %": "{coverage}",
        "trials, failed": "{median.n}, {median.n_failed}",
    },
    "calibration-strengths": STRENGTHS,
    "capture": {
        "setting: way": "{row}",
        "trial RMS, median / 95 %, cm": "{median} / {p95}",
        "trials, failed": "{median.n}, {median.n_failed}",
    },
    "players-sessions": {
        "virtual session": "{row}",
        **_stages("{STAGE_median} / {STAGE_p95} ({STAGE_median_worst} / {STAGE_p95_worst})"),
        "corrected, without the shift of the skeleton": (
            "{corrected_unshifted} / {corrected_unshifted_p95}"
        ),
        "in 90 % ellipsoids, %: raw / filtered / corrected (least take)": " / ".join(
            f"{{{stage}_coverage}} ({{{stage}_least}})" for stage in STAGES
        ),
        "joints, raw / corrected": "{raw_median.n} / {corrected_median.n}",
    },
    "players": {
        "take: cameras, rule": "{row}",
        **_stages("{STAGE_median} / {STAGE_p95}"),
        "corrected: shift of the skeleton; without it": (
            "{corrected_shift}; {corrected_unshifted} / {corrected_unshifted_p95}"
        ),
        "in 90 % ellipsoids, %: raw / filtered / corrected": " / ".join(
            f"{{{stage}_coverage}}" for stage in STAGES
        ),
        "missing, raw / corrected, %": "{raw_missing} / {corrected_missing}",
        "joints, raw / corrected": "{raw_median.n} / {corrected_median.n}",
    },
    "players-measures": {
        "take: cameras": "{row}",
        "speed RMSE of neck, centre, mass, m/s": "{neck_speed}, {centre_speed}, {mass_speed}",
        "stated 90 % of speeds hold, %": "{neck_held}, {centre_held}, {mass_held}",
        "error of their distances, %": "{neck_far}, {centre_far}, {mass_far}",
        "largest clock error, ms (within their 90 %, of)": ("{clock} ({clocks_within}, {clocks})"),
    },
    "angles": {
        "angle, session": "{row}",
        **{
            f"{stage}: bias, RMSE, 90 % hold": (
                f"{{{stage}_bias}}, {{{stage}_rmse}}, {{{stage}_coverage}} %"
            )
            for stage in STAGES
        },
        "angles, raw / corrected": "{raw_bias.n} / {corrected_bias.n}",
    },
    "networks": {
        "network; pictures": "{row}",
        "2D error, median, px": _interval("error_median"),
        "95 %, px": _interval("error_p95"),
        "of the torso, median / 95 %, %": "{error_median_torso} / {error_p95_torso}",
        "PCK@0.2, %": _interval("pck"),
        "sides exchanged, %": _interval("exchanged"),
        "jitter, px": _interval("jitter"),
        "3D error, median / 95 %, mm": f"{_interval('error_3d_median')} / {{error_3d_p95}}",
        "joints in 2D": "{error_median.n}",
        "time of a person, over the first": "{time}",
    },
    "footage": {
        "footage, against which reference": "{row}",
        **_stages("{STAGE_median} / {STAGE_p90} / {STAGE_p95}"),
        "joints, raw / corrected": "{raw_median.n} / {corrected_median.n}",
        "measured": "{raw_median.origin}",
        "with": "{raw_median.command}",
    },
    "markers": {
        "joint; cameras": "{row}",
        **{
            heading: f"{{{part}_median}} ({{{part}_median_from}} to {{{part}_median_to}}) / "
            f"{{{part}_p90}}"
            for part, heading in {
                **dict(zip(STAGES, STAGES, strict=True)),
                "hand": "set by hand, same cameras",
            }.items()
        },
        "in 90 % ellipsoids, %: raw / filtered / corrected": " / ".join(
            f"{{{stage}_coverage_90}}" for stage in STAGES
        ),
        "missing, raw / corrected, %": "{raw_missing} / {corrected_missing}",
        "scale off, raw / corrected / by hand, %": (
            "{raw_scale} / {corrected_scale} / {hand_scale}"
        ),
        "joints, raw / corrected": "{raw_median.n} / {corrected_median.n}",
    },
    "body-model": {
        "measure, takes": "{row}",
        **{
            f"{stage}: median take, 95 % of takes (shares: lowest)": (
                f"{{{stage}_median}}, {{{stage}_worst}}"
            )
            for stage in ("corrected", "model")
        },
        "takes": "{model_median.n}",
    },
    "body-model-hall": {
        "angle; cameras": "{row}",
        **{
            f"{stage}, RMSE (interval), degrees": f"{{{stage}_rmse}} ({{{stage}_least}} to "
            f"{{{stage}_most}})"
            for stage in ("corrected", "model")
        },
        "angles": "{model_rmse.n}",
    },
    "device-angles": {
        "take: source": "{row}",
        **{
            words: f"{{{name}_deg_source}} / {{{name}_deg_model}}; {{{name}_within_source}} / "
            f"{{{name}_within_model}} %"
            for words, name in ANGLES.items()
        },
        "joints, median, mm": "{median_mm_source} / {median_mm_model}",
        "joints, 95 %, mm": "{p95_mm_source} / {p95_mm_model}",
    },
    "device-solvers": {
        "session, suit: solver": "{row}",
        **{words: f"{{{name}_deg}}" for words, name in ANGLES.items()},
        "joints, median / 95 %, mm": "{median_mm} / {p95_mm}",
        "takes": "{median_mm.n}",
    },
    "opensim": {
        "measure": "{row}",
        "this project: median take, worst": "{model_median}, {model_worst}",
        "OpenSim: median take, worst": "{opensim_median}, {opensim_worst}",
        "takes": "{model_median.n}",
    },
    "opensim-angles": {
        "angle": "{row}",
        "RMSE, degrees": "{rmse}",
        "mean difference, degrees": "{mean}",
        "scatter about it, degrees": "{scatter}",
        "frames": "{rmse.n}",
    },
    "joints": {
        "joint, take": "{row}",
        **_stages("{STAGE_median} / {STAGE_p95}"),
        "in 90 % ellipsoids, %: raw / filtered / corrected": " / ".join(
            f"{{{stage}_coverage}}" for stage in STAGES
        ),
        "joints, raw / corrected": "{raw_median.n} / {corrected_median.n}",
    },
    "views": {
        "take: cameras, rule": "{row}",
        "from all cameras, median / 95 %, mm": "{median} / {p95}",
        "left and right exchanged, % of frames": "{exchanged}",
        "joints": "{median.n}",
    },
    "racket": {
        "session, ends": "{row}",
        "authors: 8 points; walk": "{their8}; {their_walk}",
        "re-enacted: 8 points (DLT); walk": "{dlt8}; {paper3}",
        "8 known points": "{known8}",
        "walk + 18 clicks": "{sfm18}",
        "perfect cameras": "{perfect}",
        "walk + 18 clicks: error divided by that of perfect cameras": "{sfm18_ratio}",
        "runs; failed: 8 known points, walk": "{sfm18.n}; {known8.n_failed}, {sfm18.n_failed}",
    },
    "published-walk": {
        "session: calibrated from": "{row}",
        "authors: at X_o and Y_o": "{published}",
        "re-enacted: at X_o and Y_o; over the volume": "{again_xy}; {again_volume}",
        "its trials, failed": "{again_xy.n}, {again_xy.n_failed}",
        "ours, 18 clicks: at X_o and Y_o; over the volume": "{here_xy}; {here_volume}",
    },
    "table-1": {
        "take, cameras: what": "{row}",
        "authors": "{published} ({published_sd}) {published.unit}",
        "here, mean (sd)": "{mean} ({sd}) {mean.unit}",
    },
    "devices": {
        "take: source": "{row}",
        "in the body frame of its T-pose, median / 95 %": "{body_median} / {body_p95}",
        "hips laid together, median / 95 %": "{root_median} / {root_p95}",
        "joints": "{body_median.n}",
    },
    "body-frames": {"take: source": "{row}", "angle, degrees": "{angle}", "unit, %": "{unit}"},
    **{
        name: {"what": "{row}", "target": "{target}", "found": "{found}", **made("found")}
        for name in ("real-checks", "device-checks", "crowd")
    },
    **{
        name: {"what": "{row}", "found": "{found}", **made("found")}
        for name in (
            *("hall-points", "file-evidence", "mapping-checks", "costs", "batches"),
            "fewer-cameras",
        )
    },
    "held": {
        "stated 90 % of": "{row}",
        "hold, raw / filtered / corrected, %": " / ".join(f"{{{stage}}}" for stage in STAGES),
        "of errors above 100 mm, %": " / ".join(f"{{{stage}_large}}" for stage in STAGES),
        "errors above 100 mm": " / ".join(f"{{{stage}_large.n}}" for stage in STAGES),
        "values, corrected": "{corrected.n}",
    },
}

FILTERED = {  # some rows of a table
    **{
        name: View(
            "real-people",
            {
                "recording, reference: measure": "{row}",
                **_stages("{STAGE_first} / {STAGE_second}"),
                **more,
                "values, raw / corrected": "{raw_first.n} / {corrected_first.n}",
            },
            rows,
        )
        for name, rows, more in (
            ("real-joints", "mm$", {"reference": "{reference_first} / {reference_second}"}),
            ("real-angles", "degrees$", {}),
        )
    },
    "ways": View(
        "ways",
        {
            "way": "{row}",
            "alone: volume error, median / 95 %, cm (people alone: joints, mm); shape, cm; "
            "accepted, %": "{alone}",
            "refined by people; refined cameras taken": "{refined}",
        },
        "^`players-b`",
    ),
    "ways-real": View(
        "ways",
        {
            "recording: way": "{row}",
            "alone; accepted views by camera, %": "{alone}",
            "refined by people; which cameras were taken": "{refined}",
        },
        "^`(walk|charuco|hall|easywand)",
    ),
    "calibration": View(
        "calibration",
        {
            "hall": "{row}",
            "walk + 18 clicks": _walk("walk18"),
            "walk + 3 clicks": _walk("walk3"),
            "18 points, no walk": _walk("known18"),
            "18 points, known lens": _walk("board18"),
            "the published walk, re-enacted": _walk("paper"),
            "its trials, failed": "{paper.n}, {paper.n_failed}",
            "walk less 18 points, 95 % interval": _interval("walk18_less_known18"),
        },
        HALL,
    ),
    "calibration-halls": View("calibration", _over_halls(WALKS | LENSES | PUBLISHED), HALLS),
    "halls": View(
        "halls",
        {
            "hall": "{row}",
            "walk + 18 clicks": _walk("walk18"),
            "walk + 3 clicks": _walk("walk3"),
            "18 points, no walk": _walk("known18"),
            "trials, failed": "{walk18.n}, {walk18.n_failed}",
            "walk less 18 points, 95 % interval": _interval("walk18_less_known18"),
        },
        HALL,
    ),
    "halls-together": View("halls", _over_halls(WALKS), HALLS),
}

VIEWS = FILTERED | {
    name: View(name, columns) for name, columns in (SHOWN | stated_views.SHOWN).items()
}
