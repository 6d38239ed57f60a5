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

from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import Place

_MARKS = (
    (b'\xef\xbb\xbf', 'utf-8-sig'), (b'\xff\xfe\0\0', 'utf-32'), (b'\0\0\xfe\xff', 'utf-32'),
    (b'\xff\xfe', 'utf-16'), (b'\xfe\xff', 'utf-16'), (b'<\0\0\0', 'utf-32-le'),
    (b'\0\0\0<', 'utf-32-be'), (b'<\0', 'utf-16-le'), (b'\0<', 'utf-16-be'))
"""The encodings that the first bytes show: byte order marks, and ``<`` in two or four bytes."""

_DECLARATION = re.compile(rb'\s*<\?xml[^>]*?encoding\s*=\s*["\']([A-Za-z0-9._-]+)["\']')

_ALLOWED = re.compile(r'utf-(8|16|32)(-[bl]e)?|ascii|iso8859-[0-9]+|cp125[0-9]')
"""The names that Python has for the encodings that are decoded."""


def utf8_from_bytes(text: bytes, path: str) -> tuple[bytes, str]:
    """
    Return XML in UTF-8.

    :param text: XML, in the encoding that its first bytes show or that it declares.
    :param path: the name to use in errors.
    :return: the text without a byte order mark, and what is wrong with its encoding; empty for
        nothing. Bytes that are not UTF-8 may be left in text that is not in its encoding.
    :raises FileReadError: for an encoding that is not supported.
    """
    encoding = next((name for mark, name in _MARKS if text.startswith(mark)), '')
    declared = None if encoding else _DECLARATION.match(text)
    if declared is not None:
        encoding = declared[1].decode()
        if encoding.lower().startswith(('utf-16', 'utf-32', 'utf16', 'utf32')):
            # It could not have been read in one of these.
            return text, _fault(encoding)
    try:
        name = codecs.lookup(encoding or 'utf-8').name
    except LookupError:
        return text, _fault(encoding)
    if name == 'utf-8':
        return text, ''
    if declared is not None and _ALLOWED.fullmatch(name) is None:
        msg = (f'the encoding "{encoding}" is not supported; UTF-8, UTF-16, UTF-32, ASCII, '
               'ISO-8859 and windows-125x are')
        raise FileReadError(msg, Place(path, 1))
    try:
        return text.decode(name).encode(), ''
    except UnicodeDecodeError:
        return text, _fault(encoding)


def _fault(encoding: str) -> str:
    return f'the text is not in the encoding "{encoding}"; UTF-8 is used'
