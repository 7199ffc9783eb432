"""Predict the errors of a planned session.

Reads plan and court; writes the expected error against N, and over the court.
"""

from courtside.calibration.court import court as court_files
from courtside.calibration.planning import cameras, tie_points
from courtside.calibration.planning import prediction as planning
from courtside.figures.calibration import error_map, plan
from courtside.figures.style import style
from courtside.sfm import model
from courtside.study.configuration import plans
from courtside.study.errors import InputError
from courtside.study.execution import log
from courtside.study.execution.script import run

THINNING = ("min_angle_deg", "max_error_px", "max_points", "seed")
WEIGHTS = ("images_per_part", "tie_sigma", "click_sigma_px", "click_bias_px", "click_loss")


def main(
    plan_yaml,
    court_yaml,
    growth_pdf,
    growth_png,
    growth_csv,
    map_pdf,
    map_png,
    map_csv,
    *,
    heights_m,
    adjust,
):
    planned, court = plans.read(plan_yaml), court_files.read(court_yaml)
    fixed = [cameras.camera(name, **vars(c)) for name, c in planned.cameras.items()]
    found = predict_all(planned, fixed, court, adjust)
    limits = {"min_points": adjust["min_points"], "target_cm": planned.target_cm}
    chosen, reason = planning.needed(found, **limits)
    enough = (
        f"{chosen.n_images} bridging images" if chosen else "not enough with any number of images"
    )
    verdict = f"{enough}: {reason}" if any(planned.n_images) else planning.alone(found[0])
    log.logger.info("%s", verdict)
    rows = plan.table(found, chosen)
    title = f"{planned.description}\n{verdict}"
    drawing = plan.draw(rows, title, widest_deg=planning.WIDEST_DEG, **limits)
    style.save(drawing, rows, growth_pdf, growth_png, growth_csv)
    drawn = chosen or [prediction for prediction in found if prediction.solution][-1]
    rows = error_map.table(fixed, drawn.solution.named, court, heights_m)
    walked = f"{drawn.n_images} bridging images" if drawn.n_images else "court points alone"
    title = f"{planned.description}, {walked}"
    drawing = error_map.draw(rows, fixed, court, title)
    style.save(drawing, rows, map_pdf, map_png, map_csv)


def predict_all(planned, fixed, court, adjust):
    texture = tie_points.TEXTURES[planned.texture]
    walk = planned.walk
    mobile_px = walk.size_px if walk else fixed[0].size  # without a walk, no image is by it
    prior = model.lens_prior([*(camera.size for camera in fixed), mobile_px])
    options = {key: adjust[key] for key in WEIGHTS} | {"thinning": {k: adjust[k] for k in THINNING}}
    options |= {"seed": adjust["seed"]}
    if planned.click_sigma_px is not None:
        options["click_sigma_px"] = planned.click_sigma_px
    found = []
    for n in log.progress(planned.n_images, len(planned.n_images), "numbers of bridging images"):
        walked = (
            cameras.walked_cameras(n_images=n, seed=adjust["seed"], **vars(walk)) if walk else []
        )
        about = (court, planned.hall_m, texture, prior)
        found.append(planning.predict(fixed, walked, *about, **options))
    if not any(prediction.solution for prediction in found):
        raise InputError(found[-1].fault)
    return found


if __name__ == "__main__":
    run(main, snakemake)
