"""Reading and checking all configuration at once: every fault, one line each."""

import difflib
import functools
import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import jsonschema
import yaml

from courtside.study.configuration import (
    session_faults,
    session_files,
    sessions,
    take_faults,
    yaml_files,
)
from courtside.study.configuration.sessions import Model, Session, Study
from courtside.study.configuration.yaml_files import Content
from courtside.study.errors import InputError, StrPath
from courtside.study.execution.artefacts import Artefact

SCHEMAS = Path(__file__).parents[4] / "schemas"
# Folders of results/ that are no session.
RESERVED = ("external", "networks", "run", "figures", "virtual", "plans")

# Names of folders and files: none leaves its folder, is an option, or a device of Windows.
NAME = re.compile(r"(?!(?:con|prn|aux|nul|com[0-9]|lpt[0-9])\Z)[a-z0-9][a-z0-9_-]{0,63}")
# JSON Schema lets 3.0 pass for an integer, and a comparison lets nan pass for any number.
TYPES = jsonschema.Draft202012Validator.TYPE_CHECKER.redefine_many(
    {
        "integer": lambda _, value: isinstance(value, int) and not isinstance(value, bool),
        "number": lambda _, value: (
            isinstance(value, int | float)
            and not isinstance(value, bool)
            and abs(value) <= sys.float_info.max
        ),
    }
)
REPLACED = {  # keys of former versions: what to use now
    "measure_kinematics": "remove it: kinematics are measured on the exported skeletons, whose "
    "filter and cut-offs are those of filter_motion"
}
VALIDATOR = jsonschema.validators.extend(jsonschema.Draft202012Validator, type_checker=TYPES)


class ConfigurationError(InputError):
    """All faults of a configuration; the message has one line for each."""

    def __init__(self, faults: Iterable[str]) -> None:
        super().__init__(*faults)
        self.faults = self.lines


def load(config: Content, config_file: str, folder: StrPath, root: StrPath = ".") -> Study:
    """Check the whole configuration and return what it says.

    `config` is merged, as Snakemake gives it, and `config_file` its name, for messages. `folder` is
    config/ with sessions/, skeletons/, models.yaml and external.yaml; relative paths in sessions
    start from `root`. A `ConfigurationError` has every fault of every file.
    """
    folder = Path(folder)
    faults: list[str] = []
    external = _checked(folder / "external.yaml", "external", faults)
    models = _checked(folder / "models.yaml", "models", faults)
    faults += schema_faults(config, "config", config_file)
    known = None
    if external is not None:
        known = {name: Artefact(name, **entry) for name, entry in external.items()}
    if models is not None:
        for name, entry in models.items():
            faults += _model_faults(folder, name, entry, known)
        faults += take_faults.unknown(f"{config_file}: models", _names(config, "models"), models)
    found = {}
    for name in _names(config, "sessions"):
        file = folder / "sessions" / f"{name}.yaml"
        missing = list(_name_faults(f"{config_file}: sessions", name, file))
        faults += missing
        content = None if missing else _checked(file, "session", faults)
        if content is not None:
            faults += session_faults.find(folder, file, content, known, Path(root))
            wanted = content.get("override", {}).get("models", [])
            there = [*(models or wanted), *take_faults.imported(content)]
            faults += take_faults.unknown(f"{file}: override.models", wanted, there)
            found[name] = (file, content)
    if not faults:
        faults += session_faults.conditions(config_file, config, found)
    if faults or known is None or models is None:
        raise ConfigurationError(faults)
    return Study(
        sessions=_sessions(config, found, root),
        artefacts=known,
        models=_models(models, found),
        parameters=config,
        folder=folder,
    )


def _models(models: Content, found: dict[str, tuple]) -> dict[str, Model]:
    """Return the networks, and the skeletons of imported keypoints."""
    imported = [name for _, content in found.values() for name in take_faults.imported(content)]
    others = {name: Model(name=name, decoder="imported", skeleton=name) for name in imported}
    return others | {name: sessions.model(name, entry) for name, entry in models.items()}


def _sessions(config: Content, found: dict[str, tuple], root: StrPath) -> dict[str, Session]:
    """Return the sessions of the files, and the variations that conditions make of them."""
    made = {
        name: session_files.session(name, file, content, config, root)
        for name, (file, content) in found.items()
    }
    for name in config["variations"]:
        condition = config["conditions"][name]
        made |= session_files.variations(made[condition["session"]], name, condition)
    return made


def _checked(path: Path, schema: str, faults: list[str]) -> Content | None:
    """Return the content of a file, None if it has faults; add those to `faults`."""
    try:
        content = yaml_files.read(path)
    except InputError as error:
        faults.append(str(error))
        return None
    found = schema_faults(content, schema, path)
    faults += found
    return None if found else content


def _names(config: Content, key: str) -> list[str]:
    """Return the well-formed names of a list; the schema reports the others."""
    names = config.get(key)
    names = names if isinstance(names, list) else []
    return [name for name in names if isinstance(name, str) and NAME.fullmatch(name)]


def _name_faults(where: str, name: str, file: Path) -> Iterator[str]:
    if name in RESERVED:
        yield f"{where}: expected none of {RESERVED}, found {name!r}; rename it"
    elif not file.is_file():
        there = sorted(path.stem for path in file.parent.glob("*.yaml"))
        close = difflib.get_close_matches(name, there, n=1)
        advice = f"did you mean {close[0]!r}?" if close else "correct the name"
        yield f"{where}: expected a file {file}, found {there}; {advice}"


