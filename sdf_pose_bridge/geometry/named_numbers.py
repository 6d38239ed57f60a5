# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read texts in which names say what numbers are, in one pass.

This is what is common to YAML, JSON, XML, the text of protobuf, calls and lists of Python and C++,
options of commands, and words before numbers: brackets, elements and indentation belong to names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import re

from sdf_pose_bridge.geometry.formats import PoseFormatError

_DEEPEST = 50
"""The most names in one another."""

_NUMBER = r'[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?'
_TOKEN = re.compile(rf"""
    (?P<skipped><!--.*?(?:-->|\Z)|<[?!][^>]*>?|(?:(?<=\s)|\A)(?:\#|//|%)[^\n]*|!!?[\w-]*|\\\r?\n
        |[^\S\n]+)
    |\n(?P<line>[ \t]*)
    |</(?P<end>[\w:.-]*)[^<>]*>?
    |(?<!\w)<(?P<element>[A-Za-z][\w:.-]*)
    |(?P<bound>/?>)
    |(?<![\w-])(?P<option>--[A-Za-z][\w-]*)
    |(?P<dash>-(?=\s|\Z))
    |(?P<number>(?<![\w.]){_NUMBER})
    |(?P<key>"[^"\n]*"|'[^'\n]*'|[A-Za-z_][\w.-]*)[ \t]*(?::=|:(?!:)|=)
    |(?P<string>"[^"]*"|(?<!\w)'[^'\n]*')
    |(?P<word>[A-Za-z_][\w.-]*(?:::[\w.]+)*|(?<=\s)\([A-Za-z_][\w ]*\))
    |(?P<opening>[\[({{])
    |(?P<closing>[\])}}])
    |(?P<separator>[,;])
    |(?P<sign>.)""", re.VERBOSE | re.ASCII | re.DOTALL)
_LIST = re.compile(r'\b(array|matrix|tensor|list|tuple|dict)\Z')
_TYPE = re.compile(r'\b[A-Z]\w*[a-z]\w*\Z')
_CLOSING = {'[': ']', '(': ')', '{': '}'}
_ROOT, _TAG, _CONTENT = 'end of text', 'end of tag', 'end of element'
SCALARS = frozenset((
    *'xyzwXYZWABCPR', *'qx qy qz qw roll pitch yaw sec nanosec secs nsecs'.split()))
"""Names of single numbers."""

is_number = re.compile(_NUMBER, re.ASCII).fullmatch


@dataclass(slots=True)
class Named:
    """A name with the numbers and other words that belong to it, but to no name in it."""

    name: str
    path: tuple[str, ...]
    """
    The names around it, and its own.

    Items of lists are numbers such as ``#1``; ``a<2`` is an element, and ``a{3`` has a bracket.
    """
    words: list[str]
    """Shared with a name around it if it has none."""
    kind: str = ''
    """The kind of the token that began it."""
    end: str = ''
    """The bracket or element that ends it; empty for names, which others end."""
    column: int = 0
    line: int = 0
    around: str = ''
    """The innermost name around it; empty if that is the text or an item of a list."""
    is_attribute: bool = False
    """Whether it is directly in an element."""
    is_used: bool = False
    """Whether words or names are in it."""
    has_names: bool = False
    """Whether names without brackets are in it."""
    has_scalars: bool = False


def named_from_text(text: str) -> Sequence[Named]:
    """
    Read a text.

    :return: the names in the order of the text; the first one is the text itself.
    :raises PoseFormatError: if it is too deep.
    """
    reader = _Reader()
    reader.read(text, is_first=True)
    return reader.found


