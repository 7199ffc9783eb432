"""All numbers of the documents: one function for each table of the register."""

from pathlib import Path

from courtside.evaluation.numbers import (
    calibration,
    devices,
    footage,
    markers,
    networks,
    players,
    published,
    register,
    stated,
)
from courtside.evaluation.numbers.register import Number, Source
from courtside.evaluation.numbers.views import VIEWS
from courtside.study.errors import InputError, StrPath

REGISTER = "docs/numbers.csv"
DOCUMENTS = ("README.md", "docs/measured.md")
MEASURED = (  # of the results of a default run
    calibration.calibrations,
    calibration.ways,
    calibration.growth,
    calibration.strengths,
    calibration.capture,
    players.sessions,
    players.takes,
    players.angles,
    players.measures,
    players.held,
    footage.corrections,
    footage.joints,
    footage.views,
    networks.virtual,
    published.walk,
    published.racket,
    published.round_trip,
    devices.sources,
    devices.body_frames,
)


def numbers(results: StrPath, repository: StrPath) -> list[Number]:
    """Return all numbers, of the results of a full default run and of the repository's tables.

    An `InputError` names the first file that the results lack.
    """
    source, documents = Source(results), Source(repository)
    if not source.folder.is_dir():
        raise InputError(f"{results}: expected a folder of results, found none; run snakemake")
    found = [number for table in MEASURED for number in table(source)]
    return [*found, *published.table_1(documents), *stated.numbers(documents)]


def kept(repository: StrPath) -> list[Number]:
    """Return all numbers as the repository keeps them: those of the register, then stated ones."""
    return [*register.read(Path(repository) / REGISTER), *stated.numbers(Source(repository))]


def write(numbers_: list[Number], repository: StrPath) -> list[str]:
    """Write the register and the tables of the documents; return the files that changed.

    The register keeps what is not stated: each number stands in one file.
    """
    changed = []
    path = Path(repository) / REGISTER
    before = path.read_text(encoding="utf-8") if path.is_file() else ""
    register.write(path, [one for one in numbers_ if not one.source.startswith(stated.FOLDER)])
    changed += [REGISTER] if path.read_text(encoding="utf-8") != before else []
    for name, text in filled(kept(repository), repository).items():
        document = Path(repository) / name
        if document.read_text(encoding="utf-8") != text:
            document.write_text(text, encoding="utf-8", newline="\n")
            changed.append(name)
    return changed


def filled(numbers_: list[Number], repository: StrPath) -> dict[str, str]:
    """Return the documents with their tables of these numbers, by the documents' names."""
    texts = {name: (Path(repository) / name).read_text(encoding="utf-8") for name in DOCUMENTS}
    return {name: markers.fill(text, VIEWS, numbers_) for name, text in texts.items()}


def report(results: StrPath, repository: StrPath) -> list[str]:
    """Return a line for every number of the register that these results do not give any more."""
    return register.stale(kept(repository), numbers(results, repository))
