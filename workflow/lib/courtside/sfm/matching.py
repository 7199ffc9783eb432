"""Matches of image pairs, once per pair, with their two-view geometries."""

import contextlib
import sqlite3

import pycolmap

from courtside.sfm import database


def match(features_db, matches_db, pairs, *, seed, max_ratio=0.8):
    """Match pairs of images and verify the matches; the result holds all that mapping needs.

    Parameters
    ----------
    features_db : str or Path
    matches_db : str or Path
        Written: the features' places and the matches, without descriptors.
    pairs : list of (str, str)
        Names of images.
    seed : int
        Of the verification's random samples.
    max_ratio : float
        Of the distances to the best and the second-best descriptor (Lowe's test).

    Returns
    -------
    n_verified : dict of (str, str) to int
        Matches that agree with one two-view geometry, by pair; 0 where none was found.

    Notes
    -----
    One thread: with several, one run in 15 to 50 on a busy machine had other matches of the first few images,
    whatever the seed.
    """
    matching = pycolmap.FeatureMatchingOptions(num_threads=1, use_gpu=False)
    matching.sift.max_ratio = max_ratio
    verification = pycolmap.TwoViewGeometryOptions()
    verification.ransac.random_seed = seed
    with database.new(matches_db, features_db) as temporary:
        listed = temporary.with_name("pairs.txt")
        listed.write_text("".join(f"{a} {b}\n" for a, b in pairs))
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


def _verified(path, pairs):
    ids = database.image_ids(path)
    with contextlib.closing(pycolmap.Database.open(path)) as opened:
        found, counts = opened.read_two_view_geometry_num_inliers()
    by_pair = dict(zip(map(int, found), map(int, counts), strict=True))
    return {
        (a, b): by_pair.get(int(pycolmap.image_pair_to_pair_id(ids[a], ids[b])), 0)
        for a, b in pairs
    }
