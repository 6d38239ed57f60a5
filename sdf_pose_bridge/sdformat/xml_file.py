# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Parse XML files, which may be hostile: no external entities, no expansion, no network.

Depth and sizes are limited as libxml2 does without its option ``huge``.
"""

from __future__ import annotations

import codecs
from collections.abc import Mapping
import contextlib
import errno
from glob import escape
from itertools import chain, islice
import os
from pathlib import Path
import re
import stat
from typing import NamedTuple
from xml.parsers import expat

from lxml import etree
import numpy as np

from sdf_pose_bridge.errors import (
    FileReadError,
    Place,
    SdfWarning,
    shortened_message,
    TemporaryReadError,
)
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.process_limits import raise_limits
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.templates import hint_about_missing_file, hint_about_template
from sdf_pose_bridge.sdformat.xml_text import before_zero_byte, repaired, text_from_bytes
from sdf_pose_bridge.sdformat.xml_tree import is_foreign, WHITE_SPACE, XmlElement

_TEMPORARY = frozenset({
    errno.EAGAIN, errno.EINTR, errno.EIO, errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.ESTALE,
    errno.ETIMEDOUT})

_WORLDS_OF_GAZEBO = (
    'opt/ros/*/opt/gz_sim_vendor/share/gz/gz-sim*/worlds', 'usr/share/gz/gz-sim*/worlds')
"""Directories below the root of the worlds that come with Gazebo."""

_FAULTS = {
    r'Opening and ending tag mismatch: (.+) line (\d+) and (.+)':
        r'</\3> cannot end <\1> of line \2; </\1> is missing or misspelt',
    r'Premature end of data in tag (.+) line (\d+)':
        r'the file ends inside <\1> of line \2; </\1> is missing',
    r"Couldn't find end of Start Tag (.+) line (\d+)":
        r'the start tag <\1 of line \2 has no ">"',
    'attributes construct error': 'an attribute is not written as name="value"',
    "Unescaped '<' not allowed in attributes values":
        'the value of an attribute holds "<"; a quotation mark before it may be missing',
    'AttValue: " or \' expected': 'the value of an attribute is not in quotation marks',
    'Attribute (.+) redefined': r'the attribute \1 is given twice',
    r'Excessive depth in document: (\d+).*': r'elements are nested more than \1 deep',
    '.*([Hh]uge (text|input)|too long|Buffer size limit).*':
        'a text or a value is longer than 10 MB',
}
"""Plain messages, by regular expressions for the messages of libxml2."""

_IGNORED_ERRORS = frozenset({
    'NS_ERR_ATTRIBUTE_REDEFINED', 'NS_ERR_COLON', 'NS_ERR_EMPTY', 'NS_ERR_QNAME',
    'NS_ERR_UNDEFINED_NAMESPACE', 'NS_ERR_XML_NAMESPACE', 'WAR_NS_COLUMN', 'WAR_NS_URI',
    'WAR_NS_URI_RELATIVE', 'DTD_ID_REDEFINED'})
"""SDFormat has prefixes without namespaces, and ``xml:id`` has no meaning in it."""

_MOST_ERRORS = 100
"""Releases 2.11 to 2.13 of libxml2 report no more errors."""

_LONGEST_TEXT = 10_000_000
"""Longer ones are errors of libxml2, which some releases report as a lack of memory."""

_LAST_LINE = 65_535
"""libxml2 reports this line for all elements in later lines."""

_NO_TAG = (
    rb'(?:!--.*?-->|!\[CDATA\[.*?\]\]>|![A-Z](?:[^"\'>]|"[^"]*"|\'[^\']*\')*>|\?.*?\?>)')
"""A comment, CDATA, declaration or instruction, without the first character."""

START_TAG = re.compile(
    rb'<(?:([^/!?][^"\'>]*(?:"[^"]*"[^"\'>]*|\'[^\']*\'[^"\'>]*)*)>|' + _NO_TAG + rb')', re.DOTALL)
"""A start tag with its inside as group 1, or a comment or the like, as tags in it are none."""

_OTHER_PART = re.compile(b'<' + _NO_TAG, re.DOTALL)

_NOT_TAGS_AND_BREAKS = bytes(set(range(256)) - set(b'<>\t\n'))

_NAME_SPACE = re.compile(rb'"[^"]*"|\'[^\']*\'|(?<=\s)(xmlns)(?=[\s:=])')
"""A declaration of a name space in a start tag, as group 1, or a value that may look like one."""

_BROKEN_NAME = re.compile(
    rb'(?<=\s)name\s*=\s*("[^"\t\n]*[\t\n][^"]*"|\'[^\'\t\n]*[\t\n][^\']*\')')
_BREAKS = {'\n': 'a line break', '\t': 'a tab'}


class XmlFile(NamedTuple):
    """A parsed file."""

    root: XmlElement
    """The outermost element. Elements have their written tags, independently of ``xmlns``."""
    warnings: tuple[SdfWarning, ...]
    lines: Mapping[XmlElement, int]
    """The lines of start tags, of the elements for which lxml has another line."""
    text: bytes
    """The parsed text in UTF-8."""
    encoding: str
    """Python's name of the encoding of the file."""


