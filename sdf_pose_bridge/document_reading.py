# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read an SDFormat file: a tree of all of it, or of what is not regular in it.

Most of a large file is regular, and is found in its text. Only the rest needs a tree.
"""

from __future__ import annotations

import contextlib
import os
import re

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import markup_from_text
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.versions import NEWEST
from sdf_pose_bridge.versions import upgrade
from sdf_pose_bridge.versions import version_from_text
from sdf_pose_bridge.xml_reading import bytes_from_file
from sdf_pose_bridge.xml_reading import root_from_text
from sdf_pose_bridge.xml_reading import WellFormednessCheck

_UTF_8 = frozenset({None, 'UTF-8', 'utf-8', 'ASCII', 'US-ASCII'})

_SEPARATOR = re.compile(SEPARATOR.encode())
_LONGEST_SURE_NAME = 500

_LARGE = 1 << 15
"""Bytes of a file of which it is worth while to leave the regular part out of the tree."""
_DEEPEST = 250
_LONGEST_TEXT = 9_000_000


def document_from_file(path: str | os.PathLike[str]) -> Document:
    """
    Read a file.

    :param path: path of an SDFormat file.
    :return: what it holds; declared version and content are not judged here.
    :raises FileReadError: if it is missing, unreadable, not XML, or declares no version.
    :raises ParsingError: if its outermost element is not ``sdf``.
    """
    name = os.fspath(path)
    return document_from_text(bytes_from_file(name), name)


def document_from_text(text: bytes | str, path: str) -> Document:
    """
    Read the content of a file.

    :param text: XML; bytes are in the encoding that it declares.
    :param path: the name to use in errors.
    :return: as for :func:`document_from_file`.
    :raises SdfError: as for :func:`document_from_file`.
    """
    content = text.encode(errors='surrogatepass') if isinstance(text, str) else text
    may_hold_separators = _may_hold_separators(content)
    if len(content) >= _LARGE and not may_hold_separators:
        document = _document_without_regular_part(content, path)
        if document is not None:
            return document
    # The encoding of text is known; that of bytes is whatever they declare.
    root, warnings = root_from_text(content, path, 'utf-8' if isinstance(text, str) else None)
    return Document(
        path, root, _version(root, path), warnings, text=content if _is_utf_8(root) else None,
        may_hold_separators=may_hold_separators)


def whole_document(document: Document) -> Document:
    """
    Read a document again, with all of it in its tree.

    :param document: a file that has only a part of it in its tree.
    :return: the same file, with a tree of its own; in the newest grammar.
    """
    assert document.text is not None
    root, _ = root_from_text(document.text, document.path)
    whole = document._replace(root=root, elements=None)
    upgrade(whole)
    return whole


def _document_without_regular_part(content: bytes, path: str) -> Document | None:
    """Leave what is regular out of the tree; None if the file needs its whole tree."""
    if not content.startswith(b'<'):
        return None
    check = WellFormednessCheck(content)
    markup: Markup | None = None
    # What happens with a text that is not well-formed does not matter.
    with contextlib.suppress(ValueError, IndexError):
        markup = markup_from_text(content)
    if not check.is_well_formed() or markup is None or len(markup.of('include')) or (
            markup.has_tail or markup.deepest > _DEEPEST or markup.longest_text > _LONGEST_TEXT):
        return None
    head, _ = root_from_text(markup.head(), path)
    if not _is_utf_8(head):
        return None
    # Small files need not wait for these.
    from sdf_pose_bridge.markup_index import MarkupIndex
    from sdf_pose_bridge.remainder import remainder_from_markup
    declared = _version(head, path)
    version = version_from_text(declared) or NEWEST
    remainder = remainder_from_markup(markup, version)
    root, warnings = root_from_text(remainder.text, path)
    elements = MarkupIndex(root, markup, version, with_lines=markup, remainder=remainder)
    return Document(
        path, root, declared, warnings, text=content, elements=elements, may_hold_separators=False)


def _version(root: XmlElement, path: str) -> str:
    """Return the version that the outermost element declares."""
    tag = str(root.tag)
    place = Place(path, root.sourceline or 0, f'/{tag}')
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
    return version


def _is_utf_8(root: XmlElement) -> bool:
    return root.getroottree().docinfo.encoding in _UTF_8


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
