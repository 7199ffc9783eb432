"""Changes of any file's bytes: single ones, numbers of 1 to 8 bytes, whole blocks."""

from fuzz import hostile

EDGE_BYTES = 4096  # headers and indices lie at the ends of files


def change_bytes(data, rng):
    """Replace, insert or delete a few bytes."""
    at = place(data, rng)
    kind = rng.randrange(3)
    new = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 5)))
    return data[:at] + (b"" if kind == 0 else new) + data[at + (0 if kind == 1 else len(new)) :]


def flip_bits(data, rng):
    """Flip single bits, one or many."""
    changed = bytearray(data)
    for _ in range(rng.choice([1, 1, 3, 30]) if changed else 0):
        changed[place(data, rng) % len(changed)] ^= 1 << rng.randrange(8)
    return bytes(changed)


def change_integer(data, rng):
    """Write an integer of 1, 2, 4 or 8 bytes over what is there."""
    n_bytes, order = rng.choice([1, 2, 4, 4, 8]), rng.choice(["little", "big"])
    at = place(data, rng)
    at -= at % n_bytes if rng.random() < 0.5 else 0
    new = hostile.integer(rng, n_bytes).to_bytes(n_bytes, order)
    return data[:at] + new + data[at + n_bytes :]


def truncate(data, rng):
    """Cut the end off; now and then the start."""
    at = rng.randrange(len(data) + 1)
    return data[at:] if rng.random() < 0.1 else data[:at]


def repeat(data, rng):
    """Repeat a part."""
    first, second = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    second = min(second, first + 10_000)
    return data[:second] + data[first:second] * rng.choice([1, 2, 300]) + data[second:]


def exchange(data, rng):
    """Exchange two parts."""
    a, b, c = sorted(rng.randrange(len(data) + 1) for _ in range(3))
    return data[:a] + data[b:c] + data[a:b] + data[c:]


def blank(data, rng):
    """Write zeros, or ones, over a part."""
    first = place(data, rng)
    length = min(rng.choice([4, 16, 512, 4096]), len(data) - first)
    return data[:first] + rng.choice([b"\x00", b"\xff"]) * length + data[first + length :]


def nothing(_data, rng):
    """Leave nothing, or noise."""
    return rng.choice([b"", b"\n", b"\x00" * 1000, bytes(rng.randrange(256) for _ in range(500))])


def place(data, rng):
    """Return a place in the data, more often near its ends."""
    edge = min(len(data), EDGE_BYTES)
    return rng.choice(
        (
            rng.randrange(len(data) + 1),
            rng.randrange(edge + 1),
            rng.randrange(min(edge, 64) + 1),
            len(data) - rng.randrange(edge + 1),
        )
    )


WAYS = (change_bytes, flip_bits, change_integer, change_integer, truncate, repeat, exchange, blank)
