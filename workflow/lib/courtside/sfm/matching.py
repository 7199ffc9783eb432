"""Match image pairs once, and verify the matches by two-view geometries."""

import contextlib
import sqlite3
from collections.abc import Sequence
from pathlib import Path

import pycolmap

from courtside.sfm import database
from courtside.study.errors import StrPath


def match(
    features_db: StrPath,
    matches_db: StrPath,
    pairs: Sequence[tuple[str, str]],
    *,
    seed: int,
    max_ratio: float = 0.8,
) -> dict[tuple[str, str], int]:
    """Match pairs of images, verify the matches, and write what mapping needs: no descriptors.

    Return the number of matches that agree with one two-view geometry, by pair. The seed is that of
    the verification's random samples, `max_ratio` that of the distances to the best and the
    second-best descriptor (Lowe's test). One thread: with several, one run in 15 to 50 on a busy
    machine had other matches of the first few images, whatever the seed.
    """
    matching = pycolmap.FeatureMatchingOptions(num_threads=1, use_gpu=False)
    matching.sift.max_ratio = max_ratio
    verification = pycolmap.TwoViewGeometryOptions()
    verification.ransac.random_seed = seed
    with database.new(matches_db, features_db) as temporary:
        listed = temporary.with_name("pairs.txt")
        lines = "".join(f"{a} {b}\n" for a, b in pairs)
        listed.write_text(lines, encoding="utf-8", newline="\n")
        pycolmap.match_image_pairs(
            temporary,
            matching_options=matching,
            pairing_options=pycolmap.ImportedPairingOptions(match_list_path=str(listed)),
            verification_options=verification,
            device=pycolmap.Device.cpu,
        )
        with contextlib.closing(sqlite3.connect(temporary)) as connection:
            connection.execute("DELETE FROM descriptors")
            connection.execute("DELETE FROM matches")  # mapping reads the verified ones only
            connection.commit()
        return _verified(temporary, pairs)


def _verified(path: Path, pairs: Sequence[tuple[str, str]]) -> dict[tuple[str, str], int]:
    ids = database.image_ids(path)
    with contextlib.closing(pycolmap.Database.open(path)) as opened:
        found, counts = opened.read_two_view_geometry_num_inliers()
    by_pair = dict(zip(map(int, found), map(int, counts), strict=True))
    keys = {(a, b): int(pycolmap.image_pair_to_pair_id(ids[a], ids[b])) for a, b in pairs}
    return {pair: by_pair.get(key, 0) for pair, key in keys.items()}
