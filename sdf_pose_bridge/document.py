# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read one SDFormat file into an XML tree, and read values from its elements.

A file is hostile until it is read: no external entities, no expansion, no network, and the depth
and the sizes that libxml2 allows without its "huge" option.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple
from typing import TypeAlias

from lxml import etree

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError

XmlElement: TypeAlias = etree._Element  # noqa: SLF001  # lxml has no public name for it

WHITE_SPACE = ' \t\n\r\f\v'
"""ASCII white space; SDFormat knows no other, so a no-break space is part of a name."""

_NAMESPACE_ERRORS = frozenset({'NS_ERR_UNDEFINED_NAMESPACE', 'NS_ERR_QNAME', 'NS_ERR_COLON'})
"""Prefixes that are not declared are common in SDF files; only lxml minds them."""


class Document(NamedTuple):
    """One file as it was read."""

    path: str
    """The path that it was opened by."""
    root: XmlElement
    """The ``sdf`` element."""
    version: str
    """Value of its ``version`` attribute, as written."""


def document_from_file(path: str | os.PathLike[str]) -> Document:
    """
    Read a file.

    :param path: path of an SDFormat file.
    :return: its tree; declared version and content are not judged here.
    :raises FileReadError: if it is missing, unreadable, not XML, or declares no version.
    :raises ParsingError: if its outermost element is not ``sdf``.
    """
    name = os.fspath(path)
    try:
        text = Path(name).read_bytes()
    except OSError as error:
        msg = f'the file cannot be read: {error.strerror or error}'
        raise FileReadError(msg, Place(name)) from error
    return document_from_text(text, name)


def document_from_text(text: bytes, path: str) -> Document:
    """
    Read the content of a file.

    :param text: XML, in the encoding that it declares.
    :param path: the name to use in errors.
    :return: as for :func:`document_from_file`.
    :raises SdfError: as for :func:`document_from_file`.
    """
    root = _root_from_text(text, path)
    tag = local_name(root)
    place = Place(path, _line(root), f'/{tag}')
    if tag == 'robot':
        msg = ('this is URDF, not SDFormat; publish it with robot_state_publisher, or convert it '
               'with "gz sdf -p" first')
        raise ParsingError(msg, place)
    if tag != 'sdf':
        msg = f'the outermost element is <{tag}>, it must be <sdf>'
        raise ParsingError(msg, place)
    version = root.get('version')
    if version is None:
        msg = '<sdf> declares no version, such as version="1.10"'
        raise FileReadError(msg, place)
    return Document(path, root, version)


def _root_from_text(text: bytes, path: str) -> XmlElement:
    parser = etree.XMLParser(
        recover=True, resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
    root: XmlElement | None = None
    failure: SdfError | None = None
    try:
        root = etree.fromstring(text, parser)
    except etree.XMLSyntaxError as error:
        failure = FileReadError(f'this is not XML: {error.msg}', Place(path, error.lineno or 0))
    for entry in parser.error_log:
        if entry.type_name not in _NAMESPACE_ERRORS:
            msg = f'this is not well-formed XML: {entry.message}'
            raise FileReadError(msg, Place(path, entry.line)) from None
    if failure is not None:
        raise failure
    if root is None:
        msg = 'this is not XML: it has no element'
        raise FileReadError(msg, Place(path))
    return root


def local_name(element: XmlElement) -> str:
    """
    Return an element's tag as SDFormat sees it, which knows no namespaces.

    :param element: any node of a tree.
    :return: the tag without a default namespace; with the prefix where one is written
        (``drake:joint``); empty for a comment or a processing instruction.
    """
    tag = element.tag
    if not isinstance(tag, str):
        return ''
    if tag[0] != '{':
        return tag
    name = tag[tag.index('}') + 1:]
    return f'{element.prefix}:{name}' if element.prefix else name


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
        if not isinstance(child, etree._Comment):
            break
        tail = child.tail
        if tail is not None and not tail.isspace():
            return tail
    return ''


def value_of(element: XmlElement) -> str:
    """
    Return an element's text without the white space around it.

    :param element: an element that holds a single value, such as a name.
    :return: its stripped text.
    """
    return text_of(element).strip(WHITE_SPACE)


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


def _line(element: XmlElement) -> int:
    return element.sourceline or 0
