# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Decode the bytes of a file, and repair XML that is not well-formed but that libsdformat reads.

Only a few encodings are accepted, because others can hide ``<`` or ``:`` from a search of the
bytes. libsdformat reads everything as UTF-8.

TinyXML-2, and so libsdformat, accepts text that is not well-formed XML; it is rewritten here.
TinyXML-2 knows the five predefined entities and reads any other ``&`` as text. It accepts ``<`` in
attribute values, ``]]>`` in text, two hyphens in comments, attributes without white space between
them, white space behind ``<``, bytes that are not UTF-8, and any XML version and encoding. It
accepts characters that XML does not have; they are replaced here. It skips text before the
outermost element, and everything behind it that is not text alone. Of several outermost elements,
libsdformat reads the first ``<sdf>``, else the first ``<robot>``. It stops at an end tag without a
start tag. Lines are kept.
"""

from __future__ import annotations

import codecs
from collections.abc import Callable
import contextlib
import re
import sys
from typing import NamedTuple, TypeAlias

from sdf_pose_bridge.errors import FileReadError, Place
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.xml_tree import WHITE_SPACE

_MARKS = (
    (codecs.BOM_UTF8, 'utf-8'), (codecs.BOM_UTF32_LE, 'utf-32-le'),
    (codecs.BOM_UTF32_BE, 'utf-32-be'), (codecs.BOM_UTF16_LE, 'utf-16-le'),
    (codecs.BOM_UTF16_BE, 'utf-16-be'), (b'<\0\0\0', 'utf-32-le'), (b'\0\0\0<', 'utf-32-be'),
    (b'<\0', 'utf-16-le'), (b'\0<', 'utf-16-be'))
"""The encodings that the first bytes show: byte order marks, and ``<`` in two or four bytes."""

_DECLARATION = re.compile(rb'\s*<\?xml[^>]*?encoding\s*=\s*["\']([A-Za-z0-9._-]+)["\']')

_ALLOWED = re.compile(r'utf-(8|16|32)(-[bl]e)?|ascii|iso8859-[0-9]+|cp125[0-9]')
"""Python's names of the accepted encodings."""

_RANKS = {each.tag: rank for rank, each in enumerate(reversed(SourceFormat), 1)}

_SPACE = f'[{WHITE_SPACE}]*'
_NAME = r'[^\W\d][\w:.\-]*|:[\w:.\-]*'
_ATTRIBUTE = re.compile(rf'({_SPACE})((?:{_NAME}){_SPACE}={_SPACE}(["\']))(.*?)\3', re.DOTALL)
_TOKEN = re.compile(
    rf'(?P<comment><!--.*?-->)|(?P<verbatim><!\[CDATA\[.*?\]\]>)|(?P<instruction><\?.*?\?>)'
    rf'|(?P<other><!(?!--|\[CDATA\[)[^>]*>)|(?P<text>[^<]+)'
    rf'|<(?P<space>{_SPACE})(?P<end>/?)(?P<tag>{_NAME})(?![\w:.\-])', re.DOTALL)
"""A token, or the beginning of a tag, which attributes and ``_REST_OF_TAG`` follow."""
_REST_OF_TAG = re.compile(rf'{_SPACE}(?P<empty>/?)>')
_REFERENCE = re.compile(r'&#(?:([0-9]+)|x([0-9a-fA-F]+));')
_NOT_XML = re.compile('[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]')
"""A character that XML does not have."""
_REPLACEMENT = '\ufffd'
_LONGEST_REFERENCE = 9
"""Largest number of digits of a character reference that are read, without leading zeros; no
character has as many."""


class _Replacement(NamedTuple):
    """A text that is replaced everywhere."""

    pattern: re.Pattern[str]
    new: str | Callable[[re.Match[str]], str]
    fault: str
    """A message, which can contain the number of the first character."""


_CHARACTERS = _Replacement(
    _NOT_XML, _REPLACEMENT, 'U+{:04X} is no character of XML; it is replaced')
_ENDS = _Replacement(
    re.compile('&#x?0*;.*', re.DOTALL), lambda end: '\n' * end[0].count('\n'),
    'a reference to U+0000 ends the value')
_SPACES = _Replacement(
    re.compile('[\v\f]|&#(?:0*1[12]|x0*[bcBC]);'), ' ',
    'vertical tabs and form feeds are no characters of XML; they are read as blanks')
