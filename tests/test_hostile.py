"""What no file of the study may do: run what it reads, leave its folder, name what a shell runs."""

import ast
import re
import subprocess
from pathlib import Path

import pytest

from courtside.study.configuration import configuration, schemas, yaml_files
from courtside.study.errors import InputError

ROOT = Path(__file__).parents[1]
PROGRAM = ("Snakefile", "workflow", "benchmarks")
MODULES = {"pickle", "cPickle", "marshal", "shelve", "joblib", "dill", "cloudpickle", "imp"}
CALLS = {
    *("eval", "exec", "compile", "__import__", "input", "os.system", "os.popen"),
    *("yaml.unsafe_load", "yaml.full_load", "yaml.load_all", "tempfile.mktemp"),
    *("pd.read_pickle", "pd.eval"),
}  # fmt: skip
METHODS = {"extractall", "extract", "to_pickle", "unpack_archive", "getoutput", "getstatusoutput"}
OURS = {"features.extract", "walk_frames.extract"}  # no archives
SAFE_LOADERS = {"_StrictLoader", "yaml.SafeLoader", "yaml.CSafeLoader"}


def files(*suffixes):
    """Return the tracked or new files of the program with these endings."""
    command = ["git", "ls-files", "-co", "--exclude-standard", *PROGRAM]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    paths = [ROOT / line for line in done.stdout.splitlines()]
    return [path for path in paths if path.is_file() and path.suffix in suffixes]


def full_name(node):
    """Return `os.path.join` of such a node, empty for what is no name."""
    if isinstance(node, ast.Attribute):
        return f"{full_name(node.value)}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else ""


def of_call(node):
    """Yield what a call does that none may."""
    name = full_name(node.func)
    options = {word.arg: word.value for word in node.keywords}
    if name in CALLS or (name.rpartition(".")[2] in METHODS and name not in OURS):
        yield name
    if name == "yaml.load" and full_name(options.get("Loader")) not in SAFE_LOADERS:
        yield "yaml.load without a safe loader"
    for option in ("shell", "allow_pickle"):
        value = options.get(option)
        if value is not None and getattr(value, "value", True) is not False:
            yield f"{option} that is not False"


