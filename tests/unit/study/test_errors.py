"""An error's message is one line whatever is put in; damage of any kind becomes such an error."""

import json
import lzma
import pickle
import struct
import tomllib
import zlib

import pytest
import yaml

from courtside.study import errors
from courtside.study.errors import InputError, few, nearest


def test_a_plain_message_stays_as_it_is():
    text = "My  Gym/a.csv: expected 3 µm, found '½'; correct it"
    assert str(InputError(text)) == text


@pytest.mark.parametrize(
    "letter", ["\n", "\r", "\t", "\x00", "\x1b[2J", "\u2028", "\ud800", "\xa0"]
)
def test_what_does_not_print_is_written_out(letter):
    message = str(InputError(f"a: found {letter} here"))
    assert message.isprintable()
    assert message.splitlines() == [message]
    assert message.startswith("a: found \\") and message.endswith(" here")


@pytest.mark.parametrize("letter", ["x", "\x00", "\U000e0001"])
def test_the_middle_of_an_endless_line_is_left_out(letter):
    message = str(InputError(f"a.csv: found {letter * 100_000}; correct it"))
    assert len(message) < errors.LONGEST
    assert message.startswith("a.csv: found ") and message.endswith("; correct it")
    assert message.isprintable()


def test_several_faults_are_a_line_each():
    error = InputError("a: 1", "b: 2\n3")
    assert str(error).splitlines() == error.lines == ["a: 1", "b: 2\\n3"]
    assert str(pickle.loads(pickle.dumps(InputError("a: 1")))) == "a: 1"


def fail(name):
    return {
        "json": lambda: json.loads("[" * 100_000),
        "toml": lambda: tomllib.loads("a = " + "[" * 100_000),
        "number": lambda: f"{16**6000}",
        "zlib": lambda: zlib.decompress(b"x"),
        "lzma": lambda: lzma.decompress(b"xxx"),
        "struct": lambda: struct.unpack("<I", b""),
        "key": lambda: {}["a"],
        "library": lambda: yaml.safe_load("!!timestamp x"),  # an AttributeError of PyYAML's own
        "file": lambda: open("/nowhere/at all"),  # noqa: PTH123
    }[name]()


@pytest.mark.parametrize(
    "name", ["json", "toml", "number", "zlib", "lzma", "struct", "key", "file", "library"]
)
def test_damage_of_any_kind_becomes_one_line(name):
    with (
        pytest.raises(InputError, match=r"^a\.x: expected a thing, found: .+; mend it$") as caught,
        errors.reading("a.x", "a thing", "mend it"),
    ):
        fail(name)
    assert len(str(caught.value).splitlines()) == 1


def test_what_is_no_damage_passes():
    with pytest.raises(KeyboardInterrupt), errors.reading("a", "b"):
        raise KeyboardInterrupt
    with pytest.raises(InputError, match=r"^as it was$"), errors.reading("a", "b"):
        raise InputError("as it was")
    with pytest.raises(ValueError, match=r"^other$"), errors.reading("a", "b", kinds=(OSError,)):
        raise ValueError("other")


def test_an_error_without_words_is_named():
    assert errors.message(MemoryError()) == "MemoryError"
    assert errors.message(ValueError("two\n lines")) == "two lines"
    assert errors.message(KeyError("timestamp")) == "no 'timestamp'"
    assert errors.message(KeyError("['a'] not in index")).endswith('not in index"')
    assert errors.message(IndexError("list index out of range")) == "fewer entries"
    assert len(errors.message(ValueError("x" * 9999))) == errors.SHORT


def test_too_little_memory_for_a_whole_file_is_told_as_that():
    words = "make it again; or, if the file is whole, end other programs"
    with pytest.raises(InputError, match=words), errors.reading("poses.npz", "an npz file"):
        raise MemoryError("Unable to allocate 55.7 KiB")


@pytest.mark.parametrize("fault", [TypeError("len() of unsized object"), AttributeError("no x")])
def test_a_fault_of_our_own_code_is_not_called_damage(fault):
    with pytest.raises(type(fault)) as caught, errors.reading("a.x", "b"):
        raise fault
    assert caught.value is fault
    with pytest.raises(InputError), errors.reading("a.x", "b", kinds=(type(fault),)):
        raise fault
    with pytest.raises(TypeError), errors.reading("a.x", "b"):
        len(3)  # raised by the interpreter, called by us
    with pytest.raises(AttributeError), errors.reading("a.x", "b", kinds=(OSError,)):
        fail("library")


def test_content_of_another_type_is_damage():
    assert errors.require_type([1], list) == [1] and errors.require_type({}, dict) == {}
    assert [errors.require_scalar(value) for value in (1, 2.5, "3")] == [1, 2.5, "3"]
    for read in (lambda: errors.require_type([1], dict), lambda: errors.require_scalar(None)):
        with pytest.raises(InputError, match=r"found: \w+ in place of "), errors.reading("a", "b"):
            read()


def test_a_few_names_are_told_and_the_others_counted():
    assert few(["a", "b"], 2) == "a, b"
    assert few(["a", "b", "c", "d"], 2) == "a, b and 2 more"


def test_lines_begin_with_the_file_that_they_are_about():
    with pytest.raises(InputError) as caught, errors.about("a.csv"):
        raise InputError("one", "two")
    assert caught.value.lines == ["a.csv: one", "a.csv: two"]
    with pytest.raises(KeyError), errors.about("a.csv"):
        raise KeyError("three")


def test_the_nearest_name_is_advised():
    assert nearest("sprnig", ["autumn", "spring"], "remove it") == "did you mean 'spring'?"
    assert nearest("xy", ["autumn", "spring"], "remove it") == "remove it"
