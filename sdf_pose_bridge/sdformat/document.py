# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""One SDFormat file as it was read, and how to read values from its elements."""

from collections.abc import Mapping
import re
from types import MappingProxyType
from typing import NamedTuple
from typing import TypeAlias

from lxml import etree

from sdf_pose_bridge.errors import SdfWarning

XmlElement: TypeAlias = etree._Element  # noqa: SLF001  # lxml has no public name for it

_COMMENT: object = etree.Comment

WHITE_SPACE = ' \t\n\r\f\v'
"""ASCII white space; SDFormat knows no other, so a no-break space is part of a name."""

_WHITE_SPACE_RUN = re.compile(r'[ \t\n\r\f\v]+')


class Document(NamedTuple):
    """One file as it was read."""

    path: str
    """The path that it was opened by."""
    root: XmlElement
    """The ``sdf`` element."""
    version: str
    """Value of its ``version`` attribute, as written."""
    warnings: tuple[SdfWarning, ...] = ()
    """What is wrong with its XML, but does not stand in the way."""
    origins: Mapping[XmlElement, 'Document'] = MappingProxyType({})
    """For what was put into its tree from elsewhere: the file that it stands in."""
    may_hold_separators: bool = True
    """False if it is certain that no name in it holds ``::``."""

    def origin(self, element: XmlElement) -> 'Document':
        """
        Tell which file an element stands in.

        :param element: any element of the tree.
        :return: this file, or the one that the element was put in from.
        """
        if self.origins:
            for holder in (element, *element.iterancestors()):
                if holder in self.origins:
                    return self.origins[holder]
        return self


def is_data(element: XmlElement) -> bool:
    """
    Tell whether SDFormat reads an element at all.

    :param element: any element of a tree.
    :return: false for what stands in a plugin or in an element of another namespace.
    """
    while element is not None:
        tag = str(element.tag)
        if tag == 'plugin' or ':' in tag:
            return False
        element = element.getparent()  # type: ignore[assignment]  # None ends the loop
    return True


def text_of(element: XmlElement) -> str:
    """
    Return an element's first run of character data, which is all that SDFormat reads of it.

    A comment before it is passed over; a comment or an element inside it cuts off the rest.

    :param element: an element that holds a value.
    :return: the text, not stripped; empty where there is none.
    """
    text = element.text
    if text is not None and not text.isspace():
        return text
    for child in element:
        if child.tag is not _COMMENT:
            break
        tail = child.tail
        if tail is not None and not tail.isspace():
            return tail
    return ''


def value_of(element: XmlElement) -> str:
    """
    Return an element's text, with every run of white space in it as one blank and none around.

    :param element: an element that holds a single value, such as a name.
    :return: its text.
    """
    return value_from_text(text_of(element))


def value_from_text(text: str) -> str:
    """
    Return text with every run of white space in it as one blank and none around.

    :param text: text of an element that holds a single value.
    :return: the value.
    """
    return _WHITE_SPACE_RUN.sub(' ', text).strip(' ')


def boolean_from_text(text: str) -> bool | None:
    """
    Read a boolean as SDFormat does.

    :param text: the value, with or without white space around it.
    :return: its truth, or None if it is neither ``true``, ``false``, ``1`` nor ``0`` in any case.
    """
    value = text.strip(WHITE_SPACE).lower()
    if value in ('true', '1'):
        return True
    if value in ('false', '0'):
        return False
    return None


def set_line(element: XmlElement, line: int | None) -> None:
    """
    Say that an element stands in another line.

    :param element: an element of a tree.
    :param line: the line; None leaves it.
    """
    if line is not None:
        element.sourceline = line  # type: ignore[misc]  # which lxml's stubs take for read-only

