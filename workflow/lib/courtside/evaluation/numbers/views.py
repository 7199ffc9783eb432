"""The tables of the documents: which columns each shows of a table of the register."""

from courtside.evaluation.numbers.markers import View

STAGES = ("raw", "filtered", "corrected")
HALL, HALLS = "^`", "^all "
FOUND = {"by": "{found.origin}", "with": "{found.command}"}


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

VIEWS = {
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
    "halls-strengths": View("halls-strengths", STRENGTHS),
    "calibration-ways": View(
        "calibration-ways",
        {
            "way; session": "{row}",
            "trial RMS, median / 95 %": "{median} / {p95}",
            "95 % of points, median trial": "{points}",
            "X_o, Y_o on the floor, median": "{xy}",
            "trials, failed": "{median.n}, {median.n_failed}",
        },
    ),
    "calibration-growth": View(
        "calibration-growth",
        {
            "session, choices of images": "{row}",
            "trial RMS, median / 95 %": "{median} / {p95}",
            "stated 90 % hold, %": "{coverage}",
            "trials, failed": "{median.n}, {median.n_failed}",
        },
    ),
    "calibration-strengths": View("calibration-strengths", STRENGTHS),
    "capture": View(
        "capture",
        {
            "setting: way": "{row}",
            "trial RMS, median / 95 %, cm": "{median} / {p95}",
            "trials, failed": "{median.n}, {median.n_failed}",
        },
    ),
    "players-sessions": View(
        "players-sessions",
        {
            "virtual session": "{row}",
            **_stages("{STAGE_median} / {STAGE_p95} ({STAGE_median_worst} / {STAGE_p95_worst})"),
            "corrected, without the shift of the skeleton": (
                "{corrected_unshifted} / {corrected_unshifted_p95}"
            ),
            "90 % hold, raw / filtered / corrected (least take), %": " / ".join(
                f"{{{stage}_coverage}} ({{{stage}_least}})" for stage in STAGES
            ),
            "joints": "{raw_median.n}",
        },
    ),
    "players": View(
        "players",
        {
            "take: cameras, rule": "{row}",
            **_stages("{STAGE_median} / {STAGE_p95}"),
            "corrected: shift of the skeleton; without it": (
                "{corrected_shift}; {corrected_unshifted} / {corrected_unshifted_p95}"
            ),
            "90 % hold, raw / filtered / corrected, %": " / ".join(
                f"{{{stage}_coverage}}" for stage in STAGES
            ),
            "missing, raw / corrected, %": "{raw_missing} / {corrected_missing}",
            "joints": "{raw_median.n}",
        },
    ),
    "players-measures": View(
        "players-measures",
        {
            "take: cameras": "{row}",
            "speed RMSE of neck, centre, mass, m/s": "{neck_speed}, {centre_speed}, {mass_speed}",
            "stated 90 % of speeds hold, %": "{neck_held}, {centre_held}, {mass_held}",
            "error of their distances, %": "{neck_far}, {centre_far}, {mass_far}",
            "largest clock error, ms (within their 90 %, of)": (
                "{clock} ({clocks_within}, {clocks})"
            ),
        },
    ),
    "angles": View(
        "angles",
        {
            "angle, session": "{row}",
            **{
                f"{stage}: bias, RMSE, 90 % hold": (
                    f"{{{stage}_bias}}, {{{stage}_rmse}}, {{{stage}_coverage}} %"
                )
                for stage in STAGES
            },
            "angles": "{raw_bias.n}",
        },
    ),
    "networks": View(
        "networks",
        {
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
    ),
    "footage": View(
        "footage",
        {
            "footage, against which reference": "{row}",
            **_stages("{STAGE_median} / {STAGE_p90} / {STAGE_p95}"),
            "joints": "{raw_median.n}",
            "measured": "{raw_median.origin}",
            "with": "{raw_median.command}",
        },
    ),
    "markers": View(
        "markers",
        {
            "joint; cameras": "{row}",
            **{
                heading: f"{{{part}_median}} ({{{part}_median_from}} to {{{part}_median_to}}) / "
                f"{{{part}_p90}}"
                for part, heading in {
                    **dict(zip(STAGES, STAGES, strict=True)),
                    "hand": "set by hand, same cameras",
                }.items()
            },
            "90 % hold, raw / filtered / corrected, %": " / ".join(
                f"{{{stage}_coverage_90}}" for stage in STAGES
            ),
            "missing, raw / corrected, %": "{raw_missing} / {corrected_missing}",
            "scale off, raw / corrected / by hand, %": (
                "{raw_scale} / {corrected_scale} / {hand_scale}"
            ),
            "joints": "{raw_median.n}",
        },
    ),
    "body-model": View(
        "body-model",
        {
            "measure, takes": "{row}",
            **{
                f"{stage}: median take, worst": f"{{{stage}_median}}, {{{stage}_worst}}"
                for stage in ("corrected", "model")
            },
            "takes": "{model_median.n}",
        },
    ),
    "body-model-hall": View(
        "body-model-hall",
        {
            "angle; cameras": "{row}",
            **{
                f"{stage}, RMSE (interval), degrees": f"{{{stage}_rmse}} ({{{stage}_least}} to "
                f"{{{stage}_most}})"
                for stage in ("corrected", "model")
            },
            "angles": "{model_rmse.n}",
        },
    ),
    "joints": View(
        "joints",
        {
            "joint, take": "{row}",
            **_stages("{STAGE_median} / {STAGE_p95}"),
            "90 % hold, raw / filtered / corrected, %": " / ".join(
                f"{{{stage}_coverage}}" for stage in STAGES
            ),
            "n": "{raw_median.n}",
        },
    ),
    "views": View(
        "views",
        {
            "take: cameras, rule": "{row}",
            "from all cameras, median / 95 %, mm": "{median} / {p95}",
            "left and right exchanged, % of frames": "{exchanged}",
            "joints": "{median.n}",
        },
    ),
    "racket": View(
        "racket",
        {
            "session, ends": "{row}",
            "authors: 8 points; walk": "{their8}; {their_walk}",
            "re-enacted: 8 points (DLT); walk": "{dlt8}; {paper3}",
            "8 known points": "{known8}",
            "walk + 18 clicks": "{sfm18}",
            "perfect cameras": "{perfect}",
            "walk + 18 clicks over perfect": "{sfm18_ratio}",
            "runs, failed": "{sfm18.n}, {sfm18.n_failed}",
        },
    ),
    "published-walk": View(
        "published-walk",
        {
            "session: calibrated from": "{row}",
            "authors: at two of its own points": "{published}",
            "re-enacted: there; over the volume": "{again_xy}; {again_volume}",
            "its trials, failed": "{again_xy.n}, {again_xy.n_failed}",
            "ours, 18 clicks: there; over the volume": "{here_xy}; {here_volume}",
        },
    ),
    "table-1": View(
        "table-1",
        {
            "take, cameras: what": "{row}",
            "authors": "{published} ({published_sd}) {published.unit}",
            "here, mean (sd)": "{mean} ({sd}) {mean.unit}",
        },
    ),
    "devices": View(
        "devices",
        {
            "take: source": "{row}",
            "in the body frame of its T-pose, median / 95 %": "{body_median} / {body_p95}",
            "hips laid together, median / 95 %": "{root_median} / {root_p95}",
            "joints": "{body_median.n}",
        },
    ),
    "body-frames": View(
        "body-frames",
        {"take: source": "{row}", "angle, degrees": "{angle}", "unit, %": "{unit}"},
    ),
    **{
        name: View(name, {"what": "{row}", "target": "{target}", "found": "{found}", **FOUND})
        for name in ("real-checks", "device-checks", "crowd")
    },
    **{
        name: View(name, {"what": "{row}", "found": "{found}", **FOUND})
        for name in ("hall-points", "file-evidence", "mapping-checks", "costs", "batches")
    },
    "offset-cameras": View(
        "offset-cameras",
        {
            "corrected, median / 95 %, mm": "{row}",
            "offsets fitted by clicked cameras": "{before}",
            "by true cameras (used)": "{after}",
            "by": "{after.origin}",
            "with": "{after.command}",
        },
    ),
    "persons-found": View(
        "persons-found",
        {
            "persons of 80 px or more; detector": "{row}",
            "found in the whole picture, %": "{whole}",
            "in tiles, as the study looks, %": "{tiles}",
            "persons": "{tiles.n}",
            "by": "{tiles.origin}",
            "with": "{tiles.command}",
        },
    ),
    "held": View(
        "held",
        {
            "stated 90 % of": "{row}",
            "hold, raw / filtered / corrected, %": " / ".join(f"{{{stage}}}" for stage in STAGES),
            "of errors above 100 mm, %": " / ".join(f"{{{stage}_large}}" for stage in STAGES),
            "values, corrected": "{corrected.n}",
        },
    ),
    "stated-errors": View(
        "stated-errors",
        {
            "90 % ellipsoids hold, %": "{row}",
            "target": "{target}",
            **_stages("{STAGE}"),
            "by": "{raw.origin}",
            "with": "{raw.command}",
        },
    ),
    "flags": View(
        "flags",
        {
            "flag of errors above 100 mm": "{row}",
            "four views: right / found, %": "{four}",
            "three views: right / found, %": "{three}",
            "by": "{four.origin}",
            "with": "{four.command}",
        },
    ),
    "file-mended": View(
        "file-mended",
        {
            "`walk-4cams`, cameras": "{row}",
            "file as it is": "{found}",
            "mended": "{mended}",
            "by": "{found.origin}",
            "with": "{found.command}",
        },
    ),
    "file-faults": View(
        "file-faults",
        {
            "fault of one camera of four (`players-b/shot`, 6 seeds each)": "{row}",
            "static points: warned, camera and fault named": "{static}",
            "joints": "{joints}",
            "both": "{both}",
            "by": "{static.origin}",
            "with": "{static.command}",
        },
    ),
    "contacts": View(
        "contacts",
        {
            "takes": "{row}",
            "frames right": "{frames}",
            "landing: error, median / 90 %": "{onset}",
            "in its 90 % interval": "{onset_held}",
            "leaving: error, median / 90 %": "{end}",
            "in that of leaving": "{end_held}",
            "landings found": "{steps}",
            "a standing foot moves": "{moved}",
            "by": "{frames.origin}",
            "with": "{frames.command}",
        },
    ),
    "strokes": View(
        "strokes",
        {
            "takes": "{row}",
            "hits": "{hits}",
            "found (>= 95 %)": "{found}",
            "false (<= 5 %)": "{false}",
            "error of the time in frames, median (<= 1) / 95 %": "{median} / {p95}",
            "in 90 % intervals (80 to 97 %)": "{held}",
            "by": "{hits.origin}",
            "with": "{hits.command}",
        },
    ),
    "stroke-cues": View(
        "stroke-cues",
        {
            "extremum nearest to the stroke, less the true hit, in frames": "{row}",
            "overhead: median, sd (within one frame)": "{overhead}",
            "low: median, sd (within one frame)": "{low}",
            "by": "{low.origin}",
            "with": "{low.command}",
        },
    ),
    "ways": View(
        "ways",
        {
            "way": "{row}",
            "alone: volume error, median / 95 %, cm; shape, cm; accepted, %": "{alone}",
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
        "^`(walk|charuco|hall)",
    ),
    "lines-clicks": View(
        "lines-clicks",
        {
            "hall": "{row}",
            "court found; 18 clicks, median / 95 %, cm; court lines, cm; lines / clicks": "{found}",
        },
    ),
    "refined-people": View(
        "refined-people",
        {
            "cameras": "{row}",
            "before": "{before}",
            "taken": "{taken}",
            "shape before": "{shape_before}",
            "shape taken": "{shape}",
            "in 90 % ellipsoids": "{coverage}",
            "by": "{taken.origin}",
            "with": "{taken.command}",
        },
    ),
    "knocked-cameras": View(
        "knocked-cameras",
        {
            "take": "{row}",
            "found": "{found}",
            "turn off, across the view": "{across}",
            "about the optical axis": "{roll}",
            "joints without the knock": "{whole}",
            "with it": "{knocked}",
            "with two poses": "{repaired}",
            "by": "{repaired.origin}",
            "with": "{repaired.command}",
        },
    ),
    "more-of-people": View(
        "more-of-people",
        {
            "cameras": "{row}",
            "volume": "{volume}",
            "limb lengths": "{limbs}",
            "tilt of the floor": "{tilt}",
            "volume, floor level": "{levelled}",
            "with": "{volume.command}",
        },
    ),
    **{
        name: View(
            name,
            {
                first: "{row}",
                **{strength: f"{{{strength}}}" for strength in ("x1", "x2", "x3")},
                "by": "{x1.origin}",
                "with": "{x1.command}",
            },
        )
        for name, first in {"click-model": "halls: clicks", "click-alarms": "clicks"}.items()
    },
    "worlds": View(
        "worlds",
        {
            "effect, strength 1": "{row}",
            "18 clicks, cm": "{walk18}",
            "held, 18": "{held18}",
            "3 clicks, cm": "{walk3}",
            "held, 3": "{held3}",
            "warnings": "{warnings}",
            "by": "{walk18.origin}",
            "with": "{walk18.command}",
        },
    ),
    "speed": View(
        "speed",
        {
            "comparison, largest work": "{row}",
            "here": "{found}",
            "other": "{other}",
            "other / here": "{ratio}",
            **FOUND,
        },
    ),
    "stages": View(
        "stages",
        {
            "stage": "{row}",
            "before": "{before}",
            "after": "{found}",
            "ratio": "{ratio}",
            "profile before": "{profile_before}",
            "profile after": "{profile_after}",
            **FOUND,
        },
    ),
    "faults": View(
        "faults",
        {"fault": "{row}", "times": "{times}", "survived": "{found}", **FOUND},
    ),
    "trust": View(
        "trust",
        {"what was done": "{row}", "times": "{times}", "what happened": "{found}", **FOUND},
    ),
}
