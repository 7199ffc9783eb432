"""Faults of a take beyond its schema: recordings, devices, simulation, imported keypoints."""

from collections.abc import Collection, Iterable, Iterator
from itertools import product
from pathlib import Path

from courtside.study.configuration.session_files import KINDS, kind_of
from courtside.study.configuration.sessions import SUITS
from courtside.study.configuration.yaml_files import Content
from courtside.study.errors import nearest
from courtside.study.methods import STAGE_WORDS

MEANT_FOR = {"unit": ("inertial", "nuitrack"), "angles": ("inertial",)}  # keys of devices
OWN_SOURCES = {"rgbd": ("depth", "rgb"), "rgb": ("rgb",), "inertial": ("corrected",)}  # endings
OF_VIRTUAL_SUITS = ("strength",)  # keys of virtual devices; the others are of depth cameras
RECORDINGS = ("videos", "pose2d", "devices")  # keys of a take that was recorded


def imported(content: Content) -> list[str]:
    """Return the skeletons of keypoints that takes of a session import, each once, in order."""
    takes = content.get("takes", {}).values()
    names = [name for take in takes for key in ("pose2d", "pose3d") for name in take.get(key, {})]
    return list(dict.fromkeys(names))


def of_other_programs(folder: Path, file: Path, content: Content) -> Iterator[str]:
    """Check imported keypoints: known skeletons, cameras, persons, in every take that needs them.

    `folder` is config/, `file` the session's, `content` as its schema allows it.
    """
    there = sorted(path.stem for path in (folder / "skeletons").glob("*.yaml"))
    wanted = set(content.get("override", {}).get("models", []))
    for name, take in content.get("takes", {}).items():
        subjects = take.get("subjects", content.get("subjects", {}))
        filmed = take.get("videos", content["cameras"])
        for key, known in (("pose2d", filmed), ("pose3d", subjects)):
            where = f"{file}: takes.{name}.{key}"
            strange = unknown(where, take.get(key, {}), there)
            for skeleton, files in take.get(key, {}).items():
                strange += unknown(f"{where}.{skeleton}", files, known)
            checked = _without_a_folder if key == "pose2d" else _twice
            yield from strange or checked(where, take)
        if "pose2d" in take and "videos" not in take:
            yield from _unfilmed(f"{file}: takes.{name}", take, content)
        missing = wanted & set(imported(content)) - set(take.get("pose2d", {}))
        for skeleton in sorted(missing if take.get("videos") else ()):
            yield (
                f"{file}: takes.{name}.pose2d: expected {skeleton}, as override.models says, found "
                "none; name its folders"
            )


def cameras_of(take: Content) -> list[str]:
    """Return the fixed cameras that see a recorded take, as `sessions.Take.cameras`."""
    seen = [take["videos"]] if "videos" in take else take.get("pose2d", {}).values()
    return list(dict.fromkeys(name for own in seen for name in own))


def _without_a_folder(where: str, take: Content) -> Iterator[str]:
    """Yield the cameras of a take of which a skeleton names no folder."""
    for skeleton, folders in take.get("pose2d", {}).items():
        missing = [name for name in cameras_of(take) if name not in folders]
        if missing:
            yield (
                f"{where}.{skeleton}: expected a folder of each camera of the take, found none of "
                f"{', '.join(missing)}; name it, or remove the camera from the take"
            )


def _twice(where: str, take: Content) -> Iterator[str]:
    """Yield the files of skeletons that are given for two persons."""
    for skeleton, files in take.get("pose3d", {}).items():
        paths = [*files.values()]
        for path in sorted({path for path in paths if paths.count(path) > 1}):
            yield (
                f"{where}.{skeleton}: expected a file of each person, found {path} twice; correct "
                "one path"
            )


def _unfilmed(where: str, take: Content, content: Content) -> Iterator[str]:
    """Yield what a take of keypoints without videos lacks, or has for nothing."""
    if "rate_hz" not in take:
        yield (
            f"{where}.rate_hz: expected the frame rate of the keypoints, which their files do not "
            "state, found none; add the rate of the videos that they were made from, or `videos`"
        )
    if "calibration" not in content:
        yield (
            f"{where}: expected `calibration` in a session with keypoints and no videos, found "
            "none; its file says how large the pictures were"
        )
    if len(cameras_of(take)) < 2:
        yield f"{where}.pose2d: expected two cameras or more, found {len(cameras_of(take))}"
    if take.get("steady"):
        yield (
            f"{where}.steady: expected videos, in which shake is measured, found keypoints only; "
            "remove it: a calibration ending in -people finds knocks without videos"
        )
    wanted, there = content.get("override", {}).get("models", []), [*take["pose2d"]]
    if not wanted or set(wanted) - set(there):
        yield (
            f"{where}: expected skeletons of its pose2d alone in override.models, for without "
            f"videos no network can look, found {wanted or 'none'}; write `override: {{models: "
            f"[{', '.join(there)}]}}`"
        )