def bytes_from_file(path: str, usage: Usage, *, allows_pipe: bool = False) -> bytes:
    """
    Return the content of a file.

    :param allows_pipe: whether it may be a terminal, or a pipe as of the shell's ``<(command)``.
    :raises FileReadError: if it is missing, unreadable or not a regular file;
        :class:`~sdf_pose_bridge.errors.TemporaryReadError` if reading it again may help.
    :raises LimitError: if it is too large.
    """
    place = Place(path)
    try:
        # Without O_NONBLOCK, opening a named pipe waits for a writer.
        with open(path, 'rb', opener=_descriptor_without_waiting) as file:
            status = os.fstat(file.fileno())
            is_pipe = allows_pipe and (stat.S_ISFIFO(status.st_mode) or file.isatty())
            if not stat.S_ISREG(status.st_mode) and not is_pipe:
                msg = 'the file cannot be read: it is not a regular file'
                if path.startswith('/dev/'):  # /dev/stdin, or <(xacro ...) of a shell
                    msg += '; the node takes the text itself as its parameter robot_description'
                raise FileReadError(msg, place)
            os.set_blocking(file.fileno(), True)
            usage.add('bytes_read', status.st_size, place)
            usage.files.append(path)
            parts = [file.read(status.st_size)]
            while is_pipe and (part := file.read1()):
                usage.add('bytes_read', len(part), place)
                parts.append(part)
            text = b''.join(parts)
            if text.startswith(b'version https://git-lfs.'):
                msg = 'the file is a pointer of Git LFS; "git lfs pull" fetches its content'
                raise FileReadError(msg, place)
            return text
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte
        msg = f'the file cannot be read: {getattr(error, "strerror", None) or error}{_cure(path)}'
        is_temporary = isinstance(error, OSError) and error.errno in _TEMPORARY
        raise (TemporaryReadError if is_temporary else FileReadError)(msg, place) from error


def _cure(path: str) -> str:
    if os.path.isdir(path):  # noqa: PTH112 - Path.is_dir raises for a zero byte
        return '; name a file in it'
    if '$' in path or path.startswith('~'):
        return '; $ and ~ stay as they are in quotes and in parameter files'
    if re.match(r'\s*<', path):
        return '; this is the text of a file, which load_text reads'
    if '://' in path:
        return '; this is a URI, and not a path'
    folder, name = os.path.split(path)
    worlds = [
        world for each in _WORLDS_OF_GAZEBO for world in Path('/').glob(f'{each}/{escape(name)}')]
    if worlds and not folder:
        return f'; Gazebo has it as "{worlds[-1]}"'
    try:
        return '' if os.path.lexists(path) else hint_about_missing_file(path) or (
            hint_from_names(name, os.listdir(folder or '.')))  # noqa: PTH208
    except (OSError, ValueError):
        return ''


