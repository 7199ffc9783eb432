"""Files and settings of structure from motion, of calibrations and of the page for clicking."""

from pathlib import Path
from typing import Any

from courtside.study import paths
from courtside.study.errors import InputError
from courtside.study.jobs import recordings, takes
from courtside.study.jobs.job import Job
from courtside.study.methods import IMPORTED, Calibration

CLICK_KEYS = ("click_sigma_px", "click_bias_px", "click_loss")
# Files of one calibration: whichever of them is given, its reader takes the others beside it.
TOGETHER = (
    {"intri.yml", "extri.yml"},
    {"cameras.bin", "images.bin", "cameras.txt", "images.txt"},
)
OF_FOLDER = {".yml", ".yaml", ".xml", ".pickle", ".pkl"}  # kinds of files that a folder may hold


def each_fixed(job: Job, pattern: str) -> list[str]:
    """Return a file of each fixed camera of a session."""
    return job.of_each(pattern, camera=job.session.cameras)


def of_hall(job: Job) -> list[str]:
    """Return a picture of the hall by each fixed camera: its static one, or of its first take."""
    session = job.session
    return [
        job.fill(paths.STATIC, camera=name)
        if camera.static
        else job.fill(paths.BACKGROUND, camera=name, take=session.first_take(name))
        for name, camera in session.cameras.items()
    ]


def halls(job: Job) -> list[dict[str, Any]]:
    """Return the pictures of a hall by camera, of the static recordings and of each take."""
    session = job.session
    return [
        {
            "take": take,
            "pictures": {
                name: job.fill(paths.BACKGROUND, camera=name, take=take)
                if take and not session.cameras[name].static
                else job.fill(paths.STATIC, camera=name)
                for name in cameras
            },
        }
        for take, cameras in session.filmed_halls().items()
    ]


def of_full_size(job: Job) -> list[str]:
    """Return of each fixed camera a picture or video of the size that its clicks are in."""
    session = job.session
    return [
        job.fill(paths.STATIC, camera=name)
        if camera.static
        else next(take.videos[name] for take in session.takes.values() if name in take.videos)
        for name, camera in session.cameras.items()
    ]


def each_walk(job: Job, pattern: str) -> list[str]:
    """Return a file of each walk of a session."""
    return job.of_each(pattern, walk=job.session.walks)


def mapping(job: Job) -> dict[str, Any]:
    """Return the parameters of one mapping: those of its mapper among COLMAP's."""
    chosen = dict(job.step("map_images"))
    per_mapper = {"options": chosen.pop("colmap"), "attempts": chosen.pop("attempts")}
    return {**chosen, **{key: value[job["mapper"]] for key, value in per_mapper.items()}}


def clicks(job: Job) -> dict[str, Any]:
    """Return the parameters of clicks, which all calibrations share."""
    return job.some("adjust_network", CLICK_KEYS)


def crops_px(job: Job) -> dict[str, tuple]:
    """Return the parts of the calibrated pictures that videos show, by camera."""
    return {name: camera.crop_px for name, camera in job.session.cameras.items() if camera.crop_px}


def scales(job: Job) -> dict[str, float]:
    """Return how much larger or smaller videos are than calibrated, by camera; without 1."""
    return {name: camera.scale for name, camera in job.session.cameras.items() if camera.scale != 1}


def checked(job: Job) -> list[dict[str, Any]]:
    """Return of each filmed take the files that check a calibration file: what cameras see."""
    return _seen(job, "file", [name for name, take in job.session.takes.items() if take.cameras])


def placing(job: Job) -> list[dict[str, Any]]:
    """Return of each take whose people place cameras its keypoints, clocks and heights, m."""
    model, found = job.session.parameters["models"][0], []
    for name in wanted_takes(job):
        take = job.session.takes[name]
        one = Job(job.study, {**job.wildcards, "take": name, "model": model})
        timing = {"synchronised": take.synchronised, "stated": takes.clocks(one, take.cameras)}
        heights_m = takes.stated(one, "height_m")
        pose2d = takes.each_camera(one, paths.POSE2D)
        found.append({"take": name, "pose2d": pose2d, "heights_m": heights_m, "timing": timing})
    return found