_AMPERSANDS = _Replacement(
    re.compile(r'&(?!(?:amp|lt|gt|quot|apos|#[0-9]+|#x[0-9a-fA-F]+);)'), '&amp;',
    '"&" is not the beginning of a known entity')
_ESCAPED_BYTES = _Replacement(
    re.compile('[\udc80-\udcff]'), lambda byte: chr(ord(byte[0]) - 0xdc00),
    'bytes that are not UTF-8, which are read as Latin-1')
"""Results of the error handler ``surrogateescape`` for bytes that are not UTF-8."""


def before_zero_byte(content: bytes) -> bytes:
    """Return XML without its first zero byte and the rest, unless its first bytes are UTF-16."""
    is_wide = any(content.startswith(mark) for mark, name in _MARKS if name != 'utf-8')
    return content if is_wide else content.partition(b'\0')[0]


def text_from_bytes(content: bytes, path: str) -> tuple[bytes, str, list[tuple[int, str]]]:
    """
    Decode XML by its first bytes or the encoding that it declares.

    :return: the text in UTF-8 without a byte order mark; Python's name of its encoding; and the
        line and a message for a fault of the encoding, with which the bytes are unchanged and may
        not be UTF-8.
    :raises FileReadError: for an encoding that is not supported.
    """
    encoding = next((name for mark, name in _MARKS if content.startswith(mark)), '')
    declared = None if encoding else _DECLARATION.match(content)
    if declared is not None:
        encoding = declared[1].decode()
    # In an encoding of two or four bytes, its declaration could not have been read.
    if declared is None or not encoding.lower().startswith(('utf-16', 'utf-32', 'utf16', 'utf32')):
        with contextlib.suppress(LookupError, UnicodeDecodeError):
            name = codecs.lookup(encoding or 'utf-8').name
            if name == 'utf-8':
                return content.removeprefix(codecs.BOM_UTF8), name, []
            if _ALLOWED.fullmatch(name) is not None:
                return content.decode(name).removeprefix('\ufeff').encode(), name, []
            msg = (f'the encoding "{encoding}" is not supported; UTF-8, UTF-16, UTF-32, ASCII, '
                   'ISO-8859 and windows-125x are')
            raise FileReadError(msg, Place(path, 1))
    fault = f'the text is not in the encoding "{encoding}"; UTF-8 is used'
    return content, 'utf-8', [(1, fault)]


_Repair: TypeAlias = tuple[bytes, list[tuple[int, str]]]


def repaired(text: bytes) -> _Repair | None:
    """
    Rewrite text, which should be UTF-8, as well-formed XML of the same meaning.

    :return: the XML in UTF-8 without a declaration, and the first line and a message for each sort
        of fault; None if TinyXML-2 rejects the text too. Nesting and names of end tags are not
        checked.
    """
    return _Repairer().repaired(text)


