"""A file that no rule makes: the line says what there is, and the nearest name."""

import pytest

from courtside.study.targets import names

KNOWN = ["all", "report", "results/report.html", "results/{session,north|south}/pages/quality.html"]
KNOWN += ["results/south/figures/errors.png", "results/{session,north|south}/{take,[a-z]+}.html"]


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("reportt", "a rule or a file that one makes, found neither; did you mean 'report'?"),
        ("results/report.htm", "found neither; did you mean 'results/report.html'?"),
        ("xyz", "found neither; see config/README.md, Files that the study makes"),
        ("results/nort/pages/quality.html", "north, south, found 'nort'; did you mean 'north'?"),
        ("results/x/a.csv", "a session of the study, one of north, south, found 'x'; name it"),
        ("results/north/pages/qualiti.html", "did you mean 'results/north/pages/quality.html'?"),
        ("results/north/figures/errors.png", "found neither; see config/README.md"),
        ("results/figures/errors.png", "did you mean 'results/south/figures/errors.png'?"),
    ],
)
def test_a_name_that_nothing_makes_is_told_with_the_nearest_one(target, said):
    line = names.fault(target, ["north", "south"], KNOWN)
    assert line.startswith(f"{target}: expected")
    assert said in line
