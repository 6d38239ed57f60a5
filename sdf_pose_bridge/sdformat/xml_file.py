# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Parse XML files, which may be hostile: no external entities, no expansion, no network.

Depth and sizes are limited as libxml2 does without its option ``huge``.
"""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
import re
from typing import NamedTuple
from xml.parsers import expat

from lxml import etree
import numpy as np

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.sdformat.xml_tree import WHITE_SPACE
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

_IGNORED_ERRORS = frozenset({
    'NS_ERR_UNDEFINED_NAMESPACE', 'NS_ERR_QNAME', 'NS_ERR_COLON', 'DTD_ID_REDEFINED'})
"""SDFormat has prefixes without namespaces, and ``xml:id`` has no meaning in it."""

_AFTER_ROOT_ERROR = 'ERR_DOCUMENT_END'
"""Something follows the outermost element. libsdformat reads the file all the same."""

_DECLARATION_ERROR = 'ERR_RESERVED_XML_NAME'
"""The declaration is not at the start. Only white space before it is accepted."""

_HYPHENS_ERROR = 'ERR_HYPHEN_IN_COMMENT'
"""Two hyphens in a comment, after which libxml2 may miss the end of the comment."""

_MOST_ERRORS = 100
"""Releases 2.11 to 2.13 of libxml2 report no more errors."""

_LAST_LINE = 65_535
"""libxml2 reports this line for all elements in later lines."""

_COMMENT_OR_VERBATIM = re.compile(
    rb'<!--(?:(.*?)-->|.*)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?.*?(?:\?>|\Z)', re.DOTALL)
_START_TAG = re.compile(
    rb'<(?:([^/!?][^"\'>]*(?:"[^"]*"[^"\'>]*|\'[^\']*\'[^"\'>]*)*)>'
    rb'|!--.*?-->|!\[CDATA\[.*?\]\]>|\?.*?\?>)', re.DOTALL)
"""A start tag, or what may hold something that looks like one."""


class XmlFile(NamedTuple):
    """A parsed file."""

    root: XmlElement
    """The outermost element. Elements have the tags that are written, whatever ``xmlns`` says."""
    warnings: tuple[SdfWarning, ...]
    """What is wrong but is accepted."""
    lines: Mapping[XmlElement, int]
    """The lines of those elements whose line lxml does not know."""


def bytes_from_file(path: str) -> bytes:
    """
    Return the content of a file.

    :param path: path of the file.
    :return: its bytes.
    :raises FileReadError: if it is missing or unreadable.
    """
    try:
        return Path(path).read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte
        msg = f'the file cannot be read: {getattr(error, "strerror", None) or error}'
        raise FileReadError(msg, Place(path)) from error


def xml_from_bytes(text: bytes, path: str, encoding: str | None = None) -> XmlFile:
    """
    Parse XML.

    :param text: the XML.
    :param path: the name to use in errors.
    :param encoding: encoding of the text; None for the one that it declares.
    :return: the tree.
    :raises FileReadError: if it is not well-formed, apart from what libsdformat accepts.
    """
    warnings = []
    root, failure, log = _parsed(text, encoding)
    if len(log) >= _MOST_ERRORS or any(entry.type_name == _HYPHENS_ERROR for entry in log):
        text, line, count = _without_hyphens_in_comments(text)
        if count:
            what = 'a comment holds' if count == 1 else f'{count} comments hold'
            msg = f'this is not well-formed XML: {what} two hyphens in a row'
            warnings.append(SdfWarning('WARNING', msg, Place(path, line)))
            root, failure, log = _parsed(text, encoding)
    for entry in log:
        msg = f'this is not well-formed XML: {entry.message.strip()}'
        if (entry.type_name == _AFTER_ROOT_ERROR and root is not None) or (
                entry.type_name == _DECLARATION_ERROR and text.lstrip().startswith(b'<?xml')):
            warnings.append(SdfWarning('WARNING', msg, Place(path, entry.line)))
        elif entry.type_name not in _IGNORED_ERRORS:
            raise FileReadError(msg, Place(path, entry.line)) from None
    if failure is not None:
        msg = f'this is not XML: {failure.msg}'
        raise FileReadError(msg, Place(path, failure.lineno or 0))
    if root is None:
        msg = 'this is not XML: it has no element'
        raise FileReadError(msg, Place(path))
    _check_document_type(root, path)
    _check_instructions(root, text, path)
    if len(log) >= _MOST_ERRORS:
        _check_with_expat(text, encoding, path)
    if b'xmlns' in text:
        _remove_default_namespaces(root)
    return XmlFile(root, tuple(warnings), _lines_beyond_last(root, text))


def _parsed(
    text: bytes, encoding: str | None,
) -> tuple[XmlElement | None, etree.XMLSyntaxError | None, Sequence[etree._LogEntry]]:
    """Return the outermost element, or what kept it from being read; and the log of errors."""
    parser = etree.XMLParser(
        encoding=encoding, recover=True, resolve_entities=False, no_network=True, load_dtd=False,
        huge_tree=False, remove_blank_text=True)
    try:
        return etree.fromstring(text, parser), None, list(parser.error_log)
    except etree.XMLSyntaxError as error:
        return None, error, list(parser.error_log)


def _without_hyphens_in_comments(text: bytes) -> tuple[bytes, int, int]:
    """
    Replace the hyphens in comments by blanks.

    A comment ends with the first ``-->``, as in TinyXML-2.

    :return: a text of the same length, the line of the first comment that holds two hyphens in a
        row, and the number of such comments.
    """
    starts = []

    def with_blanks(found: re.Match[bytes]) -> bytes:
        comment = found[1]
        if comment is None:
            return found[0]
        if b'--' in comment or comment.endswith(b'-'):
            starts.append(found.start())
        return b'<!--%b-->' % comment.replace(b'-', b' ')
    text = _COMMENT_OR_VERBATIM.sub(with_blanks, text)
    return text, text.count(b'\n', 0, min(starts, default=0)) + 1, len(starts)


def _check_document_type(root: XmlElement, path: str) -> None:
    document_type = root.getroottree().docinfo.internalDTD
    if document_type is not None and any(
            next(declarations, None) is not None for declarations in (
                document_type.iterentities(), document_type.iterelements())):
        msg = 'the document type declares entities or attributes, which SDFormat does not have'
        raise FileReadError(msg, Place(path, 1))


def _check_instructions(root: XmlElement, text: bytes, path: str) -> None:
    """Refuse processing instructions in the tree, which end the text of an element in lxml."""
    # The search of a large tree takes long, and mostly the declaration has the only "?".
    declaration = text.find(b'?>') + 2 if text.startswith(b'<?xml') else 0
    has_more = text.find(b'?', declaration) >= 0
    instruction = next(root.iter(etree.PI), None) if has_more else None
    if instruction is not None:
        msg = f'the processing instruction <?{instruction.text}?> can only stand before <sdf>'
        raise FileReadError(msg, Place(path, instruction.sourceline or 0))


def _check_with_expat(text: bytes, encoding: str | None, path: str) -> None:
    """
    Refuse what libxml2 did not report after its first errors.

    :raises FileReadError: if the text is not well-formed, apart from what follows the outermost
        element. Encodings that expat does not know are not checked.
    """
    stripped = text.lstrip(WHITE_SPACE.encode())
    skipped = text.count(b'\n', 0, len(text) - len(stripped))
    try:
        expat.ParserCreate(encoding).Parse(stripped, True)
    except (LookupError, ValueError):
        return
    except expat.ExpatError as error:
        message = expat.ErrorString(error.code)
        if message not in (
                expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT,
                expat.errors.XML_ERROR_UNKNOWN_ENCODING):
            msg = f'this is not well-formed XML: {message}'
            raise FileReadError(msg, Place(path, skipped + error.lineno)) from error


def _remove_default_namespaces(root: XmlElement) -> None:
    for element in root.iter(etree.Element):
        tag = str(element.tag)
        if tag.startswith('{') and not element.prefix:
            element.tag = tag[tag.index('}') + 1:]


def _lines_beyond_last(root: XmlElement, text: bytes) -> dict[XmlElement, int]:
    """
    Return the lines of elements beyond the last line that libxml2 counts.

    As for other elements, it is the line in which the start tag ends.
    """
    if text.count(b'\n') < _LAST_LINE:
        return {}
    encoding = root.getroottree().docinfo.encoding or ''
    if encoding.upper().startswith(('UTF-16', 'UTF-32')):
        text = text.decode(encoding).encode()
    ends = [tag.end(1) for tag in _START_TAG.finditer(text) if tag[1]]
    line_ends = np.flatnonzero(np.frombuffer(text, np.uint8) == ord('\n'))
    lines = np.searchsorted(line_ends, ends) + 1
    first = int(np.searchsorted(lines, _LAST_LINE))
    elements = islice(root.iter(etree.Element), first, None)
    return dict(zip(elements, lines[first:].tolist(), strict=True))
