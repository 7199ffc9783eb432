"""Check YAML files against JSON schemas, with one line for each fault."""

import copy
import functools
import sys
from collections.abc import Iterator
from datetime import date
from pathlib import Path
from typing import Any

import yaml

from courtside.study.configuration import yaml_files
from courtside.study.configuration.yaml_files import Content
from courtside.study.errors import InputError, StrPath, nearest

SCHEMAS = Path(__file__).parents[4] / "schemas"
# JSON Schema lets 3.0 pass for an integer, and a comparison lets nan pass for any number.
TYPES = {
    "integer": lambda _, value: isinstance(value, int) and not isinstance(value, bool),
    "number": lambda _, value: (
        isinstance(value, int | float)
        and not isinstance(value, bool)
        and abs(value) <= sys.float_info.max
    ),
}
WORDS = {  # of types, as people call them
    "object": "keys and values",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "nothing",
}
# Steps that name their sessions or takes themselves: no session changes them for itself.
OF_STUDY = (
    *("export_overlay_video", "evaluate_racket", "evaluate_round_trip", "evaluate_networks"),
    *("draw_badminton_fig05", "draw_stroke", "draw_three_cameras", "draw_thesis_fig3"),
    *("compare_networks", "compare_sessions", "conditions"),
)
# Schemas that use the `$defs` of another one, too.
SHARED = dict.fromkeys(("external", "models", "plan", "session"), "config")
SHARED |= {"detectors": "models"}
MEANT = {  # keys by other words for them
    **dict.fromkeys(("weight", "weight_kg", "mass"), "mass_kg"),
    **dict.fromkeys(("fps", "rate", "frame_rate"), "rate_hz"),
    "gender": "sex",
    "calib": "calibration",
}
REPLACED = {  # keys of former versions: what to use now
    "measure_kinematics": "remove it: kinematics are measured on the exported skeletons, whose "
    "filter and cut-offs are those of filter_motion"
}


def read(path: StrPath, schema: str) -> Content:
    """Read a YAML file that a schema describes; an `InputError` has every fault, one line each."""
    content = yaml_files.read(path)
    found = faults(content, schema, path)
    if found:
        raise InputError(*found)
    return content


def faults(content: Content, schema: str, file: StrPath) -> list[str]:
    """Return the faults that a schema finds, one line each: `file: key: expected ..., found ...`.

    `schema` is the name of a file in workflow/schemas/, without `.schema.yaml`.
    """
    errors = _validator(schema).iter_errors(content)
    return [
        f"{file}: {line}"
        for error in sorted(errors, key=lambda e: [str(at) for at in e.absolute_path])
        for line in _lines(error)
    ]


@functools.cache
def _rules(schema: str) -> Content:
    """Read a schema by libyaml, which is many times as fast as `yaml_files`.

    Hostile nesting would kill it: only for files of the project itself.
    """
    text = (SCHEMAS / f"{schema}.schema.yaml").read_text(encoding="utf-8")
    return yaml.load(text, Loader=yaml.CSafeLoader)


def _definitions(schema: str) -> Content:
    """Return the `$defs` of a schema and, below them, those of the schema whose it shares."""
    other, own = SHARED.get(schema), _rules(schema).get("$defs", {})
    return (_definitions(other) if other else {}) | own


@functools.cache
def _validator(schema: str) -> Any:
    """Return the validator of a kind of file; made once, as reading takes longer than checking."""
    import jsonschema  # 0.08 s, which jobs that read no such file save

    plain = jsonschema.Draft202012Validator
    types = plain.TYPE_CHECKER.redefine_many(TYPES)
    validator = jsonschema.validators.extend(plain, type_checker=types)
    rules = copy.deepcopy(_rules(schema))
    rules["$defs"] = _definitions(schema)
    if schema == "session":
        rules["properties"]["override"] = _overridable(_rules("config"))
    elif schema == "config":
        condition = rules["properties"]["conditions"]["additionalProperties"]["properties"]
        condition["override"] = _overridable(rules)
        virtual = _rules("session")["properties"]["virtual"]
        condition["set"]["properties"] = virtual["properties"]
        condition["vary"]["properties"] = {
            key: {"type": "array", "minItems": 1, "items": value}
            for key, value in virtual["properties"].items()
        }
    return validator(rules)