def _descriptor_without_waiting(path: str, flags: int) -> int:
    try:
        return os.open(path, flags | os.O_NONBLOCK | os.O_NOCTTY)
    except BlockingIOError:
        # Another process, such as a file server, has a lease on a regular file.
        return os.open(path, flags | os.O_NOCTTY)


def xml_from_file(path: str, usage: Usage, text: bytes | str | None = None) -> XmlFile:
    """
    Read and parse a file, or a text instead of it.

    :raises FileReadError: as :func:`bytes_from_file` and :func:`xml_from_bytes`.
    :raises LimitError: if it is too large.
    """
    if text is None:
        text = bytes_from_file(path, usage)
    else:
        if isinstance(text, str):  # whatever encoding it declares
            text = codecs.BOM_UTF8 + text.encode(errors='surrogatepass')
        usage.add('bytes_read', len(text), Place(path))
    text = before_zero_byte(text)
    # Counted before they are parsed, which takes many times the memory; with comments.
    raise_limits(len(text), usage.limits.processor_s, usage.limits.memory_bytes)
    usage.add('elements', text.count(b'<') - text.count(b'</'), Place(path))
    return xml_from_bytes(text, path)


def xml_from_bytes(content: bytes, path: str) -> XmlFile:
    """
    Parse XML; ``path`` is its name in errors.

    :raises FileReadError: if it is not well-formed and libsdformat does not accept it, or its
        encoding is not supported.
    """
    text, encoding, faults = text_from_bytes(content, path)
    try:
        root = _parsed(text, path)
    except FileReadError:
        repair = repaired(text)
        if repair is None:
            raise
        text, more_faults = repair
        faults += more_faults
        root = _parsed(text, path)
    if root.getroottree().docinfo.internalDTD is not None:
        _check_with_expat(text, path)
    # TinyXML-2 refuses them in and after the outermost element.
    for instruction in chain(root.iter(etree.PI), root.itersiblings(etree.PI)):
        msg = f'the processing instruction <?{instruction.text}?> can only stand before <sdf>'
        raise FileReadError(msg, Place(path, instruction.sourceline or 0))
    divided = _with_borders_of_cdata(text)
    if divided is not text or b'xmlns' in text:
        root = _parsed(_without_name_spaces(divided), path)
    lines, warnings = _lines_and_warnings(root, text, path)
    hint = hint_about_template(path, content) if faults else ''
    warnings += [
        SdfWarning('WARNING', f'this is not well-formed XML: {fault}{hint}', Place(path, line))
        for line, fault in faults]
    return XmlFile(root, tuple(warnings), lines, text, encoding)


def _parsed(text: bytes, path: str) -> XmlElement:
    parser = etree.XMLParser(
        encoding='utf-8', recover=True, resolve_entities=False, no_network=True, load_dtd=False,
        huge_tree=False, remove_blank_text=True)
    root = None
    with contextlib.suppress(etree.XMLSyntaxError):
        root = etree.fromstring(text, parser)
    errors = [entry for entry in parser.error_log if entry.type_name not in _IGNORED_ERRORS]
    if any(entry.type_name == 'ERR_NO_MEMORY' for entry in errors) and (
            max(map(len, text.split(b'<'))) <= _LONGEST_TEXT):
        raise MemoryError
    if errors:
        fault = errors[0].message.rstrip('\n')
        for pattern, replacement in _FAULTS.items():
            fault = re.sub(rf'\A{pattern}\Z', replacement, fault)
        msg = f'this is not well-formed XML: {fault}{hint_about_template(path, text)}'
        # libxml2 reports a missing end behind the last line break.
        last_line = text.count(b'\n') + (not text.endswith(b'\n'))
        raise FileReadError(msg, Place(path, min(errors[0].line, last_line)))
    if root is None:  # lxml does not always report that there is too little memory
        raise MemoryError
    if len(parser.error_log) >= _MOST_ERRORS:
        _check_with_expat(text, path)
    return root