def evaluated(
    config_file: str, step: Content, models: Content, found: dict[str, tuple]
) -> Iterator[str]:
    """Yield the faults of `evaluate_networks`; `found` has (file, content) of each session.

    Takes that the study does not have are left out, as everywhere.
    """
    where = f"{config_file}: evaluate_networks"
    for key in ("networks", "skeletons"):
        yield from unknown(f"{where}.{key}", step[key], models)
    for name, against in step["takes"].items():
        session, _, take = name.partition("/")
        _, content = found.get(session, (None, {}))
        if take not in content.get("takes", {}):
            continue
        named = content["takes"][take]
        there = sorted(named.get("pose2d", {}))
        if "virtual" in content and against is not None:
            yield f"{where}.takes.{name}: expected null, for it has a truth, found {against!r}"
        elif "virtual" not in content and against not in there:
            yield (
                f"{where}.takes.{name}: expected one of the imported keypoints {there} of that "
                f"take to compare with, found {against!r}; name one, or import some (`pose2d`)"
            )
        elif "virtual" not in content and "videos" not in named:
            yield (
                f"{where}.takes.{name}: expected a take with videos, in which networks look, found "
                "keypoints only; remove it"
            )


def find(
    where: str, take: Content, cameras: Content, subjects: Content, virtual: bool
) -> Iterator[str]:
    """Yield what in a take contradicts itself or its session; `where` names file and take."""
    yield from _kind_faults(where, take, virtual)
    if not subjects:
        yield (
            f"{where}: expected `subjects` in the session, found none; name the persons of the take"
        )
        return
    there = take.get("subjects", subjects)
    yield from unknown(f"{where}.videos", take.get("videos", {}), cameras)
    yield from unknown(f"{where}.subjects", there, subjects)
    yield from _device_faults(where, take, cameras, there)
    yield from _clock_faults(where, take, cameras, virtual)
    yield from _virtual_faults(where, take.get("virtual"), cameras, there)
    if take.get("steady") and not virtual:
        for name in (n for n in take.get("videos", {}) if "static" not in cameras.get(n, {})):
            yield (
                f"{where}.steady: expected `static` of camera {name}, against which shake is "
                "measured, found none; name a recording of the empty court"
            )
    if "rate_hz" in take and ("videos" in take or "pose2d" not in take):
        yield (
            f"{where}.rate_hz: expected it of a take with keypoints and no videos only, found it; "
            "remove it"
        )
    start_s, stop_s = take.get("trim_s", (0, 1))
    if start_s >= stop_s:
        yield f"{where}.trim_s: expected a start before the stop, found [{start_s}, {stop_s}]"


def _clock_faults(where: str, take: Content, cameras: Content, virtual: bool) -> Iterator[str]:
    """Check the clocks that a take states."""
    made = take.get("virtual", {}).get("devices", {})
    recorded = [*(cameras if virtual else cameras_of(take)), *take.get("devices", {}), *made]
    yield from unknown(f"{where}.clocks", take.get("clocks", {}), recorded)
    timed = [name for name in take.get("clocks", {}) if name in cameras]
    if take.get("synchronised") and timed:
        yield (
            f"{where}.clocks: expected none of cameras that share a clock, as `synchronised: true` "
            f"of the take or the session says, found {', '.join(timed)}; remove these, or say "
            "`synchronised: false` in the take"
        )
    first = _reference(take)
    if any(take.get("clocks", {}).get(first, {}).get(key, 0) for key in ("offset_s", "drift_ppm")):
        yield (
            f"{where}.clocks.{first}: expected no offset or drift of the first "
            f"{'camera' if cameras_of(take) else 'device'}, whose clock is the reference, found "
            "one; state the other clocks against it"
        )


def _reference(take: Content) -> str | None:
    """Return whose clock is the reference of a recorded take: the first camera's.

    Of devices alone, the first that is no suit, else the first: the order of `jobs.devices.sources`
    """
    devices = take.get("devices", {})
    ranked = sorted(devices, key=lambda name: _kind(devices[name]) in SUITS)
    return next(iter([*cameras_of(take), *ranked]), None)


def _kind(device: Content) -> str:
    """Return the kind of a device by the ending of its file; empty without a file."""
    return kind_of(device["file"]) if "file" in device else ""