def _overridable(steps: Content) -> Content:
    """Return the schema of `override`: blocks of steps without required keys, and some lists."""
    blocks = {
        key: _partial(block, steps["$defs"])
        for key, block in steps["properties"].items()
        if block.get("type") == "object" and key not in OF_STUDY
    }
    lists = ("models", "calibrations", "take_calibrations", "fusions", "compared_fusions")
    more = ("export_stages", "take_figures")
    blocks |= {key: steps["properties"][key] for key in (*lists, *more)}
    return {"type": "object", "additionalProperties": False, "properties": blocks}


def _partial(rules: Content, definitions: Content) -> Content:
    """Return the rules of a table without its required keys, nor those of tables inside it."""
    found = definitions.get(rules.get("$ref", "").rpartition("/")[2], rules)
    if found.get("type") != "object":
        return rules
    optional = {key: value for key, value in found.items() if key != "required"}
    inside = {
        key: _partial(value, definitions) for key, value in found.get("properties", {}).items()
    }
    return optional | ({"properties": inside} if inside else {})


def _lines(error: Any) -> Iterator[str]:  # of jsonschema, whose types leave all values open
    parts = map(str, error.absolute_path)
    # Quoted where it would break the line.
    where = ".".join(p if p.isprintable() else repr(p) for p in parts) or "top level"
    if error.validator in ("additionalProperties", "propertyNames") and isinstance(
        error.instance, dict
    ):
        yield from _key_lines(error, where)
    elif error.validator == "required":
        missing = [key for key in error.validator_value if key not in error.instance]
        yield f"{where}: expected the key {error.message.split(' ')[0]}, missing {missing}; add it"
    elif error.validator in ("oneOf", "anyOf"):
        expected = error.schema.get("description", "another form")
        yield f"{where}: expected {expected}, found {shortened(error.instance)}"
    else:
        wanted = _wanted(error)
        if hint := error.schema.get("description"):
            wanted = hint if error.validator == "pattern" else f"{wanted} ({hint})"
        found = shortened(error.instance)
        if error.validator == "uniqueItems":
            values = error.instance
            twice = next(value for at, value in enumerate(values) if value in values[:at])
            found = f"{shortened(twice)} again"
        if error.validator == "type" and _is_unquoted(error.instance, error.validator_value):
            found += "; put it in quotes"
        if error.validator == "enum" and isinstance(error.instance, str):
            known = [one for one in error.validator_value if isinstance(one, str)]
            advice = nearest(error.instance, known, "")
            found += f"; {advice}" * bool(advice)
        yield f"{where}: expected {wanted}, found {found}"


def _is_unquoted(value: object, kinds: str | list[str]) -> bool:
    """Tell whether text was expected where YAML read a number, a date, or yes and no."""
    return "string" in kinds and isinstance(value, int | float | date)


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
            if key in REPLACED:
                yield f"{where}: expected no key {key!r} any more, found it; {REPLACED[key]}"
                continue
            meant = MEANT.get(key, key)
            advice = nearest(meant if meant in known else key, known, "remove it")
            yield f"{where}: expected keys of {known}, found {key!r}; {advice}"


def _wanted(error: Any) -> str:
    words = {
        "enum": "one of {}",
        "minimum": "at least {}",
        "maximum": "at most {}",
        "exclusiveMinimum": "more than {}",
        "exclusiveMaximum": "less than {}",
        "pattern": "text that matches {}",
        "minItems": "at least {} entries",
        "maxItems": "at most {} entries",
        "minProperties": "at least {} entries",
        "maxProperties": "at most {} entries",
        "multipleOf": "a multiple of {}",
        "uniqueItems": "entries that differ",
    }
    value = error.validator_value
    if error.validator == "type":
        kinds = [value] if isinstance(value, str) else value
        return " or ".join(WORDS[kind] for kind in kinds)
    return words.get(error.validator, error.validator + " {}").format(value)


def shortened(value: object) -> str:
    """Return a value as at most 80 characters of a line."""
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."