def joint_offsets(job: Job) -> Path | list:
    """Return the joint offsets of the network whose keypoints place cameras, where it has some."""
    model = {"model": job.session.parameters["models"][0]}
    return takes.known_of_network(Job(job.study, {**job.wildcards, **model}), paths.OFFSETS_CSV)


def known_lenses(job: Job) -> list[str]:
    """Return the lenses of the cameras that have pictures of a chessboard."""
    return _lenses(job, "people")


def wanted_takes(job: Job) -> list[str]:
    """Return the takes whose people refine or place cameras; an `InputError` if one is unknown."""
    known = [name for name, take in job.session.takes.items() if take.cameras]
    wanted = job.step("refine_cameras")["takes"] or known
    if missing := [name for name in wanted if name not in known]:
        raise InputError(
            f"{job.study.where(job.session, 'refine_cameras.takes')}: expected filmed takes of "
            f"session {job.session.name}, {known}, found {missing}; name others, or null for all"
        )
    return list(wanted)


def refining(job: Job) -> list[dict[str, Any]]:
    """Return of each take whose people refine cameras the files of what cameras see."""
    return _seen(job, _base(job)["calibration"], wanted_takes(job))


def of_base(job: Job, pattern: str) -> str | list:
    """Return a file of the calibration that people refine; nothing of another."""
    return _base(job).fill(pattern) if _way(job).base else []


def base_covariance(job: Job) -> str | list:
    """Return its covariance where it has one."""
    return covariance(_base(job)) if _way(job).base else []


def error_map(job: Job) -> dict[str, Any]:
    """Return the heights of a map of expected errors, and what is stated of a base's cameras."""
    return {**job.step("draw_error_map"), "stated": stated(job)}


def stated(job: Job) -> dict[str, float]:
    """Return the standard deviations stated of cameras whose calibration has no covariance."""
    return {key: value for key, value in job.step("refine_cameras").items() if key != "takes"}


def unused_clicks(job: Job) -> str | list:
    """Return the court's clicks where the calibration that people refine does not rest on them."""
    base = _way(job).base
    unused = base is not None and not Calibration.parse(base).of_clicks
    return (not job.session.placed and unused and job.session.court_points) or []


def base_file(job: Job) -> str | list:
    """Return the file that it was read from, where it was."""
    return job.session.calibration_file or [] if _way(job).base == "file" else []


def _base(job: Job) -> Job:
    return Job(job.study, {**job.wildcards, "calibration": _way(job).base or ""})


def _seen(job: Job, way: str, names: list[str]) -> list[dict[str, Any]]:
    """Return `take`, `pose2d` of each camera by the first network, `sync` and `people`."""
    model, found = job.session.parameters["models"][0], []
    for name in names:
        known = {**job.wildcards, "take": name, "model": model, "calibration": way}
        one = Job(job.study, known)
        files = {"sync": one.fill(paths.CAMERA_CLOCKS), "people": one.fill(paths.FOUND_PEOPLE)}
        found.append({"take": name, "pose2d": takes.keypoints_2d(one), **files})
    return found


def ties(job: Job) -> str:
    """Return the ties of the structure from motion that a calibration rests on."""
    return job.fill(paths.TIES, **vars(_way(job).variant))


def line_pictures(job: Job) -> list[str]:
    """Return the pictures of the fixed cameras whose court lines a calibration is adjusted with."""
    return each_fixed(job, paths.STATIC) if _way(job).lines else []


def line_search(job: Job) -> dict[str, Any]:
    """Return how lines are searched for, as where court points are proposed."""
    return job.some("propose_court_points", ("search_share", "lines"))


def covariance(job: Job) -> str | list:
    """Return the covariance of cameras where their calibration has one."""
    if job["calibration"] == IMPORTED or not job.session.has_covariance(_way(job)):
        return []
    return file_covariance(job) if _way(job).kind == "file" else job.fill(paths.CAMERA_COVARIANCE)


