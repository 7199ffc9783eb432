"""Changes of files made of parts, lengths and checksums kept right.

The formats are zip, tar with gzip, npz, PNG, JPEG, MP4 and SQLite.
"""

import gzip
import io
import pickle
import sqlite3
import struct
import tarfile
import tempfile
import warnings
import zipfile
import zlib
from pathlib import Path

from courtside.study.errors import DAMAGED
from fuzz import binaries, hostile, texts

BOXES = {b"moov", b"trak", b"mdia", b"minf", b"stbl", b"edts", b"dinf", b"udta"}
DTYPES = ("|O", "<f8", ">f8", "<f4", "<i8", "|b1", "<U1000000", "|S0", "<M8[ns]", "<c16", "V8")
SHAPES = (
    "()",
    "(0,)",
    "(-1,)",
    "(10000000000,)",
    "(3, 99999999, 9999999)",
    "(2, 3)",
    "[3]",
    "(1.5,)",
)


class Escape:
    """What unpickling must never meet: it writes a file outside."""

    def __reduce__(self):
        """Say how to make it."""
        return Path.write_text, (Path("../escaped"), "x")


def change_zip(data, rng):
    """Rewrite a zip file with a member changed, renamed, added, missing or twice."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = [(info.filename, archive.read(info)) for info in archive.infolist()]
    except DAMAGED:  # by an earlier change
        return data
    at = rng.randrange(len(members)) if members else 0
    ways = (_content, _content, _content, _renamed, _missing, _twice, _bomb, _method, _lying)
    return rng.choice(ways)(members, at, rng) if members else data


def _packed(members, compression=zipfile.ZIP_DEFLATED):
    made = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(made, "w") as archive:
        warnings.simplefilter("ignore")  # of two members of one name
        for name, content in members:
            info = name if isinstance(name, zipfile.ZipInfo) else zipfile.ZipInfo(name)
            archive.writestr(info, content, compress_type=compression)
    return made.getvalue()


def _content(members, at, rng):
    name, content = members[at]
    way = rng.choice(binaries.WAYS)
    content = change_npy(content, rng) if name.endswith(".npy") else way(content, rng)
    return _packed([*members[:at], (name, content), *members[at + 1 :]])


def _renamed(members, at, rng):
    name = rng.choice([*hostile.NAMES[:-1], members[at][0].upper(), rng.choice(members)[0]])
    info = zipfile.ZipInfo(name[:60_000])
    if rng.random() < 0.3:  # a symbolic link to somewhere else
        info.external_attr = 0o120777 << 16
        return _packed([*members[:at], (info, b"../../outside"), *members[at:]])
    return _packed([*members[:at], (info, members[at][1]), *members[at + 1 :]])


def _missing(members, at, _rng):
    return _packed([*members[:at], *members[at + 1 :]])


def _twice(members, at, rng):
    again = binaries.flip_bits(members[at][1], rng)
    return _packed([*members, (members[at][0], again)])


def _bomb(members, at, rng):
    name, content = members[at]
    size = rng.choice([*[1 << 20] * 20, *[1 << 24] * 9, 1 << 28])  # the last takes a second to pack
    return _packed([*members[:at], (name, content + bytes(size)), *members[at + 1 :]])


def _method(members, _at, rng):
    kind = rng.choice([zipfile.ZIP_STORED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
    return _packed(members, compression=kind)


def _lying(members, _at, rng):
    """State other sizes, flags or places in the central directory."""
    data = bytearray(_packed(members))
    found = data.find(b"PK\x01\x02")
    at = found + rng.choice([8, 10, 16, 20, 24, 28, 30, 38, 42])
    n_bytes = rng.choice([2, 4])
    data[at : at + n_bytes] = hostile.integer(rng, n_bytes).to_bytes(n_bytes, "little")
    return bytes(data)


TAR_LINKS = ("/etc/hostname", "../../outside", "package", "\x00", "thing/a.txt")
TAR_KINDS = (
    tarfile.SYMTYPE,
    tarfile.LNKTYPE,
    tarfile.DIRTYPE,
    tarfile.FIFOTYPE,
    tarfile.CHRTYPE,
    tarfile.GNUTYPE_SPARSE,
    tarfile.XHDTYPE,
)

TAR_SIZES = (b"77777777777", b"-0000000001", b"\x80" + b"\xff" * 10, b"00000000001")


def change_tar(data, rng):
    """Rewrite a tar file with a member changed, renamed, a link, missing, twice, of false size."""
    try:
        with tarfile.open(fileobj=io.BytesIO(data), mode="r:gz") as archive:
            members = [(m, archive.extractfile(m).read()) for m in archive if m.isfile()]
    except (*DAMAGED, AttributeError):  # by an earlier change
        return data
    if not members:
        return data
    at = rng.randrange(len(members))
    if rng.random() < 0.3:
        raw = _tar_header(members, rng)
    else:
        raw = _tarred(_tar_member(members, at, rng))
    packed = gzip.compress(raw, compresslevel=1, mtime=0)
    return packed[: rng.randrange(len(packed))] if rng.random() < 0.1 else packed


def _tar_member(members, at, rng):
    """Return the members with one changed, missing or twice."""
    info, content = members[at]
    way = rng.randrange(6)
    if way == 0:
        info.name = rng.choice([*hostile.NAMES[:-1], info.name.upper(), members[0][0].name])[:9000]
    elif way == 1:
        info.type, info.linkname, content = rng.choice(TAR_KINDS), rng.choice(TAR_LINKS), b""
    elif way == 2:
        return [*members[:at], *members[at + 1 :]]
    elif way == 3:
        return [*members, (info, binaries.flip_bits(content, rng))]
    elif way == 4:
        content += bytes(rng.choice([*[1 << 20] * 9, 1 << 25]))
    else:
        content = rng.choice(binaries.WAYS)(content, rng)
    return [*members[:at], (info, content), *members[at + 1 :]]


def _tar_header(members, rng):
    """State another size in a header, its checksum made right."""
    raw = bytearray(_tarred(members))
    start = 512 * rng.randrange(len(raw) // 512)
    raw[start + 124 : start + 135] = rng.choice(TAR_SIZES)
    total = sum(raw[start : start + 148]) + 8 * 32 + sum(raw[start + 156 : start + 512])
    raw[start + 148 : start + 156] = b"%06o\0 " % total
    return raw


def _tarred(members):
    made = io.BytesIO()
    with tarfile.open(fileobj=made, mode="w") as archive:
        for info, content in members:
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return made.getvalue()


def change_npy(data, rng):
    """Change the header of an array, or put a pickled object in its place."""
    kind = rng.randrange(4)
    if kind == 0 or data[:6] != b"\x93NUMPY":
        return rng.choice(binaries.WAYS)(data, rng)
    length = struct.unpack("<H", data[8:10])[0]
    header, body = data[10 : 10 + length].decode("latin1"), data[10 + length :]
    if kind == 1:
        header = "{'descr': '|O', 'fortran_order': False, 'shape': (1,), }"
        body = pickle.dumps([Escape()])
    elif kind == 2:
        start, end = header.find("'descr': ") + 9, header.find(", 'fortran")
        header = f"{header[:start]}'{rng.choice(DTYPES)}'{header[end:]}"
    else:
        start, end = header.find("'shape': ") + 9, header.rfind(", }")
        header = f"{header[:start]}{rng.choice(SHAPES)}{header[end:]}"
    header = texts.encoded(header) + b"\n"
    return data[:8] + struct.pack("<H", min(len(header), 65535)) + header + body


def change_png(data, rng):
    """Change a chunk of a PNG, its checksum made right."""
    chunks, at = [], 8
    while at + 12 <= len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        chunks.append((data[at + 4 : at + 8], data[at + 8 : at + 8 + length]))
        at += 12 + length
    if not chunks:
        return data
    chosen, kind = rng.randrange(len(chunks)), rng.randrange(5)
    name, content = chunks[chosen]
    if kind == 0 or (kind == 1 and name == b"IHDR"):
        at = rng.choice([0, 4, 8, 9, 10, 11, 12])
        n_bytes = 4 if at < 8 else 1
        name, content = chunks[0]
        new = hostile.integer(rng, n_bytes).to_bytes(n_bytes, "big")
        chunks[0] = name, content[:at] + new + content[at + n_bytes :]
    elif kind == 1:
        chunks[chosen] = name, rng.choice(binaries.WAYS)(content, rng)
    elif kind == 2:
        del chunks[chosen]
    elif kind == 3:
        chunks.insert(rng.randrange(len(chunks) + 1), chunks[chosen])
    else:
        chunks.insert(1, (b"zTXt", b"a\x00\x00" + zlib.compress(bytes(rng.choice([100, 1 << 26])))))
    return data[:8] + b"".join(
        struct.pack(">I", len(c)) + n + c + struct.pack(">I", zlib.crc32(n + c)) for n, c in chunks
    )


def change_jpeg(data, rng):
    """Change a segment of a JPEG before its scan: length, content, place."""
    segments, at = [], 2
    while at + 4 <= len(data) and data[at] == 0xFF and data[at + 1] != 0xDA:
        (length,) = struct.unpack(">H", data[at + 2 : at + 4])
        segments.append(data[at : at + 2 + length])
        at += 2 + length
    if not segments:
        return data
    chosen, kind = rng.randrange(len(segments)), rng.randrange(4)
    part = segments[chosen]
    if kind == 0:
        del segments[chosen]
    elif kind == 1:
        segments.insert(rng.randrange(len(segments) + 1), part)
    elif kind == 2:
        size = hostile.integer(rng, 2).to_bytes(2, "big")
        place = rng.choice([2, 5, 7])  # the segment's length; height and width in a frame header
        segments[chosen] = part[:place] + size + part[place + 2 :]
    else:
        segments[chosen] = part[:4] + rng.choice(binaries.WAYS)(part[4:], rng)
    return data[:2] + b"".join(segments) + data[at:]


def boxes(data, start=0, end=None):
    """Yield (start, end, kind) of the boxes of an MP4, those within others too."""
    end = len(data) if end is None else end
    while start + 8 <= end:
        size, kind = struct.unpack(">I4s", data[start : start + 8])
        if not 8 <= size <= end - start:
            return
        yield start, start + size, kind
        if kind in BOXES:
            yield from boxes(data, start + 8, start + size)
        start += size


def change_boxes(data, rng):
    """Change a box of an MP4: its size, kind, content, place."""
    there = [box for box in boxes(data) if box[2] != b"mdat" or rng.random() < 0.2]
    if not there:
        return data
    start, end, _ = rng.choice(there)
    box, kind = data[start:end], rng.randrange(6)
    if kind == 0:
        box = hostile.integer(rng, 4).to_bytes(4, "big") + box[4:]
    elif kind == 1:
        box = box[:4] + rng.choice([*BOXES, b"free", b"stco", b"stsz", b"cmov"]) + box[8:]
    elif kind == 2:
        box = b""
    elif kind == 3:
        box *= rng.choice([2, 2, 100])
    else:  # a number in it, or anything
        way = binaries.change_integer if kind == 4 else rng.choice(binaries.WAYS)
        box = box[:8] + way(box[8:], rng)
    return data[:start] + box + data[end:]


def change_sqlite(data, rng):
    """Change a cell, a table or the schema of an SQLite file by its own language."""
    with tempfile.TemporaryDirectory(dir=".") as folder:
        path = Path(folder) / "x.db"
        path.write_bytes(data)
        try:
            base = sqlite3.connect(path)
            with base:
                _change_base(base, rng)
            base.close()
        except sqlite3.Error:
            return data
        return path.read_bytes()


def _change_base(base, rng):
    tables = [n for (n,) in base.execute("SELECT name FROM sqlite_master WHERE type='table'")]
    table = rng.choice(sorted(name for name in tables if not name.startswith("sqlite_")))
    columns = [row[1] for row in base.execute(f"PRAGMA table_info({table})")]
    kind, column = rng.randrange(10), rng.choice(columns)
    if kind == 0:
        base.execute(f"DROP TABLE {table}")
    elif kind == 1:
        base.execute(f"ALTER TABLE {table} RENAME COLUMN {column} TO renamed")
    elif kind == 2:
        base.execute(f"DELETE FROM {table} WHERE rowid % 2 = {rng.randrange(2)}")
    else:
        rows = list(base.execute(f"SELECT rowid, {column} FROM {table}"))
        rowid, there = rng.choice(rows) if rows else (0, None)
        base.execute(f"UPDATE {table} SET {column} = ? WHERE rowid = ?", (_cell(there, rng), rowid))


def _cell(there, rng):
    if isinstance(there, bytes) and rng.random() < 0.8:
        return rng.choice((*binaries.WAYS, *texts.WAYS[:6]))(there, rng)
    if isinstance(there, str) and rng.random() < 0.7:
        return rng.choice(texts.WAYS)(there.encode(), rng).decode("utf-8", "replace")
    return rng.choice([None, -1, 0, 2**62, 1e308, "", "x" * 10_000, b"", b"\x00" * 9, "../x"])
