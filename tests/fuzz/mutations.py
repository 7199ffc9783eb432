"""One change or a few of a file, by what it is: chosen by a seeded generator, always the same."""

from fuzz import binaries, containers, texts, trees

STRUCTURE = {
    ".json": trees.change_json,
    ".yaml": trees.change_yaml,
    ".toml": trees.change_toml,
    ".npz": containers.change_zip,
    ".whl": containers.change_zip,
    ".tgz": containers.change_tar,
    ".png": containers.change_png,
    ".jpg": containers.change_jpeg,
    ".mp4": containers.change_boxes,
    ".db3": containers.change_sqlite,
    ".db": containers.change_sqlite,
}
SEALED = {
    ".npz",
    ".whl",
    ".tgz",
    ".png",
    ".db3",
    ".db",
}  # a changed byte is told by a checksum, or means nothing
TEXTS = {".json", ".yaml", ".yml", ".toml", ".txt", ".xml", ".bvh", ".trc", ".csv"}
LARGEST_BYTES = 1 << 24  # no test of patience: large files are another matter


def mutate(data, suffix, rng):
    """Return the bytes of a file, changed.

    Parameters
    ----------
    data : bytes
    suffix : str
        Of its name: says what the file is.
    rng : random.Random
    """
    if rng.random() < 0.01:
        return binaries.nothing(data, rng)
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        data = rng.choice(ways(suffix, rng))(data, rng)[:LARGEST_BYTES]
    return data


def ways(suffix, rng):
    """Return the kind of changes that are tried next."""
    if suffix in STRUCTURE and rng.random() < (0.8 if suffix in SEALED else 0.5):
        return (STRUCTURE[suffix],)
    if suffix in TEXTS and rng.random() < 0.8:
        return texts.WAYS
    return binaries.WAYS