def forbidden(source):
    """Return what a module does that none may."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found += [a.name for a in node.names if a.name.split(".")[0] in MODULES]
        elif isinstance(node, ast.ImportFrom):
            found += [node.module] if (node.module or "").split(".")[0] in MODULES else []
        elif isinstance(node, ast.Call):
            found += of_call(node)
    return found


def unquoted(rules):
    """Return the shell commands of rules that put a name in without quoting it."""
    blocks = re.findall(r"^ *shell:(.*?)(?=^ *\w+:|^\S|\Z)", rules, flags=re.M | re.S)
    fields = [re.sub(r"\{\{|\}\}", "", block) for block in blocks]
    return [block.strip() for block in fields if re.search(r"\{[^{}]*(?<!:q)\}", block)]


# What a pickle may do there, and the classes that it may name, stand in two short lists.
GUARDED = {"workflow/lib/courtside/calibration/foreign/opencap.py": ["pickle"]}


def test_no_module_runs_what_it_reads():
    found = {
        path.relative_to(ROOT).as_posix(): forbidden(path.read_text()) for path in files(".py")
    }
    assert len(found) > 200
    assert {name: what for name, what in found.items() if what} == GUARDED


@pytest.mark.parametrize(
    "source",
    [
        "import pickle", "from joblib import load", "eval(text)", "exec('x')", "yaml.load(text)",
        "yaml.load(text, Loader=yaml.Loader)", "yaml.full_load(text)",
        "np.load(path, allow_pickle=True)", "np.load(path, allow_pickle=flag)",
        "subprocess.run(words, shell=True)", "os.system('ls')",
        "archive.extractall()", "archive.extract(name)", "shutil.unpack_archive(path)",
    ],
)  # fmt: skip
def test_the_check_of_modules_bites(source):
    assert len(forbidden(source)) == 1


def test_what_is_safe_passes():
    assert forbidden("yaml.load(t, Loader=_StrictLoader)\nnp.load(p, allow_pickle=False)") == []
    assert forbidden("import re\nre.compile('x')\nsubprocess.run(words, check=True)") == []


def test_rules_quote_names_in_shells():
    rules = files(".smk", "")
    assert len(rules) > 20
    assert [path.name for path in rules if unquoted(path.read_text())] == []


@pytest.mark.parametrize(
    ("command", "count"),
    [('"ls {input}"', 1), ('"ls {input:q}"', 0), ('"ls {wildcards.take}"', 1), ('"awk {{x}}"', 0)],
)
def test_the_check_of_shells_bites(command, count):
    rule = (
        f"rule a:\n    output: '{{take}}'\n    shell:\n        {command}\n\n"
        "rule b:\n    input: 'x'\n"
    )
    assert len(unquoted(rule)) == count


NAMES = (
    "../x", "..", ".", "a/b", "/a", "a\\b", "a b", "$(x)", "`x`", "-rf", "--help", "a;b", "a|b",
    "a&b", "a>b", "~", "*", "{x}", "", " ", "A", "con", "nul", "com1", "a\n", "\na", "a\nb", "a\tb",
    "a\x00", "\x1b[2J", "x" * 65, "x" * 100_000, "сам", "ѕide", "ａ", "side\u200b", "ﬁ", "café",
    "\u202eedis", "٣",
)  # fmt: skip
SESSION = {
    "description": "a hall",
    "court": "badminton",
    "subjects": {"p1": None},
    "cameras": {"left": None, "right": None},
    "walks": {"walk1": {"video": "w.mp4"}},
    "views": {"two": ["left", "right"]},
    "takes": {
        "t1": {
            "videos": {"left": "l.mp4", "right": "r.mp4"},
            "devices": {"suit": {"file": "s.bvh", "subject": "p1"}},
            "clocks": {"suit": {"offset_s": 0.5}},
            "pose2d": {"body25": {"left": "j"}},
        }
    },
}
PLACES = {
    "camera": ("cameras",),
    "walk": ("walks",),
    "view": ("views",),
    "take": ("takes",),
    "person": ("subjects",),
    "device": ("takes", "t1", "devices"),
    "clock": ("takes", "t1", "clocks"),
    "skeleton": ("takes", "t1", "pose2d"),
}


def renamed(content, places, name):
    """Return a copy in which the first key of a mapping is another one."""
    place, *others = places
    inner = content[place]
    if others:
        return content | {place: renamed(inner, others, name)}
    first, *_ = inner
    return content | {place: {name if key == first else key: inner[key] for key in inner}}


def lines(content, schema):
    """Return the faults that a check finds, as the message of its error has them."""
    faults = schemas.faults(content, schema, "f.yaml")
    return InputError(*faults).lines


def assert_one_line(found, key):
    (line,) = found
    assert line.startswith("f.yaml: ") and key in line
    assert line.isprintable() and len(line) < 1100


def test_plain_names_pass():
    assert lines(SESSION, "session") == []
    for places in PLACES.values():
        assert lines(renamed(SESSION, places, "x-2_3"), "session") == []
        assert lines(renamed(SESSION, places, "x" * 64), "session") == []


@pytest.mark.parametrize("name", NAMES, ids=lambda name: ascii(name)[:12])
def test_no_name_leaves_its_folder_or_reaches_a_shell(name):
    for places in PLACES.values():
        assert_one_line(lines(renamed(SESSION, places, name), "session"), places[-1])
    assert_one_line(lines(SESSION | {"court": name}, "session"), "court")
    config = yaml_files.read(ROOT / "config" / "config.yaml")
    for key in ("sessions", "models", "plans"):
        assert_one_line(lines(config | {key: [name]}, "config"), key)
    assert configuration.NAME.fullmatch(name) is None


@pytest.mark.parametrize("path", ["", "a\nb", "a\x00b", "\x1b[2J"])
def test_no_path_breaks_a_line(path):
    take = SESSION["takes"]["t1"] | {"videos": {"left": path, "right": "r.mp4"}}
    found = lines(SESSION | {"takes": {"t1": take}}, "session")
    assert found and all("takes.t1.videos.left" in line and line.isprintable() for line in found)