def _check_with_expat(text: bytes, path: str) -> None:
    """Reject declarations in the document type, and faults that libxml2 did not report."""
    parser = expat.ParserCreate('utf-8')

    def check_document_type(
        _name: str, _system: str | None, _public: str | None, has_declarations: int,
    ) -> None:
        if has_declarations:
            begin = text.rfind(b'<!DOCTYPE', 0, parser.CurrentByteIndex)
            msg = 'the document type has declarations of its own, which SDFormat does not have'
            raise FileReadError(msg, Place(path, 1 + text.count(b'\n', 0, begin)))

    parser.StartDoctypeDeclHandler = check_document_type
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        message = expat.ErrorString(error.code)
        if message != expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT:
            msg = f'this is not well-formed XML: {message}'
            raise FileReadError(msg, Place(path, error.lineno)) from error


def _with_borders_of_cdata(text: bytes) -> bytes:
    """Let CDATA be a text of its own, as for libsdformat; libxml2 would join it to others."""
    if b'<![CDATA[' not in text:
        return text
    # Blank CDATA is the text of its element, so more than a comment ends it.
    return _OTHER_PART.sub(
        lambda part: b'<!---->%b<?end?>' % part[0] if part[0].startswith(b'<![') else part[0],
        text)


def _without_name_spaces(text: bytes) -> bytes:
    # SDFormat has none, and libxml2 searches all of them when it copies an element with a prefix.
    result, last = bytearray(text), text.rfind(b'xmlns')
    for tag in START_TAG.finditer(text):
        if tag.start() > last:
            break
        for match in _NAME_SPACE.finditer(text, *tag.span(1)) if tag[1] else ():
            if match[1]:
                result[slice(*match.span(1))] = b'xm:ns'
    return bytes(result)


def _lines_and_warnings(
    root: XmlElement, text: bytes, path: str,
) -> tuple[dict[XmlElement, int], list[SdfWarning]]:
    """Return lines that libxml2 has not, and warnings about names with a line break or a tab."""
    # Without comments and the like, each "<" is a tag.
    tags_and_texts = _OTHER_PART.sub(lambda part: b'\n' * part[0].count(b'\n'), text)
    # Most texts have no such tag, which this finds in a fraction of the time of the search.
    rest = tags_and_texts.translate(None, _NOT_TAGS_AND_BREAKS)
    # A value may contain ">" before the break.
    has_break = b'<\n' in rest or b'<\t' in rest or rest.count(b'<') != rest.count(b'>')
    if not has_break and text.count(b'\n') < _LAST_LINE:
        return {}, []
    characters = np.frombuffer(tags_and_texts + b'/', np.uint8)
    begins = np.flatnonzero((characters[:-1] == ord('<')) & (characters[1:] != ord('/')))
    breaks = np.flatnonzero(characters == ord('\n'))
    in_order = np.searchsorted(breaks, begins) + 1
    first = 0 if has_break else int(np.searchsorted(in_order, _LAST_LINE))
    # Nothing after the outermost element belongs to the tree.
    lines = dict(zip(
        islice(root.iter(etree.Element), first, None), in_order[first:].tolist(), strict=False))
    warnings = []
    tags = (tag[1] for tag in START_TAG.finditer(text) if tag[1]) if has_break else ()
    for (element, line), tag in zip(lines.items(), tags, strict=False):
        name = _BROKEN_NAME.search(tag)
        value = name[1][1:-1].decode().strip(WHITE_SPACE) if name else ''
        found = [label for character, label in _BREAKS.items() if character in value]
        if found and not is_foreign(element):
            msg = (f'the name "{value}" holds {found[0]}, which XML reads as a blank; Gazebo '
                   'keeps it, so names differ there')
            warnings.append(SdfWarning('WARNING', shortened_message(msg), Place(path, line)))
    return lines, warnings