def schema_faults(content: Content, schema: str, file: StrPath) -> list[str]:
    """Return what a schema finds wrong, one line each: `file: key: expected ..., found ...`.

    `schema` is the name of a file in workflow/schemas/, without `.schema.yaml`.
    """
    errors = _validator(schema).iter_errors(content)
    return [
        f"{file}: {line}"
        for error in sorted(errors, key=lambda e: [str(at) for at in e.absolute_path])
        for line in _lines(error)
    ]


def _rules(schema: str) -> Content:
    """Read a schema by libyaml, which is many times as fast as `yaml_files`.

    Hostile nesting would kill it: only for files of the project itself.
    """
    text = (SCHEMAS / f"{schema}.schema.yaml").read_text(encoding="utf-8")
    return yaml.load(text, Loader=yaml.CSafeLoader)


@functools.cache
def _validator(schema: str) -> jsonschema.protocols.Validator:
    """Return the validator of a kind of file; made once, as reading takes longer than checking."""
    rules = _rules(schema)
    if schema == "session":
        steps = _rules("config")
        rules["properties"]["override"] = _overridable(steps)
        rules["$defs"] = steps["$defs"] | rules["$defs"]
    elif schema == "config":
        condition = rules["properties"]["conditions"]["additionalProperties"]["properties"]
        condition["override"] = _overridable(rules)
        virtual = _rules("session")["properties"]["virtual"]
        condition["set"]["properties"] = virtual["properties"]
        condition["vary"]["properties"] = {
            key: {"type": "array", "minItems": 1, "items": value}
            for key, value in virtual["properties"].items()
        }
    return VALIDATOR(rules)


def _overridable(steps: Content) -> Content:
    """Return the schema of `override`: step blocks without required keys, and some of the lists."""
    blocks = {
        key: {name: value for name, value in block.items() if name != "required"}
        for key, block in steps["properties"].items()
        if block.get("type") == "object" and key != "conditions"
    }
    lists = ("models", "calibrations", "take_calibrations", "fusions", "compared_fusions")
    more = ("export_stages", "take_figures")
    blocks |= {key: steps["properties"][key] for key in (*lists, *more)}
    return {"type": "object", "additionalProperties": False, "properties": blocks}


def _lines(error: Any) -> Iterator[str]:  # of jsonschema, whose types leave all values open
    where = ".".join(_plain(str(part)) for part in error.absolute_path) or "top level"
    if error.validator in ("additionalProperties", "propertyNames") and isinstance(
        error.instance, dict
    ):
        yield from _key_lines(error, where)
    elif error.validator == "required":
        missing = [key for key in error.validator_value if key not in error.instance]
        yield f"{where}: expected the key {error.message.split(' ')[0]}, missing {missing}; add it"
    elif error.validator in ("oneOf", "anyOf"):
        expected = error.schema.get("description", "another form")
        yield f"{where}: expected {expected}, found {_shown(error.instance)}"
    else:
        hint = error.schema.get("description")
        wanted = f"{_wanted(error)} ({hint})" if hint else _wanted(error)
        yield f"{where}: expected {wanted}, found {_shown(error.instance)}"


def _key_lines(error: Any, where: str) -> Iterator[str]:
    known = list(error.schema.get("properties", {})) if isinstance(error.schema, dict) else []
    if error.validator == "propertyNames" or not known:
        yield (
            f"{where}: expected names of {error.schema.get('description', 'a fixed form')}, "
            f"{error.message}"
        )
        return
    for key in error.instance:
        if key not in known:
            close = difflib.get_close_matches(key, known, n=1)
            advice = f"did you mean {close[0]!r}?" if close else "remove it"
            if key in REPLACED:
                yield f"{where}: expected no key {key!r} any more, found it; {REPLACED[key]}"
                continue
            yield f"{where}: expected keys of {known}, found {key!r}; {advice}"


def _wanted(error: Any) -> str:
    words = {
        "type": "a value of type {}",
        "enum": "one of {}",
        "minimum": "at least {}",
        "maximum": "at most {}",
        "exclusiveMinimum": "more than {}",
        "exclusiveMaximum": "less than {}",
        "pattern": "text that matches {}",
        "minItems": "at least {} entries",
        "maxItems": "at most {} entries",
        "minProperties": "at least {} entries",
        "multipleOf": "a multiple of {}",
        "uniqueItems": "entries that differ",
    }
    return words.get(error.validator, error.validator + " {}").format(error.validator_value)


def _plain(text: str) -> str:
    """Return a text as it is, or quoted if it would break the line."""
    return text if text.isprintable() else repr(text)


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


def _model_faults(
    folder: Path, name: str, entry: Content, known: dict[str, Artefact] | None
) -> Iterator[str]:
    file = folder / "models.yaml"
    if not (folder / "skeletons" / f"{entry['skeleton']}.yaml").is_file():
        there = sorted(path.stem for path in (folder / "skeletons").glob("*.yaml"))
        yield f"{file}: {name}.skeleton: expected one of {there}, found {entry['skeleton']!r}"
    if (entry["decoder"] == "heatmaps") != ("input" in entry):
        yield f"{file}: {name}.input: expected for heat-map networks and only there"
    for part in ("detector", "landmarks"):
        if known is None:
            return
        source = entry[part]
        members = known[source["artefact"]].members if source["artefact"] in known else {}
        if members.get(source["member"]) != source["sha256"]:
            yield (
                f"{file}: {name}.{part}: expected a member of external.yaml with its checksum, "
                f"found {_shown(source['artefact'])}: {_shown(source['member'])}"
            )
