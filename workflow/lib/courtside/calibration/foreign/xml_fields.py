"""XML of other programs, parsed without what can harm, and its numbers."""

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from courtside.geometry import camera_fields
from courtside.study.errors import InputError, reading


def parse(path: Path, text: str) -> ElementTree.Element:
    """Return the root of an XML text; raise `InputError` if it is damaged or declares entities."""
    if re.search(r"<!\s*(DOCTYPE|ENTITY)", text, re.IGNORECASE):
        raise InputError(f"{path}: expected plain XML, found a DOCTYPE or ENTITY; export it again")
    with reading(path, "XML", camera_fields.EXPORT_AGAIN):  # its ParseError is a SyntaxError
        return ElementTree.fromstring(text)


def attributes(where: str, element: ElementTree.Element, tag: str, keys: str) -> NDArray:
    """Return the attributes `keys`, parted by spaces, of a child as numbers (K,).

    Raises `InputError` that begins with `where` if one is missing or no number.
    """
    child = element.find(tag)
    found = {} if child is None else child.attrib
    return np.array(
        [camera_fields.numbers(where, f"{tag} {key}", found.get(key), ()) for key in keys.split()]
    )


def row(where: str, element: ElementTree.Element, key: str, count: int) -> NDArray:
    """Return an attribute that holds `count` numbers parted by spaces, (count,)."""
    value = element.get(key)
    return camera_fields.numbers(where, key, None if value is None else value.split(), (count,))
