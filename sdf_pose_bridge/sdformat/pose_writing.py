# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Write a pose into a file: change it in the text, and no other byte, and replace the file by that.

The reader says where a pose stands by the line in which its start tag begins. Several tags can
begin in one line. So the place is read from the same text with a line for each tag.

The new text is written to a file without a name, which vanishes with the process. It gets a name
beside the old file only when it is on the disk, and takes the place of the old one at once, by a
process of its own, so that a writer that is killed leaves nothing behind.
"""

from __future__ import annotations

from collections.abc import Sequence
import errno
import fcntl
from itertools import count
import os
from pathlib import Path
import re
import stat
import subprocess
import sys

from lxml import etree
import numpy as np

from sdf_pose_bridge.errors import FileWriteError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import PoseNotSetError
from sdf_pose_bridge.geometry.formulas import degrees_from_radians
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import relative_pose
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.sdformat.poses import pose_format_of
from sdf_pose_bridge.sdformat.poses import pose_from_text
from sdf_pose_bridge.sdformat.poses import PoseFormat
from sdf_pose_bridge.sdformat.poses import PoseTextError
from sdf_pose_bridge.sdformat.versions import Version
from sdf_pose_bridge.sdformat.versions import version_from_text
from sdf_pose_bridge.sdformat.xml_file import START_TAG
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes
from sdf_pose_bridge.sdformat.xml_tree import text_of
from sdf_pose_bridge.sdformat.xml_tree import written_tag

_FIRST_WITH_POSE = Version(1, 4)
_TEXT_AFTER_COMMENTS = re.compile(rb'(?:\s*<!--.*?-->)*([^<]*)', re.DOTALL)
_WORD = re.compile(rb'[^ \t\n\r]+')
_INDENTATION = re.compile(rb'\s*?(\r?\n[ \t]*)?(?=<)')
_SAME_ROTATION = 1e-12


class PoseText:
    """
    The text of a file, in which poses can be changed.

    Elements are counted in the order of their start tags, from 0.

    :param content: the bytes of the file.
    :param path: its path, for errors.
    :raises SdfError: if it is not SDFormat 1.4 or newer as it stands: no XML, XML that has to be
        repaired, URDF, or an older version.
    """

    def __init__(self, content: bytes, path: str) -> None:
        self._path = path
        file = xml_from_bytes(content, path)
        root = file.root
        for warning in file.warnings:
            msg = f'{warning.message}; correct this before a pose is set in the file'
            raise PoseNotSetError(msg, warning.place)
        if root.tag == 'robot':
            msg = 'this is URDF, in which no pose can be set; convert the file to SDFormat first'
            raise PoseNotSetError(msg, Place(path))
        if version_from_text(root.get('version', ''), Place(path)) < _FIRST_WITH_POSE:
            msg = (f'this is SDFormat {root.get("version")}, which writes poses in another way; '
                   f'convert the file to {_FIRST_WITH_POSE} or newer first')
            raise PoseNotSetError(msg, Place(path))
        self._encoding = file.encoding
        # With its byte order mark.
        self._text = content.decode(self._encoding).encode()
        self._elements = list(root.iter(etree.Element))
        self._tags = [
            (tag.start(), tag.end(1)) for tag in START_TAG.finditer(self._text) if tag[1]]
        if len(self._tags) != len(self._elements) or self._encoded(self._text) != content:
            msg = f'the text cannot be changed in its encoding, {self._encoding}'
            raise PoseNotSetError(msg, Place(path))

    def with_a_line_for_each_tag(self) -> bytes:
        """Return a text of the same meaning, in which no two start tags begin in one line."""
        parts = []
        position = 0
        for _, end in self._tags:
            cut = end - self._is_closed(end)
            parts.append(self._text[position:cut])
            position = cut
        return self._encoded(b'\n'.join([*parts, self._text[position:]]))

    def element_at_line(self, line: int) -> int:
        """
        Find an element.

        :param line: its line in :meth:`with_a_line_for_each_tag`.
        :return: the number of the element.
        :raises PoseNotSetError: if no start tag begins there.
        """
        breaks = np.flatnonzero(np.frombuffer(self._text, np.uint8) == ord('\n'))
        starts = np.array([start for start, _ in self._tags])
        lines = np.searchsorted(breaks, starts) + np.arange(len(starts)) + 1
        element = int(np.searchsorted(lines, line))
        if element == len(lines) or lines[element] != line:
            msg = 'the file does not say by itself where this element is'
            raise PoseNotSetError(msg, Place(self._path))
        return element

    def line(self, element: int) -> int:
        """Return the line in which the start tag of an element begins, in the text as it is."""
        return self._text.count(b'\n', 0, self._tags[element][0]) + 1

    def pose(self, element: int) -> Pose:
        """
        Read a pose.

        :param element: the number of a ``<pose>``.
        :return: the pose as written.
        :raises PoseNotSetError: if it is not a ``<pose>``, or not written in plain numbers.
        """
        try:
            pose_format = self._format(element)
            text = ' '.join(word[0].decode() for word in self._words(element))
            return Pose(*pose_from_text(text, pose_format))
        except PoseTextError as error:
            raise PoseNotSetError(str(error), self._place(element)) from error

    def with_pose(self, element: int, pose: Pose, tolerance: float) -> bytes:
        """
        Change a pose.

        :param element: the number of a ``<pose>``.
        :param pose: the new pose, in the frame that this pose is relative to.
        :param tolerance: how much the written pose may differ from it, in metres and radians.
        :return: the text of the file with other numbers in this pose.
        :raises PoseNotSetError: as :meth:`pose`.
        """
        turn = relative_pose(self.pose(element), pose)
        keeps_rotation = max(map(abs, turn[3:6])) < _SAME_ROTATION
        words = self._words(element)
        new_words = _words_from_pose(
            pose, self._format(element), tolerance, [word[0].decode() for word in words],
            keeps_rotation=keeps_rotation)
        if words:
            text = bytearray(self._text)
            for word, new in reversed(list(zip(words, new_words, strict=True))):
                text[slice(*word.span())] = new.encode()
            return self._encoded(bytes(text))
        return self._with_content(element, ' '.join(new_words).encode())

    def with_new_pose(self, element: int, pose: Pose, tolerance: float) -> bytes:
        """
        Insert a pose, indented like what follows it.

        :param element: the number of the element that it places.
        :param pose: as for :meth:`with_pose`.
        :param tolerance: as for :meth:`with_pose`.
        :return: the text of the file with a ``<pose>`` more.
        """
        words = _words_from_pose(pose, PoseFormat(), tolerance)
        new = b'<pose>%s</pose>' % ' '.join(words).encode()
        end = self._tags[element][1]
        indentation = _INDENTATION.match(self._text, end + 1)
        if not self._is_closed(end) and indentation is not None:
            new = (indentation[1] or b'') + new
        return self._with_content(element, new)

    def _with_content(self, element: int, content: bytes) -> bytes:
        """Return the text of the file with content behind the start tag of an element."""
        end = self._tags[element][1]
        is_closed = self._is_closed(end)
        end_tag = f'</{written_tag(self._elements[element])}>' if is_closed else ''
        return self._encoded(
            self._text[:end - is_closed] + b'>' + content + end_tag.encode()
            + self._text[end + 1:])

    def _format(self, element: int) -> PoseFormat:
        xml = self._elements[element]
        if written_tag(xml) != 'pose':
            msg = f'the pose is not written as <pose>, but in <{written_tag(xml)}>'
            raise PoseNotSetError(msg, self._place(element))
        return pose_format_of(xml)

    def _words(self, element: int) -> Sequence[re.Match[bytes]]:
        """Find the numbers of a pose; none if it is blank."""
        end = self._tags[element][1]
        words: list[re.Match[bytes]] = []
        if not self._is_closed(end):
            text = _TEXT_AFTER_COMMENTS.match(self._text, end + 1)
            assert text is not None
            words = list(_WORD.finditer(self._text, *text.span(1)))
        if [word[0].decode() for word in words] != text_of(self._elements[element]).split():
            msg = 'the numbers of the pose are not written as plain text'
            raise PoseNotSetError(msg, self._place(element))
        return words

    def _is_closed(self, end: int) -> bool:
        return self._text[end - 1:end] == b'/'

    def _place(self, element: int) -> Place:
        return Place(self._path, self.line(element))

    def _encoded(self, text: bytes) -> bytes:
        return text.decode().encode(self._encoding)


def _words_from_pose(
    pose: Pose, pose_format: PoseFormat, tolerance: float, old_words: Sequence[str] = (), *,
    keeps_rotation: bool = False,
) -> list[str]:
    """Write a pose in the shortest numbers; those that are right already stay."""
    numbers = [*pose[:3]]
    # An error of each number contributes to that of the pose at most as much as this divides.
    tolerances = [tolerance / 2.0] * 3
    if pose_format.is_quaternion:
        numbers += pose[3:]
        tolerances += [tolerance / 8.0] * 4
    else:
        rpy = rpy_from_quaternion(pose[3:])
        unit = degrees_from_radians(1.0) if pose_format.is_degrees else 1.0
        numbers += [angle * unit for angle in rpy]
        tolerances += [tolerance / 4.0 * unit] * 3
    words = [_shortest(number, each) for number, each in zip(numbers, tolerances, strict=True)]
    for index, old in enumerate(old_words):
        if abs(float(old) - numbers[index]) <= tolerances[index] or (
                keeps_rotation and index >= 3):
            words[index] = old
    return words


def _shortest(number: float, tolerance: float) -> str:
    """Return the decimal with the fewest digits that differs by no more than a tolerance."""
    text = next(
        text for digits in count()
        if abs(float(text := f'{number:.{digits}f}') - number) <= tolerance)
    return '0' if float(text) == 0.0 else text


def replace_file(path: str, old: bytes, new: bytes) -> None:
    """
    Replace the content of a file, which keeps its mode and owner; links to it stay links.

    :param path: path of the file.
    :param old: what it holds, as far as the caller knows.
    :param new: what it shall hold.
    :raises FileWriteError: if it cannot be written, or does not hold ``old``, or another process
        replaces it now; it is as before then.
    """
    try:
        real_path = Path(path).resolve(strict=True)
        with real_path.open('rb') as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not os.access(real_path, os.W_OK):
                raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
            status = os.fstat(file.fileno())
            descriptor = os.open(real_path.parent, os.O_TMPFILE | os.O_WRONLY, 0o600)
            with os.fdopen(descriptor, 'wb') as target:
                target.write(new)
                os.fchown(target.fileno(), status.st_uid, status.st_gid)
                os.fchmod(target.fileno(), stat.S_IMODE(status.st_mode))
                target.flush()
                os.fsync(target.fileno())
                if file.read() != old:
                    raise FileWriteError(_CHANGED, Place(path))
                _put_in_place(target.fileno(), real_path, file.fileno())
    except BlockingIOError as error:
        msg = 'another process is writing the file'
        raise FileWriteError(msg, Place(path)) from error
    except OSError as error:
        msg = f'the file cannot be written: {(error.strerror or str(error)).lower()}'
        raise FileWriteError(msg, Place(path)) from error


def _put_in_place(descriptor: int, path: Path, locked: int) -> None:
    """
    Let another process do the last step, which is done even if this one is killed meanwhile.

    :param descriptor: the new file.
    :param locked: the old file, which stays locked until that process has ended.
    """
    status = os.fstat(locked)
    # Linux has no call that gives a file a name that is in use, so it gets another one first. If
    # all processes are killed just then, the next one that writes the file removes the rest.
    temporary = path.with_name(f'.{path.name}.sdf_pose')
    arguments = [descriptor, temporary, path, status.st_ino, status.st_mtime_ns]
    done = subprocess.run(
        [sys.executable, '-I', '-S', '-c', _LAST_STEP, *map(str, arguments)],
        pass_fds=[descriptor, locked], start_new_session=True, check=False)
    if done.returncode == _HAS_CHANGED:
        raise FileWriteError(_CHANGED, Place(str(path)))
    if done.returncode:
        raise OSError(done.returncode, os.strerror(done.returncode))


_CHANGED = 'the file has changed since it was read, so it is not overwritten'
_HAS_CHANGED = 255
_LAST_STEP = f"""
import contextlib, os, sys
descriptor, temporary, path, *expected = sys.argv[1:]
try:
    folder = os.open(os.path.dirname(path), os.O_RDONLY)
    with contextlib.suppress(FileNotFoundError):
        os.unlink(temporary)
    status = os.stat(path)
    if expected != [str(status.st_ino), str(status.st_mtime_ns)]:
        sys.exit({_HAS_CHANGED})
    # With a descriptor of a directory os.link follows the link in /proc.
    os.link(f'/proc/self/fd/{{descriptor}}', temporary, src_dir_fd=folder)
    os.replace(temporary, path)
    os.fsync(folder)
except OSError as error:
    sys.exit(error.errno)
"""
