"""A digest that follows code, not comments, through imports."""

import json
from pathlib import Path

import pytest

from courtside.study.errors import InputError
from courtside.study.execution import digest

ROOT = Path(__file__).parents[4]
FILES = {
    "courtside/__init__.py": "",
    "courtside/a/__init__.py": '"""A."""\n',
    "courtside/a/near.py": "from courtside.b import far\n\ndef f():\n    return far.g()\n",
    "courtside/b/__init__.py": "",
    "courtside/b/far.py": '"""Far."""\n\ndef g():\n    """Return one."""\n    return 1\n',
    "courtside/b/aside.py": "X = 1\n",
    "script.py": "from courtside.a import near\n\nnear.f()\n",
}


@pytest.fixture
def library(tmp_path):
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    digest._parsed.cache_clear()
    yield tmp_path
    digest._parsed.cache_clear()


def of(library):
    digest._parsed.cache_clear()
    return digest.code_digest(library / "script.py", library)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("courtside/b/far.py", "return 1", "return  1  # one"),
        ("courtside/b/far.py", "Return one.", "Give one."),
        ("courtside/b/aside.py", "X = 1", "X = 2"),
        ("courtside/a/near.py", "return far.g()", "return (far.g())"),
    ],
)
def test_what_changes_no_result_keeps_the_digest(library, name, old, new):
    before = of(library)
    path = library / name
    path.write_text(path.read_text().replace(old, new))
    assert of(library) == before


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("script.py", "near.f()", "near.f"),
        ("courtside/a/near.py", "far.g()", "far.g() + 1"),
        ("courtside/b/far.py", "return 1", "return 2"),
        ("courtside/a/__init__.py", '"""A."""', "A = 1"),
    ],
)
def test_code_that_is_reached_changes_the_digest(library, name, old, new):
    before = of(library)
    path = library / name
    path.write_text(path.read_text().replace(old, new))
    assert of(library) != before


@pytest.mark.parametrize(
    "line",
    [
        "import courtside.b.far",
        "from courtside.b import far",
        "from courtside.b.far import g",
        "def f():\n    from courtside.b.far import g as h",
    ],
)
def test_every_form_of_import_is_followed(library, line):
    (library / "script.py").write_text(line + "\n")
    digest._parsed.cache_clear()
    assert "courtside.b.far" in digest.modules_of(library / "script.py", library)


def test_a_syntax_error_is_one_line(library):
    (library / "courtside/b/far.py").write_text("def g(:\n")
    with pytest.raises(InputError, match=r"far\.py.*line 1"):
        of(library)


LOCK = """# made by a tool
numpy==2.4.6 \\
    --hash=sha256:00
opencv-python-headless==5.0 \\
    --hash=sha256:01
pytest[extra]==9 \\
scipy==1.17 ; python_full_version < '3.12' \\
scipy==1.18 ; python_full_version >= '3.12' \\
tomli-w==1.2 \\
"""


PINS = [line for line in LOCK.splitlines() if "==" in line]


def of_rule(library, lock=LOCK):
    digest._parsed.cache_clear()
    return digest.Remembered(library / "no.json", lock).digest(library / "script.py", library)


@pytest.mark.parametrize(
    ("line", "changed"),
    [
        ("import numpy as np", ["numpy"]),
        ("import cv2", ["opencv-python-headless"]),
        ("from scipy.spatial import transform", ["scipy", "scipy"]),
        ("def f():\n    import tomli_w", ["tomli-w"]),
        ("import json, not_in_the_lock", []),
    ],
)
def test_packages_are_those_that_code_imports_as_the_lock_pins_them(library, line, changed):
    (library / "courtside/b/far.py").write_text(line + "\n")
    known = of_rule(library)
    newer = {pin: LOCK.replace(pin, pin.replace("==", "==9.")) for pin in PINS}
    found = [pin for pin, lock in newer.items() if of_rule(library, lock) != known]
    assert [pin.partition("==")[0] for pin in found] == changed


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("numpy==2.4.6", "numpy==2.5", False),
        ("tomli-w==1.2", "tomli-w==1.3", True),
        ("pytest[extra]==9", "pytest[extra]==10", True),
        ("# made by a tool", "# made again", True),
        ("sha256:00", "sha256:02", True),
    ],
)
def test_a_new_version_changes_the_digest_of_what_imports_it(library, old, new, same):
    (library / "courtside/a/near.py").write_text("import numpy\n")
    before, after = (of_rule(library, text) for text in (LOCK, LOCK.replace(old, new)))
    assert old in LOCK
    assert (before == after) == same
    assert (
        before.split("-")[0]
        == after.split("-")[0]
        == digest.code_digest(library / "script.py", library)
    )


