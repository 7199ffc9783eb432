"""The body frame of a T-pose, and the frame that all sources of a take share."""