def file_parts(job: Job) -> list[str]:
    """Return the files that a calibration in several is read from, without the one given."""
    given = Path(job.session.calibration_file or "")
    if given.is_dir() and job.session.calibration_file:
        known = set().union(*TOGETHER)
        found = [*given.glob("*"), *given.glob("*/*.pickle")]
        found = [one for one in found if one.suffix.lower() in OF_FOLDER or one.name in known]
    else:
        names = [name for group in TOGETHER if given.name in group for name in group]
        found = [given.with_name(name) for name in names if name != given.name]
    return sorted(one.as_posix() for one in found if one.is_file())


def base_parts(job: Job) -> list[str]:
    """Return the same of the file that the calibration which people refine was read from."""
    return file_parts(job) if base_file(job) else []


def file_covariance(job: Job) -> str | list:
    """Return the covariance of the cameras in a calibration file, where it is known."""
    return job.session.file_covariance or []


def court_of_file(job: Job) -> Path | list:
    """Return the court over which errors are expected of these cameras, where they are known."""
    return job.court_file() if file_covariance(job) else []


def cameras_of_covariance(job: Job) -> str | list:
    """Return the cameras where their covariance is known."""
    return job.fill(paths.CAMERAS) if covariance(job) else []


def _way(job: Job) -> Calibration:
    return Calibration.parse(job["calibration"])


def boards(job: Job) -> str | list[str]:
    """Return the source of pictures of a chessboard: the simulated folder, or the pictures."""
    if job.session.films_boards():
        return job.fill(paths.VIRTUAL_BOARDS)
    return recordings.inside((job.camera.chessboard or {})["images"])


def lenses(job: Job) -> list[str]:
    """Return the lens of each fixed camera where the calibration needs it."""
    return _lenses(job, job["calibration"])


def _lenses(job: Job, way: str) -> list[str]:
    return job.of_each(paths.LENS, camera=job.session.chessboards_of(way))


def board_files(job: Job) -> list[str]:
    """Return the files that show a board to all cameras: pictures, videos or its corners."""
    given = job.session.board or {}
    sources = [*given.get("images", {}).values(), *filter(None, [given.get("lenses")])]
    found = [path for source in sources for path in _files_of(source)]
    table = [given["corners"]] if "corners" in given else []
    return [*found, *table, *given.get("videos", {}).values()]


def _files_of(source: str) -> list[str]:
    """Return the files of a folder, or the file itself."""
    return [source] if Path(source).is_file() else recordings.inside(source)


def board_lenses(job: Job) -> list[str]:
    """Return the lenses from chessboards of each camera, where boards do not state others."""
    return _lenses(job, "board")


def board_pictures(job: Job) -> list[str]:
    """Return of each camera what tells its pictures' size, where a board has corners alone."""
    given = job.session.board or {}
    return of_full_size(job) if "corners" in given and "lenses" not in given else []


def wand_files(job: Job) -> list[str]:
    """Return the files of a wand: its markers in the pictures, and lenses."""
    given = job.session.wand or {}
    return [given["points"], *(_files_of(given["lenses"]) if "lenses" in given else [])]


def wand_lenses(job: Job) -> list[str]:
    """Return the lenses from chessboards of cameras, if the wand gives no `lenses`."""
    return _lenses(job, "wand")


def wand_pictures(job: Job) -> list[str]:
    """Return a picture or video of each camera for its size, if the wand gives no `lenses`."""
    return [] if "lenses" in (job.session.wand or {}) else of_full_size(job)


def proposals(job: Job) -> str | list:
    """Return proposed court points.

    Of a session whose cameras were found from some clicks, or, by painted lines, without any.
    """
    if job.session.unclicked and job.court_file():
        return job.fill(paths.FOUND_COURT, part="proposals.csv")
    ways = [way for way in job.session.calibrations() if Calibration.parse(way).kind == "sfm"]
    if not (job.session.court_points and ways):
        return []
    return job.fill(paths.COURT_PROPOSALS, calibration=ways[0])


def clicking(job: Job) -> dict[str, Any]:
    """Return the settings of the page for clicking."""
    session = job.session
    path = session.unclicked or session.court_points or job.fill(paths.CLICKS)
    page = {"session": session.name, "names": list(session.cameras)}
    return {**page, "targets": {"court_points.csv": path}}