class _Reader:

    def __init__(self) -> None:
        self.found = [Named('', (), [], end=_ROOT)]
        self._open = self.found[:]
        """The names and brackets around the next token."""
        self._words: list[str] = []
        """Words that may be the name of what follows."""
        self._line, self._column, self._is_first, self._count = 0, 0, True, 0

    def read(self, text: str, *, is_first: bool = False) -> None:
        """Read a text, or a string in it, which begins no line."""
        begin = 0
        for token in _TOKEN.finditer(text):
            kind = str(token.lastgroup)
            if kind == 'line':
                self._flush()
                self._line, is_first, begin = self._line + 1, True, token.start() + 1
            elif kind != 'skipped':
                self._column, self._is_first = token.start() - begin, is_first
                if is_first:
                    self._begin_line(is_row=kind in ('number', 'opening', 'dash'))
                is_first = False
                self._read_token(kind, token[kind])
        self._flush()

    def _read_token(self, kind: str, part: str) -> None:
        top = self._open[-1]
        if kind in ('word', 'sign'):
            self._words.append(part)
            return
        if kind == 'number' and self._words and (
                top.kind != 'key' or top.is_used or self._words[0] in SCALARS):
            if top.kind == kind:
                self._open.pop()
            self._begin(kind, self._name())
        elif kind == 'opening':
            is_value, name = not top.is_used and top.kind != kind, self._name()
            if name:
                self._end_value(name)
            # A type of a message is no name.
            is_type = part == '(' and (_LIST.search(name) or (
                is_value and top.kind == 'key' and _TYPE.search(name)))
            self._begin(kind, '' if is_type else name, _CLOSING[part], is_item=not is_value)
            return
        self._flush()
        top = self._open[-1]
        if kind == 'number':
            top.words.append(part)
            top.is_used = True
        elif kind == 'string':
            self._read_string(part[1:-1].strip())
        elif kind == 'key':
            name = part.strip('\'"')
            self._end_value(name)
            self._begin(kind, name)
        elif kind == 'option':
            if top.kind == kind:
                self._open.pop()
            self._begin(kind, part)
        elif kind == 'dash' and (self._is_first or (top.kind == kind and not top.is_used)):
            self._begin(kind, '', is_item=True)
        elif kind == 'element':
            self._begin(kind, part, _TAG)
        elif kind == 'bound':
            self._end_tag(is_empty=part == '/>')
        elif kind in ('closing', 'end'):
            self._end(part if kind == 'closing' else _CONTENT, part)
        elif part == ';':
            self._end_value('')

    def _read_string(self, text: str) -> None:
        words, depth, top = text.split(), len(self._open), self._open[-1]
        if text.startswith(('--', '<', '{', '[')):
            self.read(text)
            if not text.startswith('--'):
                del self._open[depth:]
        else:
            top.words += words if words and all(map(is_number, words)) else [text]
            top.is_used = True

    def _name(self) -> str:
        name, self._words = ' '.join(self._words), []
        return name

    def _flush(self) -> None:
        if self._words:
            self._open[-1].words += self._words
            self._open[-1].is_used, self._words = True, []

    def _begin_line(self, *, is_row: bool) -> None:
        """End names by the indentation; in brackets and elements, those with values."""
        is_indented = next(each.end for each in reversed(self._open) if each.end) == _ROOT
        while not (top := self._open[-1]).end:
            is_at_column = top.column == self._column and is_row and top.kind != 'dash'
            if (top.column < self._column or is_at_column) if is_indented else not top.is_used:
                break
            self._open.pop()

    def _begin(self, kind: str, name: str, end: str = '', *, is_item: bool = False) -> None:
        if len(self._open) > _DEEPEST:
            msg = f'the text has more than {_DEEPEST} names and brackets in one another'
            raise PoseFormatError(msg)
        top, self._count = self._open[-1], self._count + 1
        # Brackets and elements of one name are several, but keys are given twice.
        mark = '<' if end == _TAG else '{' if name and end else '#' if is_item else ''
        part = f'{name}{mark}{self._count}' if mark else name
        new = Named(name or ('' if is_item else top.name), (*top.path, part) if part else top.path,
                    [] if name else top.words, kind, end, self._column, self._line,
                    top.name, is_attribute=top.kind == 'element')
        if name:
            self.found.append(new)
        top.is_used = True
        top.has_names |= not end
        top.has_scalars |= name in SCALARS
        self._open.append(new)

    def _end_value(self, name: str) -> None:
        """End the name that has its value before another one in its line."""
        top = self._open[-1]
        if self._is_first or top.end or top.kind == 'dash':
            return
        if top.is_used and not top.has_names:
            self._open.pop()
            top = self._open[-1]
        # In lines of YAML that became one, only single numbers are beside single numbers.
        if not top.end and top.kind != 'dash' and top.line == self._line and (
                top.has_scalars and name not in SCALARS):
            self._open.pop()

    def _end_tag(self, *, is_empty: bool) -> None:
        while not self._open[-1].end:
            self._open.pop()
        if self._open[-1].end == _TAG:
            self._open[-1].end = _CONTENT
            del self._open[len(self._open) - is_empty:]

    def _end(self, end: str, name: str) -> None:
        """End the innermost bracket, or element of this name, if there is one, and those in it."""
        for index in range(len(self._open) - 1, 0, -1):
            if self._open[index].end == end and (end != _CONTENT or (
                    self._open[index].name == name)):
                del self._open[index:]
                return