def _kind_faults(where: str, take: Content, virtual: bool) -> Iterator[str]:
    """Check that a take is virtual in a virtual session, and recorded in a recorded one."""
    if virtual and ("virtual" not in take or set(RECORDINGS) & set(take)):
        yield (
            f"{where}: expected the key 'virtual' and not 'videos' in a virtual session, found "
            f"{sorted(take)}; correct the take"
        )
    if not virtual and ("virtual" in take or not set(RECORDINGS) & set(take)):
        yield (
            f"{where}: expected the key 'videos', 'pose2d' or 'devices' and not 'virtual' in a "
            f"recorded session, found {sorted(take)}; correct the take"
        )


def _device_faults(
    where: str, take: Content, cameras: Content, subjects: Collection[str]
) -> Iterator[str]:
    """Check the devices of a take, recorded or virtual."""
    made = take.get("virtual", {})
    devices = {**take.get("devices", {}), **made.get("devices", {})}
    first = next(iter(made.get("players", subjects)))
    worn = {device.get("subject", first) for device in devices.values()}
    if len(worn) > 1:
        yield (
            f"{where}.devices: expected one subject for all, found {sorted(worn)}; make a take "
            "for each"
        )
    files = [device["file"] for device in devices.values() if "file" in device]
    for path in sorted({path for path in files if files.count(path) > 1}):
        yield (
            f"{where}.devices: expected a recording of each device, found {path} twice; correct one"
        )
    for name, device in devices.items():
        named = [device["subject"]] if "subject" in device else []
        yield from unknown(f"{where}.devices.{name}.subject", named, subjects)
        kind = _kind(device)
        for key in (key for key in MEANT_FOR if key in device):
            if kind not in MEANT_FOR[key]:
                endings = [end for end, of in KINDS.items() if of in MEANT_FOR[key]]
                yield (
                    f"{where}.devices.{name}.{key}: expected it of a file {', '.join(endings)} "
                    f"only, found {device['file']}; remove it"
                )
    yield from _device_names(where, devices, cameras)


def _device_names(where: str, devices: Content, cameras: Content) -> Iterator[str]:
    """Yield the devices whose names mean something else."""
    sources = {
        f"{name}-{ending}"
        for name, device in devices.items()
        for ending in OWN_SOURCES.get(device.get("kind") or _kind(device), ())
    }
    taken = {"camera": {*cameras, "cameras"}, "stage of skeletons": {*STAGE_WORDS.values()}}
    taken["source of another device"] = sources
    for name, (what, names) in product(devices, taken.items()):
        if name in names:
            yield f"{where}.devices: expected names that no {what} has, found {name!r}; rename it"


def _virtual_faults(
    where: str, made: Content | None, cameras: Content, subjects: Collection[str]
) -> Iterator[str]:
    """Check what a take of a virtual session is made from."""
    if not made:
        return
    clocks = [*cameras, *made.get("devices", {})]
    yield from unknown(f"{where}.virtual.cameras", made.get("cameras", []), cameras)
    yield from unknown(f"{where}.virtual.clocks", made.get("clocks", {}), clocks)
    yield from unknown(f"{where}.virtual.shake", made.get("shake", {}), cameras)
    yield from _simulated_faults(f"{where}.virtual", made)
    if set(made["players"]) != set(subjects):
        yield (
            f"{where}.virtual.players: expected each of {sorted(subjects)}, found "
            f"{sorted(made['players'])}; correct one of them"
        )


def _simulated_faults(where: str, made: Content) -> Iterator[str]:
    """Check keys of virtual devices and shakes that do not fit each other."""
    for name, device in made.get("devices", {}).items():
        for key in sorted(set(device) - {"kind", "subject", "rate_hz"}):
            kind = "inertial" if key in OF_VIRTUAL_SUITS else "rgbd"
            if device["kind"] != kind:
                yield (
                    f"{where}.devices.{name}.{key}: expected it of a device of the kind {kind} "
                    f"only, found {device['kind']}; remove it"
                )
    for name, shake in made.get("shake", {}).items():
        if ("knock_s" in shake) != (shake.get("knock_deg", 0) > 0):
            yield (
                f"{where}.shake.{name}: expected knock_s with a knock_deg above 0, or neither, "
                f"found {shake}; state both"
            )


def unknown(where: str, names: Iterable[str], known: Collection[str]) -> list[str]:
    """Return a fault for each name that is not known, with the nearest one where one is near."""
    strange = [(name, nearest(name, list(known), "")) for name in names if name not in known]
    return [
        f"{where}: expected one of {sorted(known)}, found {name!r}" + f"; {advice}" * bool(advice)
        for name, advice in strange
    ]
