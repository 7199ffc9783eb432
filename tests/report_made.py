"""A small study on disk for tests of the report: one session with a walk, one take, a figure, a table."""

import json

import cv2
import numpy as np

import walker
from courtside.records.devices import clocks
from courtside.records.keypoints import keypoints

ROGUE = '</script><img src="https://example.invalid/x">"&'
SUMMARY = """person,measure,value,sigma,sigma_camera,unit,n,definition
p1,neck_distance,29.3274,0.2,0.05,m,19,mid-shoulders
p1,neck_speed_mean,1.22538,0.0094363,,m/s,19,mid-shoulders
p1,neck_speed_max,2.65,,,m/s,19,mid-shoulders
p1,left_knee_flexion_min,-12.8,5.7,,degrees,19,lines
p1,left_knee_flexion_max,89.7,5.7,,degrees,19,lines
"""
QUALITY = {
    "calibration": "sfm-n40",
    "tie_residual_px": 0.3,
    "warnings": [],
    "left_out": {f"p{at:02d}": {"error_cm": float(at), "error_px": {}} for at in (1, 2, 3)},
    "expected_volume_rms_cm": 0.7,
}
MODEL = {
    "mapper": "global",
    "n_images": 42,
    "n_registered": 42,
    "n_points3d": 2416,
    "reprojection_px": 0.87,
}
PARAMETERS = {
    "extract_features": {"max_features": 4096},
    "match_images": {"max_ratio": 0.8},
    "adjust_network": {"click_sigma_px": 0.7, "click_bias_px": 0.5, "tie_sigma": 2.0},
    "detect_pose": {"min_presence": 0.5},
    "synchronise_cameras": {"max_offset_s": 10},
    "triangulate": {
        "min_score": 0.05,
        "min_views": 2,
        "max_error_px": 15,
        "fade_px": 20,
        "fix_sides": True,
    },
    "filter_motion": {"max_gap_s": 0.2, "order": 4, "cutoff_hz": {"head": 6, "arms": 10}},
    "measure_kinematics": {"cutoff_hz": {"head": 7}, "distance_cutoff_hz": 5},
}


def moved(camera, shift_px=0.1):
    return (
        "camera,shift_x_px,shift_y_px,zoom_percent,rotation_deg,n_matches\n"
        f"{camera},{shift_px},0.0,0.001,0.0,300\n"
    )


def files_of_take(folder, n_frames=20):
    """Write what `facts.of_take` reads of a take with one person; return its paths."""
    lines = ["frame_idx,time_s,person,neck_reason", "0,0.0,p1,uncertain"]
    lines += [f"{at},{at / 50},p1,ok" for at in range(1, n_frames)]
    paths = {
        "summary": folder / "take.summary.csv",
        "frames": folder / "take.frames.csv",
        "pose3d": folder / "take.npz",
        "sync": folder / "clocks.json",
        "shake": folder / "shake.txt",
    }
    paths["summary"].write_text(SUMMARY)
    paths["frames"].write_text("\n".join(lines) + "\n")
    keypoints.write_3d(paths["pose3d"], walker.points(n_frames))
    found = clocks.Clock(0.2, 3.0, 0.001, 10.0, "found", "offset adjusted")
    clocks.write(paths["sync"], "c0", {"c0": clocks.Clock(status="reference"), "c1": found})
    paths["shake"].write_text("camera c0: trembles by 0.01 px rms per axis, 0.1 mm at the player\n")
    (folder / "c0.csv").write_text(moved("c0"))
    return {key: str(path) for key, path in paths.items()} | {"movement": [str(folder / "c0.csv")]}


def picture(folder, width=1800):
    """Write a drawing of few colours, wider than a page shows; return its path."""
    drawn = np.full((600, width, 3), 255, np.uint8)
    cv2.circle(drawn, (700, 300), 200, (200, 60, 20), -1)
    path = folder / "overlay.sfm-n40.png"
    cv2.imwrite(str(path), drawn)
    return str(path)


def study(folder, name="hall", description="A hall"):
    """Write a whole study into a folder and return what `report.build` takes."""
    (folder / "quality.json").write_text(json.dumps(QUALITY))
    (folder / "model.json").write_text(json.dumps(MODEL))
    caption = folder / "caption.rst"
    caption.write_text(
        "Take {{ snakemake.wildcards.take }}: *n* is {{ snakemake.params.step.n }}.\n"
    )
    table = folder / "calibration.csv"
    table.write_text("method,empty,error_cm,remark\nsfm,,0.123456,a < b\n" + "dlt,,99,\n" * 30)
    take = {
        "name": "smash",
        "fusion": "all-robust",
        "files": files_of_take(folder),
        "links": [("hall/takes/smash/viewer.html", "3D viewer")],
    }
    session = {
        "name": name,
        "description": description,
        "virtual": False,
        "way": "sfm-n40",
        "mapper": "global",
        "n_images": 40,
        "fusion": "all-robust",
        "model": "blazepose-full",
        "overrides": {"triangulate": {"fade_px": 13}},
        "limits": {"max_shift_px": 1.0, "max_zoom_percent": 0.2},
        "files": {
            "quality": {"sfm-n40": str(folder / "quality.json")},
            "model": str(folder / "model.json"),
            "static": [str(folder / "c0.csv")],
        },
        "takes": [take],
    }
    drawn = {
        "png": picture(folder),
        "caption": str(caption),
        "wildcards": {"take": "smash"},
        "params": {"step": {"n": 17}},
        "session": name,
        "take": "smash",
        "links": [("hall/figures/overlay.csv", "numbers (CSV)")],
    }
    tables = {
        "file": str(table),
        "title": "Calibration",
        "words": "Errors.",
        "link": "calibration.csv",
    }
    return {
        "title": "Report",
        "parameters": PARAMETERS,
        "sessions": [session],
        "figures": [drawn, {**drawn, "session": "", "take": ""}],
        "tables": [tables],
    }
