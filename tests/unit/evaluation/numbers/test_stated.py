"""Numbers of tables in the repository say where they come from."""

import pytest

from courtside.evaluation.numbers import register, stated
from courtside.study.errors import InputError

HEAD = "table,row,part,printed,unit,sessions,n,n_failed,origin,command\n"


def documents(tmp_path, line):
    path = tmp_path / stated.FOLDER / "hand.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEAD + line + "\n")
    return register.Source(tmp_path)


def test_a_number_by_hand_keeps_its_text_and_command(tmp_path):
    of = documents(tmp_path, "speed,a row,found,4.6 ms,,,12,,by hand,run.py")
    (found,) = stated.numbers(of)
    assert (found.printed, found.command, found.n) == ("4.6 ms", "run.py", 12)
    assert found.source == "docs/numbers/hand.csv" and found.selector == "line 2"


@pytest.mark.parametrize("line", ["speed,a,b,1,,,,,by hand,", "speed,a,b,1,,,,,study,run.py"])
def test_a_number_without_command_or_as_if_of_the_study_is_refused(tmp_path, line):
    with pytest.raises(InputError, match="line 2: expected an origin"):
        stated.numbers(documents(tmp_path, line))
