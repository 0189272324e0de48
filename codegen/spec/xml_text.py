"""XML of an unknown origin as a tree of elements, and the exact numbers in it.

Document types, entities and external references are refused by defusedxml, so that no text grows without bound and no
other file is read.
"""

from __future__ import annotations

import re
from fractions import Fraction
from xml.etree.ElementTree import Element, ParseError

from codegen.errors import Mistake, SpecificationError
from codegen.spec.imported import REMEDY

DEEPEST = 400
"""Elements inside each other; programs that recurse over them stand this much."""

LEAST, GREATEST = 1e-30, 1e30
"""Sizes within which numbers are taken, besides 0."""

_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]{1,3})?")


def read_xml(text: str | bytes, place: str) -> Element:
    """Read XML.

    Args:
        text: the file.
        place: its name, for messages.

    Raises:
        SpecificationError: it is not well-formed, declares entities, is nested too deeply, or defusedxml is missing.
    """
    try:
        from defusedxml import DefusedXmlException
        from defusedxml.ElementTree import fromstring
    except ImportError:
        what = "XML files are read with defusedxml, which is not installed"
        raise SpecificationError([Mistake(place, what, REMEDY)]) from None
    try:
        root: Element = fromstring(text, forbid_dtd=True)
    except DefusedXmlException:
        what = "declares a document type or entities, which may make any file of it"
        raise SpecificationError([Mistake(place, what, "take <!DOCTYPE ...> out")]) from None
    except ParseError as error:
        raise SpecificationError([Mistake(place, f"is no XML: {error}", "mend the file there")]) from None
    except (ValueError, LookupError):
        raise SpecificationError([Mistake(place, "is no text in its encoding", "save it as UTF-8")]) from None
    if depth(root) > DEEPEST:
        what = f"has elements more than {DEEPEST} deep"
        raise SpecificationError([Mistake(place, what, "divide the mechanism")])
    return root


def depth(root: Element) -> int:
    """Elements inside each other, at most; found without recursion."""
    level, below = [root], 0
    while level:
        below += 1
        level = [child for element in level for child in element]
    return below


def tag(element: Element) -> str:
    """Name of an element, without the address of its name space."""
    return element.tag.rpartition("}")[2]


def number(word: str) -> Fraction | None:
    """The exact value of a decimal; None if it is none, or neither 0 nor between `LEAST` and `GREATEST`."""
    if len(word) > 100 or not _NUMBER.fullmatch(word):
        return None
    size = abs(float(word))
    return Fraction(word) if size == 0 or LEAST <= size <= GREATEST else None


def numbers(text: str, count: int) -> tuple[Fraction, ...] | None:
    """A list of so many decimals, set apart by white space; None if it is none."""
    values = [number(word) for word in text.split()[: count + 1]]
    exact = tuple(value for value in values if value is not None)
    return exact if len(exact) == len(values) == count else None


def shortest(value: float) -> Fraction:
    """The shortest decimal that is read as this double: what stands in the file, if that has up to 15 digits."""
    return Fraction(repr(float(value)))
