# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A change of a file: other bytes in one range of it."""

from __future__ import annotations

from difflib import unified_diff
from io import StringIO
from itertools import islice
from typing import NamedTuple

from sdf_pose_bridge.names import printable, shortened
from sdf_pose_bridge.sdformat.file_replacement import replace_file

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
        if self.new != self.old_text[self.begin:self.end]:
            replace_file(self.path, self.old_text, self.new_text)

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
        *above, head = before.split('\n')
        tail, line_break, below = behind.partition('\n')
        if len(head) > _LONGEST_PART:
            head = f'...{head[-_LONGEST_PART:]}'
        if len(tail) > _LONGEST_PART:
            tail = f'{tail[:_LONGEST_PART]}...'
        # Only the number of the lines far above counts, and equal lines slow difflib down.
        far = [str(row) for row in range(len(above) - _LINES_AROUND)]
        near = [f'{line}\n' for line in above[-_LINES_AROUND:]]
        rest = [*islice(StringIO(below), _LINES_AROUND)]
        old_lines, new_lines = (
            [*far, *near, *StringIO(f'{head}{text}{tail}{line_break}'), *rest]
            for text in (old, new))
        path = printable(self.path)
        lines = [_shown(line) for line in unified_diff(old_lines, new_lines, path, path)]
        if len(lines) > _MOST_LINES:
            lines = [*lines[:_MOST_LINES // 2], '...\n', *lines[-_MOST_LINES // 2:]]
        return ''.join(lines)


def _shown(line: str) -> str:
    """Return a line of a diff; tabs and the characters of a line break stay."""
    text = line.rstrip('\r\n') if line.endswith('\n') else line
    end = line[len(text):] or '\n\\ No newline at end of file\n'
    return '\t'.join(map(printable, shortened(text, _LONGEST_LINE).split('\t'))) + end
