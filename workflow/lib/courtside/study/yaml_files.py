"""YAML files without YAML's surprises: no duplicate keys, names stay text."""

from pathlib import Path

import yaml

from courtside.study.errors import InputError


class _StrictLoader(yaml.SafeLoader):
    """A safe loader that refuses a key given twice."""

    def construct_mapping(self, node, deep=False):
        """Build a dictionary; raise where a key repeats or is not text."""
        seen = set()
        for key_node, _ in node.value:
            if key_node.tag == "tag:yaml.org,2002:merge":
                continue
            key = self.construct_object(key_node, deep=True)
            line = key_node.start_mark.line + 1
            if not isinstance(key, str):
                raise yaml.constructor.ConstructorError(
                    problem=f"line {line}: expected a name, found {key!r}; put it in quotes"
                )
            if key in seen:
                raise yaml.constructor.ConstructorError(
                    problem=f"line {line}: expected each key once, found {key!r} again"
                )
            seen.add(key)
        return super().construct_mapping(node, deep)


def read(path):
    """Read a YAML file that holds a mapping.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    content : dict

    Raises
    ------
    InputError
        One line with the line number of what is wrong.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
        content = yaml.load(text, Loader=_StrictLoader)  # a subclass of SafeLoader
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: expected a readable YAML file, found: {error}") from None
    except yaml.YAMLError as error:
        raise InputError(f"{path}: {_one_line(error)}") from None
    except RecursionError:
        raise InputError(f"{path}: expected YAML, found too deep nesting") from None
    except (ValueError, LookupError, AttributeError) as error:
        # PyYAML lets these through for 2026-02-30, or for !!int without a number.
        raise InputError(f"{path}: expected dates and numbers that exist, found: {error}") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected keys and values, found {type(content).__name__}")
    return content


def _one_line(error):
    mark = getattr(error, "problem_mark", None)
    where = f"line {mark.line + 1}: " if mark else ""
    problem = getattr(error, "problem", None) or str(error).splitlines()[0]
    return f"{where}{problem}"
