# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read values from XML elements as SDFormat does.

libsdformat reads XML with TinyXML-2, which knows prefixes but no namespaces. Elements with a
prefix and the content of a ``<plugin>`` are not SDFormat, and are not read.
"""

from __future__ import annotations

from collections.abc import Iterator
import copy
from itertools import chain
import re
from typing import TypeAlias

from lxml import etree

from sdf_pose_bridge.printed_text import shortened

XmlElement: TypeAlias = etree._Element  # noqa: SLF001  # lxml has no public name for it

WHITE_SPACE = ' \t\n\r\f\v'
"""White space in texts. SDFormat has no other, so a no-break space is part of a name."""

_WORD = re.compile(f'[^{WHITE_SPACE}]+')
_COMMENT: object = etree.Comment


def copy_of(xml: XmlElement) -> XmlElement:
    """Copy an element with its content, without the text behind it."""
    # lxml also copies the text behind the element, which has no meaning and can be longer.
    xml.tail = None
    return copy.deepcopy(xml)


def child_elements(xml: XmlElement, *tags: str) -> Iterator[XmlElement]:
    """Iterate over the child elements with one of some tags, or all, without comments."""
    return xml.iterchildren(*tags) if tags else xml.iterchildren(etree.Element)


def first_child(xml: XmlElement, tag: str) -> XmlElement | None:
    """Return the first child element with a tag, or None."""
    # For the few children that most elements have, this is faster than iterchildren.
    for child in xml:
        if child.tag == tag:
            return child
    return None


def first_children(xml: XmlElement) -> dict[object, XmlElement]:
    """Return the first child element with each tag."""
    return {child.tag: child for child in reversed(xml)}


def written_tag(xml: XmlElement) -> str:
    """Return the tag of an element as it is written, with its prefix."""
    # Only "xml" is a prefix for lxml, as name spaces are removed from texts.
    return f'{xml.prefix}:{etree.QName(xml).localname}' if xml.prefix else str(xml.tag)


def is_foreign(xml: XmlElement) -> bool:
    """Return whether an element is not SDFormat: in a ``<plugin>``, or with a prefix."""
    return any(map(is_foreign_itself, with_ancestors(xml)))


def is_foreign_itself(xml: XmlElement) -> bool:
    """Return whether an element is a ``<plugin>``, or has a prefix."""
    return xml.tag == 'plugin' or ':' in written_tag(xml)


def with_ancestors(xml: XmlElement) -> Iterator[XmlElement]:
    """Iterate over an element and its ancestors, from itself to the outermost."""
    return chain([xml], xml.iterancestors())


def text_of(xml: XmlElement) -> str:
    """
    Return the text that is the value of an element.

    The value is the first run of character data. Comments before it are skipped. A comment, a
    border of CDATA or an element in it ends it.

    :return: the text, stripped; empty if there is none.
    """
    text = (xml.text or '').strip(WHITE_SPACE)
    for child in () if text else xml:
        if text or child.tag is not _COMMENT:
            break
        text = (child.tail or '').strip(WHITE_SPACE)
    return text


def value_of(xml: XmlElement) -> str:
    """Return the text of an element, stripped, with each run of white space as one blank."""
    text = text_of(xml)
    # Most values are plain names, which are recognized faster.
    return text if text.isidentifier() else ' '.join(words_of(text))


def words_of(text: str) -> list[str]:
    """Split a text at white space, of which SDFormat has less than Python."""
    # XML has no other ASCII white space, and split is faster.
    return text.split() if text.isascii() else _WORD.findall(text)


def child_at(parent: XmlElement, path: str) -> XmlElement | None:
    """
    Return a child element, or a child of a child; None if there is none.

    :param path: its tags, such as ``mass`` or ``limit/lower``; of each, the first child counts.
    """
    xml: XmlElement | None = parent
    for tag in path.split('/'):
        xml = None if xml is None else first_child(xml, tag)
    return xml


def value_at(parent: XmlElement, path: str, default: str = '') -> str:
    """
    Return :func:`value_of` a child element, or of a child of a child.

    :param path: as for :func:`child_at`.
    :param default: the value if there is no such element.
    """
    xml = child_at(parent, path)
    return default if xml is None else value_of(xml)


def attribute_of(xml: XmlElement, name: str) -> str:
    """Return the value of an attribute, stripped as by ``sdf::trim``; empty if there is none."""
    return xml.get(name, '').strip(' \t\n')


def described(xml: XmlElement) -> str:
    """Return an element as one step of a path, such as ``link[@name="l"]``."""
    return path_step(written_tag(xml), attribute_of(xml, 'name'))


def path_step(tag: str, name: str) -> str:
    """Return one step of the path of an element, with its name, shortened, if it has one."""
    tag = shortened(tag)
    return f'{tag}[@name="{shortened(name)}"]' if name else tag
