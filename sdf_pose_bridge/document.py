# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read one SDFormat file into an XML tree, and read values from its elements.

A file is hostile until it is read: no external entities, no expansion, no network, and the depth
and the sizes that libxml2 allows without its "huge" option.
"""

from __future__ import annotations

from collections.abc import Mapping
import os
from pathlib import Path
import re
from types import MappingProxyType
from typing import NamedTuple
from typing import TypeAlias

from lxml import etree

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.markup import Search
from sdf_pose_bridge.names import SEPARATOR

XmlElement: TypeAlias = etree._Element  # noqa: SLF001  # lxml has no public name for it

_COMMENT: object = etree.Comment

WHITE_SPACE = ' \t\n\r\f\v'
"""ASCII white space; SDFormat knows no other, so a no-break space is part of a name."""

_NAMESPACE_ERRORS = frozenset({'NS_ERR_UNDEFINED_NAMESPACE', 'NS_ERR_QNAME', 'NS_ERR_COLON'})
"""Prefixes that are not declared are common in SDF files; only lxml minds them."""

_FORGIVEN_ERRORS = frozenset({'ERR_HYPHEN_IN_COMMENT', 'ERR_DOCUMENT_END'})
"""Two hyphens in a comment, something after the outermost element: libsdformat reads on."""

_DECLARATION_ERROR = 'ERR_RESERVED_XML_NAME'
"""A declaration that is not at the start; only white space before it is forgiven."""

_UTF_8 = frozenset({None, 'UTF-8', 'utf-8', 'ASCII', 'US-ASCII'})

_SEPARATOR = re.compile(SEPARATOR.encode())
_LONGEST_SURE_NAME = 500

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
    origins: Mapping[XmlElement, Document] = MappingProxyType({})
    """For what was put into its tree from elsewhere: the file that it stands in."""
    search: Search | None = None
    """Finds its elements in its text; None if that is not in UTF-8, or the tree has changed."""
    may_hold_separators: bool = True
    """False if it is certain that no name in it holds ``::``."""

    def origin(self, element: XmlElement) -> Document:
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


def document_from_file(path: str | os.PathLike[str]) -> Document:
    """
    Read a file.

    :param path: path of an SDFormat file.
    :return: its tree; declared version and content are not judged here.
    :raises FileReadError: if it is missing, unreadable, not XML, or declares no version.
    :raises ParsingError: if its outermost element is not ``sdf``.
    """
    name = os.fspath(path)
    return document_from_text(_bytes_from_file(name), name)


def root_from_file(path: str) -> XmlElement:
    """
    Read a file of any XML, with the same care.

    :param path: path of the file.
    :return: its outermost element.
    :raises FileReadError: if it is missing, unreadable or not XML.
    """
    return _root_from_text(_bytes_from_file(path), path)[0]


def document_from_text(text: bytes | str, path: str) -> Document:
    """
    Read the content of a file.

    :param text: XML; bytes are in the encoding that it declares.
    :param path: the name to use in errors.
    :return: as for :func:`document_from_file`.
    :raises SdfError: as for :func:`document_from_file`.
    """
    content = text.encode(errors='surrogatepass') if isinstance(text, str) else text
    search = Search(content) if content[:1] in (b'<', b' ', b'\n') else None
    # The encoding of text is known; that of bytes is whatever they declare.
    root, warnings = _root_from_text(content, path, 'utf-8' if isinstance(text, str) else None)
    tag = str(root.tag)
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
    is_utf_8 = root.getroottree().docinfo.encoding in _UTF_8
    return Document(
        path, root, version, warnings, search=search if is_utf_8 else None,
        may_hold_separators=_may_hold_separators(content))


def _bytes_from_file(path: str) -> bytes:
    try:
        return Path(path).read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte
        msg = f'the file cannot be read: {getattr(error, "strerror", None) or error}'
        raise FileReadError(msg, Place(path)) from error


def _root_from_text(
    text: bytes, path: str, encoding: str | None = None,
) -> tuple[XmlElement, tuple[SdfWarning, ...]]:
    warnings = []
    parser = etree.XMLParser(
        encoding=encoding, recover=True, resolve_entities=False, no_network=True, load_dtd=False,
        huge_tree=False,
        remove_blank_text=True)
    root: XmlElement | None = None
    failure: SdfError | None = None
    try:
        root = etree.fromstring(text, parser)
    except etree.XMLSyntaxError as error:
        failure = FileReadError(f'this is not XML: {error.msg}', Place(path, error.lineno or 0))
    for entry in parser.error_log:
        msg = f'this is not well-formed XML: {entry.message.strip()}'
        is_early = entry.type_name == _DECLARATION_ERROR and text.lstrip().startswith(b'<?xml')
        if is_early or (entry.type_name in _FORGIVEN_ERRORS and root is not None):
            warnings.append(SdfWarning('WARNING', msg, Place(path, entry.line)))
        elif entry.type_name not in _NAMESPACE_ERRORS:
            raise FileReadError(msg, Place(path, entry.line)) from None
    if failure is not None:
        raise failure
    if root is None:
        msg = 'this is not XML: it has no element'
        raise FileReadError(msg, Place(path))
    _refuse_what_hides_text(root, text, path)
    if b'xmlns' in text:
        _forget_default_namespaces(root)
    return root, tuple(warnings)


def _refuse_what_hides_text(root: XmlElement, text: bytes, path: str) -> None:
    """Refuse what an XML parser takes out of the text, or puts into it."""
    definitions = root.getroottree().docinfo.internalDTD
    if definitions is not None and next(definitions.iterentities(), None) is not None:
        msg = 'the file declares entities, which SDFormat does not have'
        raise FileReadError(msg, Place(path, 1))
    # Mostly there are no question marks but those of the declaration, and the tree is large.
    declaration = text.find(b'?>') + 2 if text.startswith(b'<?xml') else 0
    has_more = text.find(b'?', declaration) >= 0
    instruction = next(root.iter(etree.PI), None) if has_more else None
    if instruction is not None:
        msg = f'the processing instruction <?{instruction.text}?> can only stand before <sdf>'
        raise FileReadError(msg, Place(path, instruction.sourceline or 0))


def _may_hold_separators(text: bytes) -> bool:
    if b'\0' in text[:4] or (b'&' in text and b'&#' in text):
        return True  # UTF-16, or a colon that may be written otherwise
    if b':' not in text:
        return False
    # A regular expression looks for two equal characters much faster than bytes.find does.
    for found in _SEPARATOR.finditer(text):
        place = found.start()
        before = text[max(place - _LONGEST_SURE_NAME, 0):place]
        quotes = [quote for quote in (before.rfind(b'"'), before.rfind(b"'")) if quote >= 0]
        if not quotes or any(
                before[:quote].rstrip(b' \t\r\n=').endswith(b'name') for quote in quotes):
            return True
    return False


def _forget_default_namespaces(root: XmlElement) -> None:
    """Name elements as they are written: SDFormat knows prefixes, but no namespaces."""
    for element in root.iter(etree.Element):
        tag = str(element.tag)
        if tag.startswith('{'):
            name = tag[tag.index('}') + 1:]
            if not element.prefix:
                element.tag = name


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
    return _WHITE_SPACE_RUN.sub(' ', text_of(element)).strip(' ')


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


def _line(element: XmlElement) -> int:
    return element.sourceline or 0
