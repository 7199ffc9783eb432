"""Words in the names of files, and names that a configuration accepts."""

import re
import unicodedata

WORD = re.compile(r"[A-Za-z]+[0-9]*|[0-9]+")
LETTERS = {"ß": "ss", "æ": "ae", "œ": "oe", "ø": "o", "đ": "d", "ł": "l", "þ": "th"}


def words(parts):
    """Split the names of a file and its folders into words.

    Parameters
    ----------
    parts : sequence of str
        Folders and the file without its suffix.

    Returns
    -------
    found : tuple of str
        Lower case, without accents; a number belongs to the word before it: `Cam 01-takeTwo` gives
        `cam01`, `take`, `two`.
    """
    found = []
    for part in parts:
        own = []
        for word in WORD.findall(_plain(part)):
            if word.isdigit() and own and not own[-1][-1].isdigit():
                own[-1] += word
            else:
                own.append(word)
        found += own
    return tuple(word.lower() for word in found)


def name(text, otherwise):
    """Make a name that a configuration accepts.

    Parameters
    ----------
    text : str
        Anything.
    otherwise : str
        The name of a text that holds no letter or digit of the Latin alphabet.

    Returns
    -------
    name : str
        Lower-case letters, digits and `_`, begun with a letter or digit.
    """
    return "_".join(re.findall("[a-z0-9]+", _plain(text).lower())) or otherwise


def distinct(wanted, taken):
    """Return a name, with the first number behind it that makes it differ from those taken."""
    found, number = wanted, 1
    while found in taken:
        number += 1
        found = f"{wanted}_{number}"
    return found


def alike(one, other):
    """Tell whether two words are the same but for zeros before their numbers: `cam1` and `cam01`."""
    return _unpadded(one) == _unpadded(other)


def _unpadded(word):
    return re.sub(r"(?<![0-9])0+(?=[0-9])", "", word)


def _plain(text):
    """Return a text without accents, its words in camel case apart."""
    text = "".join(LETTERS.get(letter.lower(), letter) for letter in text)
    text = unicodedata.normalize("NFKD", text)
    text = "".join(letter for letter in text if not unicodedata.combining(letter))
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