class _Repairer:

    def __init__(self) -> None:
        self._faults: dict[str, int] = {}
        self._line = 1
        self._open: list[str] = []
        """The tags of the open elements."""
        self._is_after_root = False
        self._may_declare = True

    def repaired(self, text: bytes) -> _Repair | None:
        escaped = text.decode('utf-8', errors='surrogateescape')
        decoded = self._replaced(escaped, _ESCAPED_BYTES).partition('\0')[0]
        parts = []
        is_mismatched = False  # libxml2 finds it in an element that is kept
        position = highest_rank = 0
        while position < len(decoded):
            token = _TOKEN.match(decoded, position)
            rest = _rest_of_tag(token) if token is not None and token['tag'] else token
            if token is None or rest is None:
                return None
            begin, position = position, rest.end()
            is_last_text = position == len(decoded) and (token['text'] or '').strip(WHITE_SPACE)
            if (token['instruction'] and not self._may_declare) or (
                    self._is_after_root and is_last_text):
                return None
            self._may_declare &= bool(token['instruction']) or (
                not (token['text'] or 'x').strip('\ufeff \t\r\n'))
            if not token['tag']:
                parts.append(self._repaired_token(token))
            elif self._is_after_root and token['end'] and not self._open:
                self._note('an end tag without a start tag; the text behind it is not read')
                break
            else:
                rank = _RANKS.get(token['tag'], 0)
                if not self._open and rank > highest_rank and not is_mismatched:
                    highest_rank = rank
                    if self._is_after_root:
                        self._note('elements beside the outermost element')
                        parts, self._is_after_root = [_blank(''.join(parts))], False
                parts.append(self._repaired_tag(token, rest))
                if not token['end'] and not rest['empty']:
                    self._open.append(token['tag'])
                elif token['end'] and self._open and self._open.pop() != token['tag']:
                    if self._is_after_root:
                        return None
                    is_mismatched = True
                self._is_after_root |= not self._open
            self._line += decoded.count('\n', begin, position)
        # None if there is no element, or if one after the outermost element has no end.
        return None if self._is_after_root is bool(self._open) else (
            ''.join(parts).encode(errors='replace'),
            sorted((line, fault) for fault, line in self._faults.items()))

    def _repaired_token(self, token: re.Match[str]) -> str:
        whole = token[0]
        is_outside = self._is_after_root or not self._open
        if token['comment']:
            whole = self._replaced(whole, _CHARACTERS)
            inside = whole[4:-3]
            if '--' not in inside and not inside.endswith('-'):
                return whole
            self._note('a comment holds two hyphens in a row')
            return f'<!--{_blank(inside)}-->'
        if token['text']:
            if not is_outside:
                if ']]>' in whole:
                    self._note('"]]>" in text')
                whole = self._repaired_value(self._replaced(whole, _SPACES))
                return whole.replace(']]>', ']]&gt;')
            if whole.strip('\ufeff \t\r\n'):
                where = 'after' if self._is_after_root else 'before'
                self._note(f'text {where} the outermost element')
            return _blank(whole)
        if token['instruction']:
            if token.start():
                self._note('the declaration is not at the beginning')
            return _blank(whole)
        if token['verbatim']:
            whole = self._replaced(self._replaced(whole, _SPACES), _CHARACTERS)
        if (token['verbatim'] and is_outside) or (token['other'] and self._is_after_root):
            return _blank(whole)
        return whole

    def _repaired_tag(self, token: re.Match[str], rest: re.Match[str]) -> str:
        if self._is_after_root:
            self._note('elements beside the outermost element')
            return _blank(token.string[token.start():rest.end()])
        # White space behind the name is allowed.
        parts = [f'<{token["end"]}{token["tag"]}{_blank(token["space"])}']
        if token['space']:
            self._note('white space behind "<"')
        for attribute in _ATTRIBUTE.finditer(token.string, token.end(), rest.start()):
            space, name, quote, value = attribute.groups()
            if not space:
                self._note('no white space before an attribute')
            if '<' in value:
                self._note('"<" in the value of an attribute')
            value = self._repaired_value(value).replace('<', '&lt;')
            parts.append(f'{space or " "}{name}{value}{quote}')
        return ''.join([*parts, rest[0]])

    def _repaired_value(self, text: str) -> str:
        """Repair the characters in a text, or in the value of an attribute."""
        text = self._replaced(self._replaced(text, _ENDS), _CHARACTERS)
        return self._replaced(_REFERENCE.sub(self._repaired_reference, text), _AMPERSANDS)

    def _repaired_reference(self, reference: re.Match[str]) -> str:
        digits = (reference[1] or reference[2]).lstrip('0') or '0'
        code = int(digits[:_LONGEST_REFERENCE], 10 if reference[1] else 16)
        if code <= sys.maxunicode and not _NOT_XML.match(chr(code)):
            return reference[0]
        self._note(f'{reference[0][:20]} is no character of XML; it is replaced')
        return _REPLACEMENT if code <= 0x1fffff else ''  # TinyXML-2 drops larger ones

    def _replaced(self, text: str, replacement: _Replacement) -> str:
        pattern, new, fault = replacement
        found = pattern.search(text)
        if found is not None:
            line = self._line + text.count('\n', 0, found.start())
            self._note(fault.format(ord(found[0][0])), line)
        return pattern.sub(new, text)

    def _note(self, fault: str, line: int = 0) -> None:
        """Note the first line with a fault."""
        self._faults.setdefault(fault, line or self._line)


def _rest_of_tag(token: re.Match[str]) -> re.Match[str] | None:
    """Skip attributes one by one: a pattern that repeats them would take memory for each."""
    text, position = token.string, token.end()
    while attribute := _ATTRIBUTE.match(text, position):
        position = attribute.end()
    return _REST_OF_TAG.match(text, position)


def _blank(text: str) -> str:
    return '\n'.join(' ' * len(line) for line in text.split('\n'))
