"""Why a value is missing, or how it was made: one code beside every keypoint.

The codes are stored as uint8 in the npz files and as words in the CSV files.
"""

OK = 0
UNSEEN = 1  # no detection: nobody found in the frame, or the camera had no frame then
LOW_SCORE = 2  # detected with a score below the configured minimum
ONE_VIEW = 3  # fewer usable views than triangulation needs
REJECTED = 4  # views disagree: no subset of them meets the reprojection limit
INTERPOLATED = 5  # a value filled in over a short gap (only in filtered results)
OUT_OF_IMAGE = 6  # the network placed it outside the picture
NO_DEPTH = 7  # a depth camera has no trusted depth there: a hole, an edge, something in front
UNCERTAIN = 8  # placed, but far less certain than usual: left out of kinematics

# Two cameras did not see it.
FEW_VIEWS = (UNSEEN, LOW_SCORE, ONE_VIEW, OUT_OF_IMAGE)

WORDS = {
    OK: "ok",
    UNSEEN: "unseen",
    LOW_SCORE: "low_score",
    ONE_VIEW: "one_view",
    REJECTED: "rejected",
    INTERPOLATED: "interpolated",
    OUT_OF_IMAGE: "out_of_image",
    NO_DEPTH: "no_depth",
    UNCERTAIN: "uncertain",
}
