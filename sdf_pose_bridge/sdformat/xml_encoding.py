# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Decode the bytes of XML files, before anything looks for something in them.

An encoding in which ``<`` or ``:`` can be written in other ways than in ASCII would get past every
search of the bytes, so only a few encodings are known here. libsdformat reads everything as UTF-8.
"""

from __future__ import annotations

import codecs
import re
from typing import NamedTuple

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import Place

_MARKS = (
    (codecs.BOM_UTF8, 'utf-8'), (codecs.BOM_UTF32_LE, 'utf-32-le'),
    (codecs.BOM_UTF32_BE, 'utf-32-be'), (codecs.BOM_UTF16_LE, 'utf-16-le'),
    (codecs.BOM_UTF16_BE, 'utf-16-be'), (b'<\0\0\0', 'utf-32-le'), (b'\0\0\0<', 'utf-32-be'),
    (b'<\0', 'utf-16-le'), (b'\0<', 'utf-16-be'))
"""The encodings that the first bytes show: byte order marks, and ``<`` in two or four bytes."""

_DECLARATION = re.compile(rb'\s*<\?xml[^>]*?encoding\s*=\s*["\']([A-Za-z0-9._-]+)["\']')

_ALLOWED = re.compile(r'utf-(8|16|32)(-[bl]e)?|ascii|iso8859-[0-9]+|cp125[0-9]')
"""The names that Python has for the encodings that are decoded."""


class DecodedText(NamedTuple):
    """The text of a file."""

    utf8: bytes
    """In UTF-8, without a byte order mark."""
    encoding: str
    """Python's name of the encoding that the file is in."""
    fault: str = ''
    """What is wrong with the encoding; the bytes stay, and may not be UTF-8."""


def text_from_bytes(content: bytes, path: str) -> DecodedText:
    """
    Decode XML.

    :param content: XML, in the encoding that its first bytes show or that it declares.
    :param path: the name to use in errors.
    :return: the text.
    :raises FileReadError: for an encoding that is not supported.
    """
    encoding = next((name for mark, name in _MARKS if content.startswith(mark)), '')
    declared = None if encoding else _DECLARATION.match(content)
    if declared is not None:
        encoding = declared[1].decode()
        if encoding.lower().startswith(('utf-16', 'utf-32', 'utf16', 'utf32')):
            # It could not have been read in one of these.
            return _undecoded(content, encoding)
    try:
        name = codecs.lookup(encoding or 'utf-8').name
    except LookupError:
        return _undecoded(content, encoding)
    if name == 'utf-8':
        return DecodedText(content.removeprefix(codecs.BOM_UTF8), name)
    if _ALLOWED.fullmatch(name) is None:
        msg = (f'the encoding "{encoding}" is not supported; UTF-8, UTF-16, UTF-32, ASCII, '
               'ISO-8859 and windows-125x are')
        raise FileReadError(msg, Place(path, 1))
    try:
        return DecodedText(content.decode(name).removeprefix('\ufeff').encode(), name)
    except UnicodeDecodeError:
        return _undecoded(content, encoding)


def _undecoded(content: bytes, encoding: str) -> DecodedText:
    fault = f'the text is not in the encoding "{encoding}"; UTF-8 is used'
    return DecodedText(content, 'utf-8', fault)
