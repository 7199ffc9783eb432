"""YAML read strictly."""

import pytest

from courtside.study.configuration import yaml_files
from courtside.study.errors import InputError


def read(tmp_path, text):
    path = tmp_path / "f.yaml"
    path.write_text(text)
    return yaml_files.read(path)


def test_a_mapping_is_read_with_anchors(tmp_path):
    found = read(tmp_path, "a: &x {b: 1}\nc: *x\nd: {<<: *x, e: 2}\n")
    assert found == {"a": {"b": 1}, "c": {"b": 1}, "d": {"b": 1, "e": 2}}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: 1\nb: 2\na: 3\n", "line 3: expected each key once, found 'a' again"),
        ("takes:\n  no: 1\n", "line 2: expected a name, found no; put it in quotes"),
        ("cameras: {07: {}}\n", "line 1: expected a name, found 07; put it in quotes"),
        ("2026-12-01: 1\n", "line 1: expected a name, found 2026-12-01; put it in quotes"),
        ('? !!int "1\\n"\n: 1\n', "line 1: expected a name, found 1; put it in quotes"),
        ("1: 2\n", "line 1: expected a name, found 1"),
        ("a: [1\n", "line 2"),
        ("a:\n\tb: 1\n", "line 2: found character '\\t' that cannot start any token; write spaces"),
        ("a:\n  b: {c: 1}\n c: 2\n", "; begin the keys of one level in the same column"),
        ("a:\n    b: 1\n   c: 2\n", "; begin the keys of one level in the same column"),
        ("a: Hall: player\n", "and put a text that holds a colon in quotes"),
        ("p: {height_m: 1,74}\n", "expected a name, found 74; put it in quotes, or, if it is the"),
        ("- 1\n", "expected keys and values, found list"),
        ("", "expected keys and values, found nothing; write them"),
        ("a: !!python/object/apply:os.system [ls]\n", "could not determine a constructor"),
    ],
)
def test_what_is_wrong_is_one_line_with_its_number(tmp_path, text, message):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert message in str(caught.value)
    assert "f.yaml" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("key", ["no", "on", "~"])
def test_only_a_number_may_be_the_rest_of_one(tmp_path, key):
    with pytest.raises(InputError) as caught:
        read(tmp_path, f"cameras: {{{key}: 1}}\n")
    assert str(caught.value).endswith(f"line 1: expected a name, found {key}; put it in quotes")


def test_a_key_that_a_study_has_twice_is_told_of_each_file(tmp_path):
    files = [tmp_path / name for name in ("good.yaml", "one.yaml", "two.yaml", "other.json")]
    texts = ["models: [a]\n", "models: [a]\nmodels: [b]\n", "a: 1\n\na: 1\n", "{\n\t1: 2}"]
    for path, text in zip(files, texts, strict=True):
        path.write_text(text)
    with pytest.raises(InputError) as caught:
        yaml_files.check(files)
    assert caught.value.lines == [
        f"{tmp_path}/one.yaml: line 2: expected each key once, found 'models' again",
        f"{tmp_path}/two.yaml: line 3: expected each key once, found 'a' again",
    ]
    yaml_files.check(files[:1])


def test_a_missing_file_is_one_line(tmp_path):
    with pytest.raises(InputError, match="expected a readable YAML file"):
        yaml_files.read(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    "text",
    [
        "a: 2026-02-30\n",
        "a: " + "1" * 5000,
        "a: !!int ''\n",
        "a: !!bool x\n",
        "a: !!float x\n",
        "a: !!timestamp x\n",
        "a: 0b_\n",
        "a: \0\n",
        "? [a]\n: 1\n",
        "a: " + "[" * 5000,
        "on: 1\n",
        "2026-11-21: 1\n",
    ],
)
def test_values_that_do_not_exist_are_one_line(tmp_path, text):
    with pytest.raises(InputError, match=r"f\.yaml: ") as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)


def test_other_bytes_than_utf_8_are_one_line(tmp_path):
    (tmp_path / "f.yaml").write_bytes("a: Jörg".encode("latin-1"))
    with pytest.raises(InputError, match="expected a readable YAML file"):
        yaml_files.read(tmp_path / "f.yaml")


LAUGHS = "a0: &a0 [x, x, x, x]\n" + "".join(
    f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 10)}]\n" for k in range(1, 12)
)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (LAUGHS, "aliases of aliases"),
        ("a: &a [*a]\n", "too deep nesting"),
        ("a: " + "[" * 200 + "]" * 200, "too deep nesting"),
        ("a: 0x" + "f" * 6000, "thousands of digits"),
        ("a: b\n" + "#" * (1 << 20), "1048581 characters"),
    ],
)
def test_what_would_fill_time_or_memory_is_one_line_at_once(tmp_path, text, found):
    with pytest.raises(InputError, match=rf"f\.yaml: expected .*, found .*{found}") as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)


def test_the_mark_that_windows_puts_first_is_left_out(tmp_path):
    (tmp_path / "f.yaml").write_bytes(b"\xef\xbb\xbfa: 1\n")
    assert yaml_files.read(tmp_path / "f.yaml") == {"a": 1}


@pytest.mark.parametrize(
    ("key", "file"),
    [
        ("a", "mine.yaml"),
        ("b.c", "config.yaml"),
        ("b.d", "mine.yaml"),
        ("b", "mine.yaml"),
        ("e.0", "config.yaml"),
        ("f", "mine.yaml"),
        ("b.null", "mine.yaml"),
        ("top level", "mine.yaml"),
    ],
)
def test_a_value_stands_in_the_default_file_if_that_has_the_same_one(tmp_path, key, file):
    default = tmp_path / "config.yaml"
    default.write_text("a: 1\nb: {c: 2, d: 3}\ne: [4]\n")
    merged = {"a": 0, "b": {"c": 2, "d": 5, "null": None}, "e": [4], "f": 6}
    found = yaml_files.file_of(key, merged, "mine.yaml", default)
    assert found == (str(default) if file == "config.yaml" else file)
    assert yaml_files.file_of(key, merged, "mine.yaml", tmp_path / "absent.yaml") == "mine.yaml"


def test_a_wide_space_as_indent_is_told(tmp_path):
    """It is a letter of the name to YAML, and the key stands on another level."""
    path = tmp_path / "s.yaml"
    path.write_text("takes:\n\u3000smash1: {}\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        yaml_files.read(path)
    assert str(caught.value) == f"{path}: line 2: found a wide space (U+3000); write plain spaces"
