# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A change of a file: other bytes in one range of it, written in one step, as outputs are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import contextlib
from difflib import unified_diff
import fcntl
from io import StringIO
from itertools import islice
import os
from pathlib import Path
import shutil
import signal
import stat
import tempfile
import threading
from typing import NamedTuple

from sdf_pose_bridge.errors import FileWriteError, Place
from sdf_pose_bridge.printed_text import printable, shortened

_LINES_AROUND = 3
_LONGEST_PART = 1000
_LONGEST_LINE = 4000
_MOST_LINES = 100
_ACCESS_LIST = 'system.posix_acl_access'


class FileChange(NamedTuple):
    """Other bytes in one range of a file."""

    path: str
    encoding: str
    """Python's name of its encoding."""
    before: bytes
    """Its content before the range."""
    old: bytes
    new: bytes
    behind: bytes
    """Its content behind the range."""

    @property
    def new_text(self) -> bytes:
        """The whole new content of the file."""
        return self.before + self.new + self.behind

    @property
    def undone(self) -> FileChange:
        """The change that restores the old content of the range after this one was written."""
        return self._replace(old=self.new, new=self.old)

    def write(self) -> None:
        """
        Write the file; it keeps its mode, owner, access list, attributes, and links to it.

        :raises FileWriteError: if it cannot be written, or has changed since it was read; it is
            unchanged then.
        """
        if self.new != self.old:
            replace_file(self.path, self.before + self.old + self.behind, self.new_text)

    @property
    def diff(self) -> str:
        """
        The change as a unified diff; empty if there is none.

        Characters that cannot be printed are escaped; very long lines are shortened to the part
        around the change.
        """
        before, old, new, behind = (text.decode(self.encoding) for text in self[2:])
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


def replace_file(path: str, old: bytes | None, new: bytes, inputs: Iterable[str] = ()) -> None:
    """
    Replace the content of a file, and keep its mode, owner, access list and attributes.

    The file has its old or its new content at any time. If the process is killed meanwhile, a
    directory ``.sdf_pose_...`` may stay beside the file.

    :param path: the file, or a link to it, which stays a link.
    :param old: its content; None for an output, which may be a new file, or a stream to write to.
    :param inputs: the files that were read, which an output must not replace.
    :raises FileWriteError: if it cannot be written, is one of ``inputs``, has another content than
        ``old``, or is being written by another process; it is unchanged then.
    """
    try:
        reason = _refusal(Path(path), old, new, inputs)
    except BlockingIOError:
        reason = 'another process is writing the file'
    except OSError as error:
        reason = f'the file cannot be written: {(error.strerror or str(error)).lower()}'
    if reason:
        raise FileWriteError(reason, Place(path))


def _refusal(path: Path, old: bytes | None, new: bytes, inputs: Iterable[str]) -> str:
    """Replace the content of a file, or return why it must not be replaced."""
    is_there = old is not None or path.exists()
    with contextlib.ExitStack() as stack:
        if old is None and is_there:
            if path.is_file() and _is_one_of(path, '/dev/stdin', *inputs):
                return 'this file was read, so no output replaces it; name another one'
            if not path.is_file() or _is_one_of(path, '/dev/stdout', '/dev/stderr'):
                stack.enter_context(path.open('ab')).write(new)
                return ''
        if is_there:
            # The rename below would replace a read-only file too, so it is opened for writing.
            # Whatever else takes its place is not waited for, and not read.
            file = stack.enter_context(os.fdopen(os.open(path, os.O_RDWR | os.O_NONBLOCK), 'rb'))
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                return 'it is no regular file any more'
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if status.st_nlink > 1 and old is not None:
                return (f'the file has {status.st_nlink} names (hard links), and the others would '
                        'keep the old text; copy it first, or change it by an editor')
        path = path.resolve()
        stack.enter_context(signals_wait())
        # A directory of its own, as the standard library removes it after any exception.
        new_path = Path(stack.enter_context(
            tempfile.TemporaryDirectory(prefix='.sdf_pose_', dir=path.parent)), path.name)
        with new_path.open('xb') as new_file:
            if is_there:
                # The access list that the directory gives to its files may not be the file's.
                with contextlib.suppress(OSError):
                    os.removexattr(new_path, _ACCESS_LIST)
                try:
                    os.chown(new_path, status.st_uid, status.st_gid)
                except OSError as error:
                    if old is not None:
                        return f'its owner and group cannot be kept: {str(error.strerror).lower()}'
                shutil.copystat(path, new_path)
            # Written last, so that the file has the time of now.
            new_file.write(new)
            new_file.flush()
            os.fsync(new_file.fileno())
        if old is not None and (
                file.read(len(old) + 1) != old or not os.path.samestat(status, path.stat())):
            return 'the file has changed since it was read, so it is not overwritten'
        new_path.replace(path)
    return ''


@contextlib.contextmanager
def signals_wait() -> Iterator[list[int]]:
    """
    Let signals that would end the process at once end it after the block, which removes its files.

    Signals that are handled or ignored, and all in another thread than the first one, do not wait.

    :return: a context manager with the signals that have come.
    """
    came: list[int] = []
    numbers = [
        number for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
        if signal.getsignal(number) is signal.SIG_DFL
        and threading.current_thread() is threading.main_thread()]
    for number in numbers:
        signal.signal(number, lambda number, _: came.append(number))
    try:
        yield came
    finally:
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)
        if came:
            signal.raise_signal(came[0])


def _is_one_of(path: Path, *others: str) -> bool:
    return any(path.samefile(each) for each in map(Path, others) if each.exists())
