"""Changes of text files, line by line, word by word, number by number, and of their encoding."""

import re

from fuzz import hostile

NUMBER = re.compile(rb"[-+]?[0-9]+(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?")
WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9]*")
SPLITS = (b" ", b",", b"\t", b"=", b":", b'"')
ENCODINGS = ("utf-8-sig", "utf-16", "utf-16-le", "utf-32", "latin-1", "cp1252", "utf-7")


def change_numbers(data, rng):
    """Put something else where a number is."""
    found = list(NUMBER.finditer(data))
    if not found:
        return data
    at = rng.choice(found)
    return data[: at.start()] + encoded(rng.choice(hostile.NUMBERS)) + data[at.end() :]


def change_digits(data, rng):
    """Change one digit, or put something beside it."""
    found = [at for at, letter in enumerate(data) if 48 <= letter <= 57]
    if not found:
        return data
    at = rng.choice(found)
    new = rng.choice([*"0123456789", "-", ".", "e9", "99", "", "e", "0" * 50, "e400"])
    return data[:at] + new.encode() + data[at + 1 :]


def change_names(data, rng):
    """Rename a word, exchange two, or put a hostile name there."""
    found = list(WORD.finditer(data))
    if not found:
        return data
    at, other = rng.choice(found), rng.choice(found)
    word = at.group()
    new = rng.choice([word.swapcase(), word[:-1], word + b"x", other.group(), b"", None])
    new = encoded(rng.choice(hostile.NAMES)) if new is None else new
    return data[: at.start()] + new + data[at.end() :]


def change_cells(data, rng):
    """Put something else between two separators."""
    split = rng.choice(SPLITS)
    cells = data.split(split)
    cells[rng.randrange(len(cells))] = encoded(rng.choice(hostile.WORDS))
    return split.join(cells)


def change_case(data, rng):
    """Exchange capital and small letters in a part."""
    first, second = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:first] + data[first:second].swapcase() + data[second:]


def change_blanks(data, rng):
    """Put other blanks in."""
    blank = rng.choice([b" ", b"\t", b"\n", b"\r\n", b"  ", b"\x0b", b"\xc2\xa0"])
    return blank.join(data.split(b" ", rng.randrange(20))).replace(b"\n", b"\n" + blank, 3)


def change_lines(data, rng):
    """Delete, repeat, exchange or insert lines."""
    lines = data.split(b"\n")
    first, second = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.randrange(5)
    if kind == 0:
        del lines[first]
    elif kind == 1:
        lines.insert(second, lines[first])
    elif kind == 2:
        lines[first], lines[second] = lines[second], lines[first]
    elif kind == 3:
        lines.insert(first, encoded(rng.choice(hostile.WORDS)))
    else:
        rng.shuffle(lines)
    return b"\n".join(lines)


def change_encoding(data, rng):
    """Write the text in another encoding, or with other ends of lines."""
    kind = rng.randrange(3)
    if kind == 0:
        return data.replace(b"\n", rng.choice([b"\r\n", b"\r", b"\n\n", b"\x0b", b"\xe2\x80\xa8"]))
    text = data.decode("utf-8", "replace")
    if kind == 1:
        text = text.replace("a", "é")
    return text.encode(rng.choice(ENCODINGS), "replace")


def encoded(text):
    """Return a text's bytes, half characters too."""
    return text.encode("utf-8", "surrogatepass")


WAYS = (change_numbers, change_numbers, change_digits, change_names, change_names, change_cells)
WAYS += (
    change_digits,
    change_digits,
    change_case,
    change_blanks,
    change_lines,
    change_lines,
    change_encoding,
)
