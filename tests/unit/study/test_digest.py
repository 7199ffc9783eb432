"""A digest that follows code, not comments, through imports."""

from pathlib import Path

import pytest

from courtside.study import digest
from courtside.study.errors import InputError

ROOT = Path(__file__).parents[3]
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


def test_the_study_reruns_only_what_uses_triangulation():
    library, scripts = ROOT / "workflow" / "lib", ROOT / "workflow" / "scripts"
    module = "courtside.geometry.triangulation"
    users = {p.stem for p in scripts.glob("*.py") if module in digest.modules_of(p, library)}
    assert {"triangulate", "align_cameras", "calibrate_cameras"} <= users
    free = {"detect_pose", "simulate_session", "extract_features", "match_images", "map_images"}
    assert not users & (
        free | {"extract_static", "extract_frames", "filter_motion", "draw_overlay"}
    )
