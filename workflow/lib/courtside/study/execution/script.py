"""Run a script from its rule: the names in the rule are the argument names of `main`."""

import inspect
from collections.abc import Callable, Iterator
from typing import Any

from courtside.study.execution import log

IGNORED = ("code", "pin")  # parameters that only tell Snakemake when, or whether, to run a job


def run(main: Callable[..., None], job: Any) -> None:
    """Open the log of a job (Snakemake's `snakemake` object) and call its script's `main`.

    Parameters of `main` are named as the files and parameters of the rule. `paths` takes all
    inputs, `threads` the number of threads, and wildcards are given where `main` names them.
    """
    log.to_file(job.log[0])
    main(**arguments(main, job))


def arguments(main: Callable[..., None], job: Any) -> dict[str, Any]:
    """Return the arguments of `main`.

    An input that is left empty keeps the default of `main` where there is one. Files that `main`
    does not name are only for Snakemake. The parameter `step` is spread: each of its entries is an
    argument, unless `main` takes `step` itself. A `TypeError` names what two parts of the rule
    give, what `main` does not take, or what nothing gives.
    """
    every = inspect.signature(main).parameters
    taken = {name: one for name, one in every.items() if one.kind is not one.VAR_KEYWORD}
    others = len(taken) < len(every)
    found: dict[str, Any] = {}
    for name, value in _given(taken, job):
        if name in found:
            raise TypeError(f"rule {job.rule}: {name} is given twice")
        if name not in taken and not others:
            raise TypeError(f"rule {job.rule}: its script does not take {name}")
        found[name] = value
    found = {name: value for name, value in job.wildcards.items() if name in taken} | found
    missing = [
        name for name, one in taken.items() if name not in found and one.default is one.empty
    ]
    if missing:
        raise TypeError(
            f"rule {job.rule}: expected {', '.join(missing)} for its script, found none"
        )
    return found


def _given(taken: Any, job: Any) -> Iterator[tuple[str, Any]]:
    if "paths" in taken:
        yield "paths", job.input
    else:
        for name, files in job.input.items():
            if name in taken and (len(files) or taken[name].default is inspect.Parameter.empty):
                yield name, files
    yield from ((name, files) for name, files in job.output.items() if name in taken)
    for name, value in job.params.items():
        if name == "step" and name not in taken:
            yield from value.items()
        elif name not in IGNORED:
            yield name, value
    if "threads" in taken:
        yield "threads", job.threads
