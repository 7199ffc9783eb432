"""The joints of the limbs: every network, every device and the truth have them."""

LIMBS = ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
JOINTS = tuple(f"{side}_{limb}" for side in ("left", "right") for limb in LIMBS)
