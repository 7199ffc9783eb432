"""The error that a user can mend."""


class InputError(ValueError):
    """Something the user gave is wrong; its message is one line, shown without a traceback.

    The message names the file, camera or take, what was expected, what was found, and what to do.
    """