def test_the_study_reruns_only_what_uses_triangulation():
    library, scripts = ROOT / "workflow" / "lib", ROOT / "workflow" / "scripts"
    module = "courtside.geometry.triangulation"
    users = {p.stem for p in scripts.glob("*.py") if module in digest.modules_of(p, library)}
    assert {"triangulate", "align_cameras", "calibrate_cameras"} <= users
    free = {"detect_pose", "simulate_session", "extract_features", "match_images", "map_images"}
    assert not users & (
        free | {"extract_static", "extract_frames", "filter_motion", "draw_overlay"}
    )


def remembered(library):
    digest._parsed.cache_clear()
    return digest.Remembered(library / "kept" / "code.json", LOCK)


def test_what_is_remembered_is_the_digest_and_nothing_is_parsed_again(library, monkeypatch):
    first = remembered(library)
    expected = of_rule(library)
    assert first.digest(library / "script.py", library) == expected
    first.save()
    monkeypatch.setattr(digest.ast, "parse", lambda *_, **__: pytest.fail("parsed again"))
    assert remembered(library).digest(library / "script.py", library) == expected


@pytest.mark.parametrize("name", ["script.py", "courtside/b/far.py", "courtside/a/__init__.py"])
def test_a_change_of_code_is_seen_in_spite_of_what_is_remembered(library, name):
    first = remembered(library)
    before = first.digest(library / "script.py", library)
    first.save()
    (library / name).write_text((library / name).read_text() + "\nfrom courtside.b import aside\n")
    second = remembered(library)
    assert second.digest(library / "script.py", library) == of_rule(library) != before
    second.save()
    (library / "courtside/b/aside.py").write_text("X = 2\n")
    assert remembered(library).digest(library / "script.py", library) == of_rule(library)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"a": 1}', "\udcff"])
def test_a_damaged_memory_costs_time_only(library, text):
    path = library / "kept" / "code.json"
    path.parent.mkdir()
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    again = remembered(library)
    assert again.digest(library / "script.py", library) == of_rule(library)
    again.save()
    assert digest.Remembered(path, LOCK).digest(library / "script.py", library) == of_rule(library)


def test_a_memory_keeps_only_what_was_used(library):
    first = remembered(library)
    first.digest(library / "script.py", library)
    first.save()
    n_kept = len(json.loads((library / "kept/code.json").read_text()))
    (library / "script.py").write_text("from courtside.a import near\n\nnear.f\n")
    second = remembered(library)
    second.digest(library / "script.py", library)
    second.save()
    assert len(json.loads((library / "kept/code.json").read_text())) == n_kept


def test_a_lock_with_another_version_is_seen_in_spite_of_what_is_remembered(library):
    (library / "courtside/a/near.py").write_text("import numpy\n")
    first = remembered(library)
    before = first.digest(library / "script.py", library)
    first.save()
    newer = digest.Remembered(library / "kept" / "code.json", LOCK.replace("2.4.6", "2.5"))
    assert newer.digest(library / "script.py", library) != before


def test_a_memory_that_may_not_be_written_costs_time_only(library):
    (library / "kept").write_text("a file where the folder should be")
    first = remembered(library)
    first.digest(library / "script.py", library)
    first.save()
