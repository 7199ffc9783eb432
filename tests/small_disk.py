"""A disk that refuses long files: by a limit of this process, which needs no rights."""

import contextlib
import resource


@contextlib.contextmanager
def limited_to(n_bytes):
    """Refuse files of this process that grow beyond `n_bytes`, as a full disk does."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (n_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
