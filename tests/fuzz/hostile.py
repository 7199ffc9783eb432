"""What people and faults put where a number, a name or a file is expected."""

NUMBERS = (
    "nan", "NaN", "inf", "-inf", "Infinity", "1e999", "1e308", "-1e308", "1e-320", "-0", "0", "-1",
    "1", "255", "65536", "2147483648", "-2147483649", "9223372036854775808", "18446744073709551616",
    "9" * 40, "9" * 400, "9" * 5000, "0x" + "f" * 6000, "0x1F", "1_000", "٣", "", "1,5", "1.2.3",
    "--1", "true", "null", "1:30:00", "2026-02-30", "1e", "+", ".", "½",
)  # fmt: skip
NAMES = (
    "", " ", ".", "..", "../x", "../../x", "/etc/x", "a/b", "a b", "$(x)", "`x`", "-rf", "a;b",
    "con", "a\nb", "a\tb", "a\u2028b", "a\x00b", "a\x1b[2Jb", "x" * 300, "x" * 100_000, "{x}",
    "{0.__class__}", "%s%n", "'", '"', "\\", "~", "*", "сам", "ﬁ", "camera\u200b", "A", "é",
    "\U0001f3f8", "\ud800",
)  # fmt: skip
BVH = (
    "HIERARCHY", "ROOT a", "JOINT b {", "End Site", "End Site { OFFSET 0 0 0 }", "OFFSET",
    "CHANNELS 0", "CHANNELS 3", "Zrotation", "Wrotation", "MOTION", "Frames: 1000000", "Frames: -1",
    "Frame Time: 0", "Frame Time: -1", "Frame Time: nan",
)  # fmt: skip
SIGNS = ("{", "}", "[", "]", "<", ">", "#", "&", ",", "\t", "\r", "=", ":", "---", "\x1c")
WORDS = (*NUMBERS, *NAMES[:20], *SIGNS, *BVH)


def value(rng):
    """Return a value for a tree of JSON, YAML or TOML."""
    return rng.choice(
        (
            None, True, False, 0, -1, 1, 2**31, 2**63, 2**64, 10**400, 0.5, 1e308, -1e308, 1e-320,
            float("nan"), float("inf"), float("-inf"), "", [], {}, [[]], [None], {"": None},
            [[1], [2, 3]], ["x"] * 2000, list(range(3000)), deep(60), deep(400), deep(2000),
            {"a": deep(30)}, dict.fromkeys(NAMES[:12], 1), rng.choice(NAMES), rng.choice(NAMES),
            rng.choice(NUMBERS),
        )
    )  # fmt: skip


def deep(levels):
    """Return lists within lists."""
    made = []
    for _ in range(levels):
        made = [made]
    return made


def integer(rng, n_bytes):
    """Return an integer that counts, lengths and offsets of so many bytes stumble over."""
    bits = 8 * n_bytes
    edges = [0, 1, 2, 3, 7, 8, 255, 1 << (bits - 1), (1 << (bits - 1)) - 1, (1 << bits) - 1]
    edges += [(1 << bits) - 2, (1 << bits) - 8, 1 << (bits // 2), rng.randrange(1 << bits)]
    edges += [rng.randrange(1 << min(bits, 16)), 1 << rng.randrange(bits)]
    return rng.choice(edges) % (1 << bits)
