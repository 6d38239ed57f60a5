# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read XML into a tree, with care.

A file is hostile until it is read: no external entities, no expansion, no network, and the depth
and the sizes that libxml2 allows without its "huge" option.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
import re
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement

IGNORED_ERRORS = frozenset({
    'NS_ERR_UNDEFINED_NAMESPACE', 'NS_ERR_QNAME', 'NS_ERR_COLON', 'DTD_ID_REDEFINED'})
"""Prefixes that are not declared are common in SDF files, and only libxml2 minds them; nor has
``xml:id`` a meaning in SDFormat."""

_FORGIVEN_ERRORS = frozenset({'ERR_DOCUMENT_END'})
"""Something after the outermost element: libsdformat reads on."""

_MOST_ENTRIES = 100
"""Releases 2.11 to 2.13 of libxml2 tell no more errors than so many."""

_HYPHENS_ERROR = 'ERR_HYPHEN_IN_COMMENT'
"""Two hyphens in a comment, behind which libxml2 may miss the end of the comment."""

_COMMENT_OR_VERBATIM = re.compile(
    rb'<!--(?:(.*?)-->|.*)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?.*?(?:\?>|\Z)', re.DOTALL)

_DECLARATION_ERROR = 'ERR_RESERVED_XML_NAME'
"""A declaration that is not at the start; only white space before it is forgiven."""


def bytes_from_file(path: str) -> bytes:
    """
    Return what a file holds.

    :param path: path of the file.
    :return: its bytes.
    :raises FileReadError: if it is missing or unreadable.
    """
    try:
        return Path(path).read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte
        msg = f'the file cannot be read: {getattr(error, "strerror", None) or error}'
        raise FileReadError(msg, Place(path)) from error


def root_from_file(path: str) -> XmlElement:
    """
    Read a file of any XML.

    :param path: path of the file.
    :return: its outermost element.
    :raises FileReadError: if it is missing, unreadable or not XML.
    """
    return root_from_text(bytes_from_file(path), path)[0]


def careful_parser(encoding: str | None = None, target: object = None) -> etree.XMLParser:
    """
    Make a parser that can be given anything.

    :param encoding: encoding of the text; None for the one that it declares.
    :param target: takes what is found, instead of a tree.
    :return: the parser, whose log of errors tells what is wrong with a text.
    """
    # The stubs ask for a target with methods, each of which the parser would call.
    return etree.XMLParser(  # type: ignore[call-overload,no-any-return]
        encoding=encoding, target=target, recover=True, resolve_entities=False, no_network=True,
        load_dtd=False, huge_tree=False, remove_blank_text=True)


def root_from_text(
    text: bytes, path: str, encoding: str | None = None,
) -> tuple[XmlElement, tuple[SdfWarning, ...]]:
    """
    Read XML into a tree.

    :param text: the XML.
    :param path: the name to use in errors.
    :param encoding: encoding of the text; None for the one that it declares.
    :return: the outermost element, and what is wrong but does not stand in the way. Elements are
        named as they are written, for SDFormat knows prefixes, but no namespaces.
    :raises FileReadError: if it is not XML.
    """
    warnings = []
    root, failure, log = _parsed(text, encoding)
    if is_full(log) or any(entry.type_name == _HYPHENS_ERROR for entry in log):
        text, line, number = _text_without_hyphens_in_comments(text)
        if number:
            what = 'a comment holds' if number == 1 else f'{number} comments hold'
            msg = f'this is not well-formed XML: {what} two hyphens in a row'
            warnings.append(SdfWarning('WARNING', msg, Place(path, line)))
            root, failure, log = _parsed(text, encoding)
    for entry in log:
        msg = f'this is not well-formed XML: {entry.message.strip()}'
        is_early = entry.type_name == _DECLARATION_ERROR and text.lstrip().startswith(b'<?xml')
        if is_early or (entry.type_name in _FORGIVEN_ERRORS and root is not None):
            warnings.append(SdfWarning('WARNING', msg, Place(path, entry.line)))
        elif entry.type_name not in IGNORED_ERRORS:
            raise FileReadError(msg, Place(path, entry.line)) from None
    if failure is not None:
        msg = f'this is not XML: {failure.msg}'
        raise FileReadError(msg, Place(path, failure.lineno or 0))
    if root is None:
        msg = 'this is not XML: it has no element'
        raise FileReadError(msg, Place(path))
    _refuse_what_hides_text(root, text, path)
    fault = fault_beyond_log(text, encoding) if is_full(log) else None
    if fault is not None:
        msg = f'this is not well-formed XML: {fault.message}'
        raise FileReadError(msg, Place(path, fault.line))
    if b'xmlns' in text:
        _forget_default_namespaces(root)
    return root, tuple(warnings)


