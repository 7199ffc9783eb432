"""Input functions and parameters of rules about devices of their own: mocopi, depth cameras, single videos.

Inputs: the checked configuration. Outputs: none. Steps: which files, sources and clocks belong to a job.
"""

OF_KIND = {"inertial": "mocopi27", "nuitrack": "nuitrack19"}  # skeletons that a device brings along


def stated_clocks(wildcards, names):
    """Return those clocks that a take states, of the cameras or devices named."""
    return {name: clock for name, clock in take_of(wildcards).clocks.items() if name in names}


def device_of(wildcards):
    """Return the `Device` that a job belongs to."""
    return take_of(wildcards).devices[wildcards.device]


def device_skeleton(wildcards):
    """Return the path of the skeleton of an imported device."""
    return CONFIG / "skeletons" / f"{OF_KIND[device_of(wildcards).kind]}.yaml"


def colour_file(wildcards, suffix):
    """Return a file of the extracted colour pictures of a depth camera; nothing for a plain video."""
    if device_of(wildcards).kind != "rgbd":
        return []
    return f"results/{wildcards.session}/takes/{wildcards.take}/devices/{wildcards.device}.{suffix}"


def fused_file(wildcards):
    """Return the skeletons of the fixed cameras that other sources of a take are compared with."""
    session = session_of(wildcards)
    stage = stages_of(wildcards.model)[-1]
    way = f"{session.take_calibrations()[0]}/{session.fusions()[0]}/{wildcards.model}"
    return f"results/{wildcards.session}/takes/{wildcards.take}/{stage}/{way}.npz"


def sources_of(wildcards, corrected=True):
    """Return {source: (file, skeleton, device)} of a take, the one whose clock is the reference first."""
    session, take = session_of(wildcards), take_of(wildcards)
    folder = f"results/{session.name}/takes/{take.name}/devices"
    of_network = skeleton_file(wildcards).stem
    found = {}
    if take.videos and session.take_calibrations():
        found["cameras"] = (f"{folder}/cameras.{wildcards.model}.npz", of_network, "cameras")
    for name, device in sorted(take.devices.items(), key=lambda pair: pair[1].kind == "inertial"):
        brought = OF_KIND.get(device.kind)
        for source in device.sources(name):
            suffix = "" if brought else f".{wildcards.model}"
            found[source] = (f"{folder}/{source}{suffix}.npz", brought or of_network, name)
    if corrected:
        for name in correctable(wildcards):
            source = f"{name}-corrected"
            found[source] = (f"{folder}/{source}.{wildcards.model}.npz", "mocopi27", name)
    return found


def source_files(wildcards, corrected=True):
    """Return the files of all sources of a take."""
    return [path for path, _, _ in sources_of(wildcards, corrected).values()]


def body_files_of(wildcards, kind="npz", corrected=True):
    """Return the aligned skeletons of all sources of a take, or as `json` their body frames."""
    folder = f"results/{wildcards.session}/takes/{wildcards.take}/body"
    sources = sources_of(wildcards, corrected)
    return [f"{folder}/{source}.{wildcards.model}.{kind}" for source in sources]


def worn_by(wildcards):
    """Return the person whom the devices of a take follow."""
    return next(iter(take_of(wildcards).devices.values())).subject


def clock_owners(wildcards, corrected=True):
    """Return for each source of a take the device whose clock it has."""
    return {source: device for source, (_, _, device) in sources_of(wildcards, corrected).items()}


def clock_source(wildcards):
    """Return a source whose clock was found and is that of this job's source: itself, or of the same device."""
    owner = clock_owners(wildcards)[wildcards.source]
    found = clock_owners(wildcards, corrected=False)
    return next(source for source, device in found.items() if device == owner)


def vision_of(wildcards):
    """Return the source that corrects inertial ones: all cameras, else a depth camera; None without either."""
    found = list(sources_of(wildcards, corrected=False))
    ranked = [
        source for ending in ("cameras", "-depth") for source in found if source.endswith(ending)
    ]
    return ranked[0] if ranked else None


def correctable(wildcards):
    """Return the inertial devices of a take that vision can correct."""
    devices = take_of(wildcards).devices
    if vision_of(wildcards) is None:
        return []
    return [name for name, device in devices.items() if device.kind == "inertial"]


def correction_parameters(wildcards):
    """Return how an inertial device is corrected."""
    vision, sigmas = vision_of(wildcards), step("correct_inertial")(wildcards)["sigma_m"]
    sigma_m = sigmas[vision.rpartition("-")[2]]
    return {"device": wildcards.device, "vision_device": vision, "sigma_m": sigma_m}
