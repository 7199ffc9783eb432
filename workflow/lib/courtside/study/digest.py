"""A digest of the code that a rule runs, so that editing a library module reruns what uses it.

Snakemake notices a changed script, but not a changed module that the script imports.
"""

import ast
import hashlib
from functools import cache
from pathlib import Path

from courtside.study.errors import InputError

PACKAGE = "courtside"
# Fields that differ between Python versions, or say where a node stands, not what it does.
IGNORED = {"ctx", "kind", "type_comment", "type_ignores", "type_params"}


def code_digest(script, library):
    """Return the digest of a script and of every library module it reaches, 64 hexadecimal digits.

    Parameters
    ----------
    script : str or Path
    library : str or Path
        The folder that holds the package `courtside`.

    Returns
    -------
    digest : str
        Changes with the syntax trees, not with comments, docstrings or formatting.

    Raises
    ------
    InputError
        If a file has a syntax error.
    """
    parts = [_parsed(Path(script))[0]]
    parts += [
        _parsed(_file(name, Path(library)))[0] for name in sorted(modules_of(script, library))
    ]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def modules_of(script, library):
    """Return the names of all library modules that a file imports, directly or through one another.

    Parameters
    ----------
    script : str or Path
    library : str or Path
        The folder that holds the package `courtside`.

    Returns
    -------
    names : set of str
        Full names, packages included.
    """
    library = Path(library)
    found, waiting = set(), [Path(script)]
    while waiting:
        for name in _parsed(waiting.pop())[1]:
            for reached in _with_parents(name):
                file = _file(reached, library)
                if file is not None and reached not in found:
                    found.add(reached)
                    waiting.append(file)
    return found


def _with_parents(name):
    parts = name.split(".")
    return [".".join(parts[: at + 1]) for at in range(len(parts))]


def _file(name, library):
    """Return the file of a module, None for a name that is not a module (a function, say)."""
    base = library.joinpath(*name.split("."))
    for file in (base.with_suffix(".py"), base / "__init__.py"):
        if file.is_file():
            return file
    return None


@cache
def _parsed(path):
    """Return (tree as text, names imported from the package) of a file."""
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
    except SyntaxError as error:
        raise InputError(
            f"{path}: expected Python, found a syntax error in line {error.lineno}: {error.msg}"
        ) from None
    return _text(tree), tuple(_imports(tree))


def _imports(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from (name for name in names if name.split(".")[0] == PACKAGE)


def _text(node):
    if isinstance(node, list):
        return "[" + ",".join(_text(item) for item in node) + "]"
    if not isinstance(node, ast.AST):
        return repr(node)
    fields = []
    for name, value in ast.iter_fields(node):
        if name == "body" and isinstance(value, list):
            value = [item for item in value if not _is_text(item)]
        if name not in IGNORED and value is not None and value != []:
            fields.append(f"{name}={_text(value)}")
    return f"{type(node).__name__}({','.join(fields)})"


def _is_text(node):
    """Tell docstrings, and other statements that are only a string."""
    return isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)
