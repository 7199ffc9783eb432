"""BVH files changed at random: each gives a motion or one clear line, soon."""

import random
import signal
import time
import warnings

import numpy as np
import pytest
from bvh_texts import ARM

from courtside.devices import bvh
from courtside.records.hierarchy import forward
from courtside.study.errors import InputError
from real_data import REAL

LIMIT_S = 2.0
WORDS = [
    *(
        "nan",
        "inf",
        "-inf",
        "1e999",
        "-1e308",
        "1e-320",
        "-0",
        "",
        "x",
        "0x1F",
        "1_000",
        "٣",
        "9" * 400,
    ),
    *(
        "{",
        "}",
        "HIERARCHY",
        "ROOT a",
        "JOINT b {",
        "End Site",
        "End Site { OFFSET 0 0 0 }",
        "OFFSET",
    ),
    *(
        "CHANNELS 0",
        "CHANNELS 3",
        "Zrotation",
        "Wrotation",
        "MOTION",
        "Frames: 1000000",
        "Frames: -1",
    ),
    *(
        "Frame Time: 0",
        "Frame Time: -1",
        "Frame Time: nan",
        "#",
        "\x00",
        "\x1c",
        "\u2028",
        "\r",
        "\t",
    ),
]


def sources():
    """Return texts to start from: a made one, and short forms of real ones where they are."""
    texts = [ARM]
    for path in sorted(REAL.glob("mocopi/**/*.bvh")) + sorted(REAL.glob("bvh-walk01/*.bvh")):
        text = path.read_text()
        if len(text) > 10_000:  # keep three rows
            head, _, rows = text.partition("MOTION\n")
            count, period, *rows = rows.splitlines()
            text = (
                f"{head}MOTION\n{count.split(':')[0]}: 3\n{period}\n" + "\n".join(rows[:3]) + "\n"
            )
        texts += [text] if "malformed" in path.name else [text] * 3
    return [text.encode() for text in texts]


def change_bytes(data, rng):
    at = rng.randrange(len(data) + 1)
    kind = rng.randrange(3)
    new = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 5)))
    return data[:at] + (b"" if kind == 0 else new) + data[at + (0 if kind == 1 else len(new)) :]


def change_words(data, rng):
    words = data.split(b" ")
    words[rng.randrange(len(words))] = rng.choice(WORDS).encode()
    return b" ".join(words)


def change_numbers(data, rng):
    text = data.decode("utf-8", "replace")
    digits = [at for at, letter in enumerate(text) if letter.isdigit()]
    if not digits:
        return data
    at = rng.choice(digits)
    new = rng.choice([*"0123456789", "-", ".", "e9", "99", "", "e", "0" * 50, "e400"])
    return (text[:at] + new + text[at + 1 :]).encode()


def change_case(data, rng):
    first, second = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:first] + data[first:second].swapcase() + data[second:]


def change_blanks(data, rng):
    blank = rng.choice([b" ", b"\t", b"\n", b"\r\n", b"  "])
    return blank.join(data.split(b" ", rng.randrange(20))).replace(b"\n", b"\n" + blank, 3)


def change_lines(data, rng):
    lines = data.split(b"\n")
    first, second = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.randrange(4)
    if kind == 0:
        del lines[first]
    elif kind == 1:
        lines.insert(second, lines[first])
    elif kind == 2:
        lines[first], lines[second] = lines[second], lines[first]
    else:
        lines.insert(first, rng.choice(WORDS).encode())
    return b"\n".join(lines)


def truncate(data, rng):
    return data[: rng.randrange(len(data) + 1)]


def repeat(data, rng):
    first, second = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:second] + data[first:second] * rng.choice([1, 2, 300]) + data[second:]


def mutate(data, rng):
    ways = [change_bytes, change_words, change_numbers, change_case, change_blanks, change_lines]
    ways += [truncate, repeat]
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        data = rng.choice(ways)(data, rng)
    return data


def stop(_signal, _frame):
    raise TimeoutError(f"still reading after {LIMIT_S} s")


def outcome(path):
    """Return "value" or "refused"; let everything else through."""
    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, LIMIT_S)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            posed = bvh.read(path)
            xyz, world = forward(posed)
    except InputError as error:
        assert str(error).startswith(f"{path}: ")
        assert str(error).splitlines() == [str(error)]
        assert len(str(error)) < 600
        return "refused"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert np.isfinite(xyz).all()
    assert np.isfinite(posed.time_s).all()
    turned = world @ np.swapaxes(world, -1, -2)
    assert np.allclose(turned, np.eye(3), atol=1e-6)
    return "value"


def run(tmp_path, count, seed):
    texts, path = sources(), tmp_path / "mutated.bvh"
    found, slowest_s = {"value": 0, "refused": 0}, 0.0
    for number in range(count):
        rng = random.Random(seed * 1_000_000 + number)
        path.write_bytes(mutate(rng.choice(texts), rng))
        started = time.perf_counter()
        try:
            found[outcome(path)] += 1
        except Exception as error:
            raise AssertionError(f"mutation {number} of seed {seed}: {error!r}") from error
        slowest_s = max(slowest_s, time.perf_counter() - started)
    print(f"{count} mutations: {found}, slowest {slowest_s:.3f} s")
    return found, slowest_s


def test_some_mutations_give_a_motion_or_a_line(tmp_path):
    found, slowest_s = run(tmp_path, 300, seed=1)
    assert min(found.values()) > 20  # both ends are reached
    assert slowest_s < LIMIT_S


@pytest.mark.fuzz
def test_ten_thousand_mutations_give_a_motion_or_a_line(tmp_path):
    found, slowest_s = run(tmp_path, 10_000, seed=2)
    assert sum(found.values()) == 10_000
    assert slowest_s < LIMIT_S
