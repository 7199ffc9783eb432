"""Adjust a model with clicked court points: COLMAP model, clicks -> tie points of fixed cameras."""

import json
from pathlib import Path

import numpy as np

from courtside.calibration.bundle import conversion, selection, walk_parts
from courtside.calibration.court import court as court_files
from courtside.calibration.court import joint_adjustment
from courtside.calibration.records import tie_points
from courtside.calibration.records.support import Support
from courtside.records.cameras import clicks, image_names
from courtside.sfm import model, registration, two_views
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.script import run


def main(
    summary_json, matches_db, clicks_csv, court_yaml, ties_npz, *, cameras, min_points, **options
):
    network, images, sizes = model.read(Path(summary_json).parent)
    summary = json.loads(Path(summary_json).read_text(encoding="utf-8"))
    fixed = {camera: image_names.static(camera) for camera in cameras}
    every = list(fixed.values()) + summary["bridging_images"]
    verified = two_views.read(matches_db, every)
    outcome = registration.outcome(
        network,
        images,
        fixed,
        min_points=min_points,
        n_models=summary["n_models"],
        matched={image for pair in verified.matches for image in pair},
    )
    placed = {c: images.index(image) for c, image in fixed.items() if image in images}
    size_of = {camera: sizes[network.lens_of_image[at]] for camera, at in placed.items()}
    found = conversion.fixed_cameras(network, placed, size_of)
    known, fault, residual_px, strain = None, "", np.nan, np.nan
    centres, points = selection.centres(network), network.xyz
    support = Support(**summary["explained"])
    if not outcome:
        try:
            known, parts = adjust(network, placed, size_of, clicks_csv, court_yaml, **options)
            centres, points = walk_parts.centres(parts), walk_parts.points(parts)
            residual_px = walk_parts.residual_spread(parts)
            strain = joint_adjustment.strain(parts) if court_yaml else np.nan
            views = walk_parts.views(parts, images, sizes)
            adjusted = two_views.explained(verified, views)
            support = max(support, adjusted, key=lambda each: each.pair_share)
        except InputError as error:
            fault = str(error)
    log.logger.info("%s", outcome or fault or f"ties fit to {residual_px:.2f} px")
    seen = [registration.n_seen(network, images, fixed[camera]) for camera in placed]
    n_maps = summary["n_agreeing"], summary["n_attempts"]
    told = centres, points, residual_px, n_maps, support, strain
    record = tie_points.Record(outcome, fault, found, seen, known, images, *told)
    tie_points.write(ties_npz, record)


def adjust(
    network, placed, size_of, clicks_csv, court_yaml, *, tie_sigma, click_bias_px, **options
):
    options["tie_sigma_px"] = tie_sigma * selection.residual_spread(network)
    if not court_yaml:
        options = {k: v for k, v in options.items() if not k.startswith("click_")}
        return joint_adjustment.condense_free(network, placed, size_of, **options)
    court = court_files.read(court_yaml)
    marked = clicks.read(clicks_csv, list(placed), list(court.points))
    options["click_sigma_px"] = np.hypot(options["click_sigma_px"], click_bias_px)
    return joint_adjustment.condense(network, placed, size_of, marked, court, **options)


if __name__ == "__main__":
    run(main, snakemake)
