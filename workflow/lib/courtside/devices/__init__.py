"""Files of devices and of other programs, read into records: BVH, mocopi, Nuitrack, OpenPose, depth."""
