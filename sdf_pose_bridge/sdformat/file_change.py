# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A change of a file: other bytes in one range of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sdf_pose_bridge.errors import FileWriteError, Place
from sdf_pose_bridge.names import printable, shortened
from sdf_pose_bridge.sdformat.file_replacement import RefusedError, replace_range

_LINES_AROUND = 3
_LONGEST_PART = 1000
_LONGEST_LINE = 4000
_MOST_LINES = 100


class FileChange(NamedTuple):
    """Other bytes in one range of a file."""

    path: str
    """The file."""
    old_text: bytes
    """Its whole content."""
    encoding: str
    """Python's name of its encoding."""
    begin: int
    """The first byte of the range."""
    end: int
    """The byte behind it."""
    new: bytes
    """The new content of the range."""

    @property
    def new_text(self) -> bytes:
        """The whole new content of the file."""
        return b''.join([self.old_text[:self.begin], self.new, self.old_text[self.end:]])

    @property
    def undone(self) -> FileChange:
        """The change that restores the old content of the range after this one was written."""
        return FileChange(
            self.path, self.new_text, self.encoding, self.begin, self.begin + len(self.new),
            self.old_text[self.begin:self.end])

    def write(self) -> None:
        """
        Write the file; it keeps its mode, owner, access list, attributes, and links to it.

        :raises FileWriteError: if it cannot be written, or has changed since it was read; it is
            unchanged then.
        """
        if self.new == self.old_text[self.begin:self.end]:
            return
        try:
            replace_range(self.path, self.old_text, self.begin, self.end, self.new)
        except RefusedError as error:
            raise FileWriteError(str(error), Place(self.path)) from error

    @property
    def diff(self) -> str:
        """
        The change as a unified diff; empty if there is none.

        Characters that cannot be printed are escaped; very long lines are shortened to the part
        around the change.
        """
        before, old, behind, new = (text.decode(self.encoding) for text in (
            self.old_text[:self.begin], self.old_text[self.begin:self.end],
            self.old_text[self.end:], self.new))
        if old == new:
            return ''
        *above, head = before.rsplit('\n', _LINES_AROUND + 1)[-_LINES_AROUND - 1:]
        rest = behind.split('\n', _LINES_AROUND + 1)
        tail, *below = rest[:_LINES_AROUND + 1]
        end = ''
        if len(rest) == 1 + len(below):
            # The last one is the text behind the last line break of the file.
            if below and not below[-1]:
                below.pop()
            else:
                end = '\\ No newline at end of file\n'
        old_lines, new_lines = (
            f'{_end(head)}{text}{_beginning(tail)}'.split('\n') for text in (old, new))
        # The range may begin or end with text that stays, such as the tag before a new pose.
        first = _equal_lines(old_lines, new_lines)
        if end and not below:
            first = min(first, len(old_lines) - 1, len(new_lines) - 1)
        last = _equal_lines(old_lines[first:][::-1], new_lines[first:][::-1])
        above = [*above, *old_lines[:first]][-_LINES_AROUND:]
        below = [*old_lines[len(old_lines) - last:], *below]
        if len(below) > _LINES_AROUND:
            below, end = below[:_LINES_AROUND], ''
        old_lines, new_lines = (
            lines[first:len(lines) - last] for lines in (old_lines, new_lines))
        line = before.count('\n') + 1 + first - len(above)
        around = len(above) + len(below)
        return ''.join([
            f'--- {printable(self.path)}\n+++ {printable(self.path)}\n',
            f'@@ -{line},{around + len(old_lines)} +{line},{around + len(new_lines)} @@\n',
            _marked(' ', above),
            _marked('-', old_lines), '' if below else end,
            _marked('+', new_lines), '' if below else end,
            _marked(' ', below), end if below else ''])


def _equal_lines(old: Sequence[str], new: Sequence[str]) -> int:
    """Return the number of equal lines at the beginning of both."""
    pairs = zip(old, new, strict=False)
    return next(
        (row for row, (a, b) in enumerate(pairs) if a != b), min(len(old), len(new)))


def _end(line: str) -> str:
    """Return the end of the text before the change in its line."""
    return line if len(line) <= _LONGEST_PART else f'...{line[-_LONGEST_PART:]}'


def _beginning(line: str) -> str:
    """Return the beginning of the text behind the change in its line."""
    return line if len(line) <= _LONGEST_PART else f'{line[:_LONGEST_PART]}...'


def _marked(mark: str, lines: Sequence[str]) -> str:
    """Return lines of a diff; tabs, and the carriage returns at their ends, stay."""
    shown = []
    if len(lines) > _MOST_LINES:
        lines = [*lines[:_MOST_LINES // 2], '...', *lines[-_MOST_LINES // 2:]]
    for line in lines:
        text = shortened(line.removesuffix('\r'), _LONGEST_LINE)
        end = '\r' if line.endswith('\r') else ''
        shown.append(f'{mark}{chr(9).join(map(printable, text.split(chr(9))))}{end}\n')
    return ''.join(shown)
