"""Log files of scripts, and the form of their errors."""

import logging
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import TypeVar

from courtside.study.errors import InputError, StrPath
from courtside.study.execution import machine_resources

FORMAT = "%(asctime)s %(levelname)s %(message)s"
T = TypeVar("T")
logger = logging.getLogger("courtside")


def to_file(path: StrPath) -> None:
    """Send messages, warnings and errors of this process to a job's log file.

    An `InputError` that nothing catches becomes one line, and so does a full disk, a file that may
    not be written, or too little memory; any other error keeps its traceback. An error that cannot
    be written to the log, because its disk is full too, goes to standard error.
    """
    sys.excepthook = _log_exception
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    handlers = [_LogFile(path, mode="w")]
    logging.basicConfig(handlers=handlers, level=logging.INFO, format=FORMAT, force=True)
    logging.captureWarnings(True)


class _LogFile(logging.FileHandler):
    def handleError(self, record: logging.LogRecord) -> None:
        if record.levelno >= logging.ERROR:
            print(self.format(record), file=sys.stderr)


def tell(warning: str, path: StrPath) -> None:
    """Log a warning, and show it on the terminal at once: a run may go on for an hour after it.

    `path` is the file that holds it, or explains it, and more.
    """
    logger.warning("%s", warning)
    print(f"Warning: {warning}; see {path}", file=sys.stderr, flush=True)


@contextmanager
def told_once() -> Iterator[None]:
    """Within the block, log a message only if it was not logged there before, word by word."""
    told: set[str] = set()

    def is_new(record: logging.LogRecord) -> bool:
        line = record.getMessage()
        found = line not in told
        told.add(line)
        return found

    logger.addFilter(is_new)
    try:
        yield
    finally:
        logger.removeFilter(is_new)


def _log_exception(
    kind: type[BaseException], error: BaseException, trace: TracebackType | None
) -> None:
    line = str(error) if issubclass(kind, InputError) else machine_resources.in_words(error)
    if line is not None:
        logger.error("%s", line)
    else:
        logger.critical("unexpected error", exc_info=(kind, error, trace))


def progress(items: Iterable[T], total: int | None, what: str, every_s: float = 5.0) -> Iterator[T]:
    """Pass items through and report progress, in the log and on a terminal.

    `total` is how many are expected, None where that is unknown; `what` is what is counted, with
    its owner: "cam_01: frames"; `every_s` are seconds between two messages.
    """
    start = last = time.monotonic()
    count = 0
    for count, item in enumerate(items, start=1):
        yield item
        now = time.monotonic()
        if now - last >= every_s:
            last = now
            _say(what, count, total, now - start)
    _say(what, count, total, time.monotonic() - start)


def _say(what: str, count: int, total: int | None, elapsed_s: float) -> None:
    rate = count / elapsed_s if elapsed_s > 0 else 0.0
    of = f" of {total}" if total else ""
    message = f"{what}: {count}{of}, {rate:.1f} per second"
    logger.info("%s", message)
    if sys.stderr.isatty():
        print(message, file=sys.stderr)