def is_full(log: Sequence[etree._LogEntry]) -> bool:
    """
    Tell whether there may be more errors than those in a log.

    :param log: the errors in a text, those that are ignored among them.
    :return: whether some releases of libxml2 would have kept further ones to themselves.
    """
    return len(log) >= _MOST_ENTRIES


class Fault(NamedTuple):
    """What keeps a text from being well-formed XML."""

    message: str
    line: int


def fault_beyond_log(text: bytes, encoding: str | None = None) -> Fault | None:
    """
    Find out with another parser, which knows no namespaces, whether a text is well-formed XML.

    :param text: the text.
    :param encoding: its encoding; None for the one that it declares.
    :return: the first thing that is wrong but for what is forgiven; None if there is none, or the
        parser does not know the encoding.
    """
    from xml.parsers import expat
    stripped = text.lstrip(WHITE_SPACE.encode())
    try:
        expat.ParserCreate(encoding).Parse(stripped, True)
    except (LookupError, ValueError):
        return None  # an encoding that it does not know, or one with characters of several bytes
    except expat.ExpatError as error:
        message = expat.ErrorString(error.code)
        if message not in (
                expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT,
                expat.errors.XML_ERROR_UNKNOWN_ENCODING):
            lines_before = text[:len(text) - len(stripped)].count(b'\n')
            return Fault(message, error.lineno + lines_before)
    return None


def _parsed(
    text: bytes, encoding: str | None,
) -> tuple[XmlElement | None, etree.XMLSyntaxError | None, Sequence[etree._LogEntry]]:
    """Return the outermost element, or what kept it from being read; and the log of errors."""
    parser = careful_parser(encoding)
    try:
        return etree.fromstring(text, parser), None, list(parser.error_log)
    except etree.XMLSyntaxError as error:
        return None, error, list(parser.error_log)


def _text_without_hyphens_in_comments(text: bytes) -> tuple[bytes, int, int]:
    """
    Put spaces in the place of hyphens, for a parser that minds them.

    Comments end where libsdformat's parser (TinyXML-2) lets them end: with the first ``-->``.

    :return: a text of the same length, the line of the first comment that holds two in a row, and
        the number of such comments.
    """
    starts = []

    def spaced(found: re.Match[bytes]) -> bytes:
        comment = found[1]
        if comment is None:
            return found[0]
        if b'--' in comment or comment.endswith(b'-'):
            starts.append(found.start())
        return b'<!--%b-->' % comment.replace(b'-', b' ')
    text = _COMMENT_OR_VERBATIM.sub(spaced, text)
    return text, text.count(b'\n', 0, min(starts, default=0)) + 1, len(starts)


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


def _forget_default_namespaces(root: XmlElement) -> None:
    """Name elements as they are written: SDFormat knows prefixes, but no namespaces."""
    for element in root.iter(etree.Element):
        tag = str(element.tag)
        if tag.startswith('{'):
            name = tag[tag.index('}') + 1:]
            if not element.prefix:
                element.tag = name
