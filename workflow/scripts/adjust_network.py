"""Adjust a model with the clicked court points: COLMAP model, clicks -> what the ties say of the fixed cameras."""

import json
from pathlib import Path

import numpy as np

from courtside.geometry import control_points, court_adjustment, courts
from courtside.geometry import network as networks
from courtside.records import clicks, ties
from courtside.sfm import model, registration
from courtside.study import log
from courtside.study.errors import InputError


def main(summary_json, clicks_csv, court_yaml, ties_npz, *, cameras, min_points, **options):
    network, images, sizes = model.read(Path(summary_json).parent)
    summary = json.loads(Path(summary_json).read_text())
    fixed = {camera: f"static/{camera}.png" for camera in cameras}
    outcome = registration.outcome(
        network, images, fixed, min_points=min_points, n_models=summary["n_models"]
    )
    placed = {c: images.index(image) for c, image in fixed.items() if image in images}
    size_of = {camera: sizes[network.lens_of_image[at]] for camera, at in placed.items()}
    alone = control_points.alone(network, list(placed.values()))
    found = control_points.cameras(alone, list(placed), list(size_of.values()))
    known, fault, adjusted, residual_px = None, "", network, np.nan
    if not outcome:
        court = courts.read(court_yaml)
        marked = clicks.read(clicks_csv, cameras, list(court.points))
        try:
            known, adjusted = court_adjustment.condense(
                network, placed, size_of, marked, court, **options
            )
            residual_px = 1.4826 * np.median(np.abs(networks.residuals(adjusted)))
        except InputError as error:
            fault = str(error)
    log.logger.info("%s", outcome or fault or f"ties fit to {residual_px:.2f} px")
    seen = [registration.n_seen(network, images, fixed[camera]) for camera in placed]
    centres = control_points.centres(adjusted)
    record = ties.Record(outcome, fault, found, seen, known, images, centres, adjusted.xyz, residual_px)
    ties.write(ties_npz, record)


if __name__ == "__main__":
    log.to_file(snakemake.log[0])
    main(
        snakemake.input.summary,
        snakemake.input.clicks,
        snakemake.input.court,
        snakemake.output.ties,
        cameras=snakemake.params.cameras,
        **snakemake.params.step,
    )
