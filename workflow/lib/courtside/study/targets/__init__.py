"""What the study makes: the files that Snakemake asks for, from the checked configuration alone.

calibration: cameras, their errors, the figures of the calibration study
takes: exports, figures, measures and errors of each take
devices: figures and errors of takes with devices of their own
together: figures and tables of several takes
pages: viewers, clicking pages, videos with skeletons, plans
remains: results of takes that are no more, or that persons no longer agree to
names: `faults`: files that are asked for and that no rule makes
numbers: tables that the numbers of the documents come from
"""

from courtside.study.targets import (
    calibration,
    devices,
    names,
    numbers,
    pages,
    remains,
    takes,
    together,
)

__all__ = ["calibration", "devices", "names", "numbers", "pages", "remains", "takes", "together"]
