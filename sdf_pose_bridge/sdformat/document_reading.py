# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read an SDFormat file into a tree."""

from __future__ import annotations

import os
import re

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file
from sdf_pose_bridge.sdformat.xml_file import root_from_text

_SEPARATOR = re.compile(SEPARATOR.encode())
_LONGEST_SURE_NAME = 500
_PLUGIN = tuple(b'<plugin' + white for white in (b' ', b'\t', b'\n', b'\r'))


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
    # The encoding of text is known; that of bytes is whatever they declare.
    root, warnings = root_from_text(content, path, 'utf-8' if isinstance(text, str) else None)
    return Document(
        path, root, _version(root, path), warnings,
        may_hold_separators=_may_hold_separators(content))


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


def _may_hold_separators(text: bytes) -> bool:
    if b'\0' in text[:4] or (b'&' in text and b'&#' in text):
        return True  # UTF-16, or a colon that may be written otherwise
    if b':' not in text:
        return False
    # A regular expression looks for two equal characters much faster than bytes.find does.
    for found in _SEPARATOR.finditer(text):
        place = found.start()
        before = text[max(place - _LONGEST_SURE_NAME, 0):place]
        if before[before.rfind(b'<'):].startswith(_PLUGIN):
            continue  # which mostly bear the name of a class, and which SDFormat does not read
        quotes = [quote for quote in (before.rfind(b'"'), before.rfind(b"'")) if quote >= 0]
        if not quotes or any(
                before[:quote].rstrip(b' \t\r\n=').endswith(b'name') for quote in quotes):
            return True
    return False
