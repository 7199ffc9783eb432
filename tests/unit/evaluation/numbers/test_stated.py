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


def test_parts_of_one_cell_are_joined():
    rows = [["ways", "walk", "alone", 1.2, "cm"], ["ways", "walk", "alone_shape", 0.5, "cm"]]
    found = stated.joined([*rows, ["ways", "walk", "refined", 1.1, "cm"]])
    assert found == [
        ["ways", "walk", "alone", "1.2; 0.5", "cm"],
        ["ways", "walk", "refined", 1.1, "cm"],
    ]


def test_a_new_run_keeps_the_rows_of_sessions_that_it_did_not_measure(tmp_path):
    documents(tmp_path, 'halls,"one, hall",found,1.5,cm,one,8,0,benchmark,run.py')
    path = tmp_path / stated.FOLDER / "hand.csv"
    kept = ["halls", "one, hall", "found", "1.5", "cm", "one", "8", "0", "benchmark", "run.py"]
    assert stated.of_other_sessions(path, {"two"}) == [kept]
    assert stated.of_other_sessions(path, {"one"}) == []
    assert stated.of_other_sessions(tmp_path / "none.csv", {"one"}) == []
