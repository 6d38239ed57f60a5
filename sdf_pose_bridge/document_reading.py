# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read an SDFormat file: a tree of all of it, or of what is not regular in it.

Most of a large file is regular, and is found in its text. Only the rest needs a tree.
"""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Mapping
import contextlib
import os
import re

import numpy as np

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.markup import markup_from_texts
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.versions import has_frame_attributes
from sdf_pose_bridge.versions import turns_axes_with_model
from sdf_pose_bridge.versions import upgrade
from sdf_pose_bridge.versions import Version
from sdf_pose_bridge.versions import version_from_text
from sdf_pose_bridge.xml_reading import bytes_from_file
from sdf_pose_bridge.xml_reading import root_from_text
from sdf_pose_bridge.xml_reading import WellFormednessCheck

_UTF_8 = frozenset({None, 'UTF-8', 'utf-8', 'ASCII', 'US-ASCII'})

_HEAD = re.compile(
    rb'(?:<\?xml([^>]*)\?>)?\s*(?:<!--(?:(?!--).)*-->\s*)*'
    rb'<sdf\s(?:[^>]*\s)?version\s*=\s*["\']([0-9.]*)["\']', re.DOTALL)
_ENCODING = rb'encoding\s*=\s*["\']([^"\']*)'

_SEPARATOR = re.compile(SEPARATOR.encode())
_LONGEST_SURE_NAME = 500

_LARGE = 1 << 15
"""Bytes of files of which it is worth while to leave the regular part out of the tree."""
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
    found = _documents_without_regular_part({path: content})
    if path in found:
        return found[path]
    # The encoding of text is known; that of bytes is whatever they declare.
    root, warnings = root_from_text(content, path, 'utf-8' if isinstance(text, str) else None)
    return Document(
        path, root, _version(root, path), warnings, text=content if _is_utf_8(root) else None,
        may_hold_separators=_may_hold_separators(content))


def documents_from_files(paths: Iterable[str]) -> dict[str, Document]:
    """
    Read many files together, which is quicker than one by one.

    :param paths: paths of SDFormat files.
    :return: what they hold, by their paths; without those in which anything is unusual, which have
        to be read alone.
    """
    contents = {}
    for path in paths:
        with contextlib.suppress(SdfError):
            content = bytes_from_file(path)
            if _may_be_joined(content):
                contents[path] = content
    return _documents_without_regular_part(contents)


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


def _documents_without_regular_part(contents: Mapping[str, bytes]) -> dict[str, Document]:
    """Leave what is regular out of the trees; leave out files that need their whole trees."""
    if sum(map(len, contents.values())) < _LARGE:
        return {}
    groups: dict[tuple[bool, bool], dict[str, bytes]] = {}
    for path, content in contents.items():
        version = _early_version(content)
        if version is not None and not _may_hold_separators(content):
            rules = turns_axes_with_model(version), has_frame_attributes(version)
            groups.setdefault(rules, {})[path] = content
    found: dict[str, Document] = {}
    for group in groups.values():
        found.update(_documents_of_one_grammar(group))
    return found


def _documents_of_one_grammar(contents: Mapping[str, bytes]) -> dict[str, Document]:
    texts = list(contents.values())
    check = WellFormednessCheck(texts)
    markup: Markup | None = None
    # What happens with a text that is not well-formed does not matter.
    with contextlib.suppress(ValueError, IndexError):
        markup = markup_from_texts(texts)
    version = _early_version(texts[0])
    if not check.are_well_formed() or version is None or markup is None or (
            len(markup.of('include')) or not np.array_equal(markup.roots, markup.of('sdf'))
            or markup.deepest > _DEEPEST or markup.longest_text > _LONGEST_TEXT):
        return {}
    # Small files need not wait for these.
    from sdf_pose_bridge.markup_index import index_from_remainder
    from sdf_pose_bridge.remainder import remainders_from_markup
    found = {}
    for (path, content), remainder in zip(
            contents.items(), remainders_from_markup(markup, texts, version), strict=True):
        root, warnings = root_from_text(remainder.text, path)
        declared = _version(root, path)
        if _is_utf_8(root) and version_from_text(declared) == _early_version(content):
            found[path] = Document(
                path, root, declared, warnings, text=content, may_hold_separators=False,
                elements=index_from_remainder(root, markup, remainder))
    return found


def _may_be_joined(content: bytes) -> bool:
    """Leave out what would keep all others from being read together."""
    declaration = content.find(b'?>') + 2 if content.startswith(b'<?xml') else 0
    return content.find(b'?', declaration) < 0 and b'<include' not in content and (
        content.find(b'!') < 0 or re.search(rb'<!(?!--)', content) is None)


def _early_version(text: bytes) -> Version | None:
    """Look for the version of a text, before it is parsed; None if it is not surely in UTF-8."""
    head = _HEAD.match(text)
    if head is None:
        return None
    encoding = re.search(_ENCODING, head.group(1) or b'')
    if encoding and encoding.group(1).decode('latin-1') not in _UTF_8:
        return None
    return version_from_text(head.group(2).decode('ascii'))


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
