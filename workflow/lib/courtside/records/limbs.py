"""The joints of the limbs: every network, every device and the truth have them."""

from itertools import pairwise

CHAINS = ("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")
LIMBS = tuple(limb for chain in CHAINS for limb in chain)
PARENT = {stop: start for chain in CHAINS for start, stop in pairwise(chain)}
JOINTS = tuple(f"{side}_{limb}" for side in ("left", "right") for limb in LIMBS)
