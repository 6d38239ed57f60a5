# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Change a pose in the text of a file, and no other byte.

The reader gives the place of a pose by the line in which its start tag begins, so it gets the same
text with other line breaks, in which each line has one start tag.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import count
import os
from pathlib import Path
import re

from lxml import etree

from sdf_pose_bridge.errors import Place, PoseNotSetError
from sdf_pose_bridge.file_change import FileChange
from sdf_pose_bridge.geometry.formulas import degrees_from_radians
from sdf_pose_bridge.geometry.pose_attributes import PoseFormat, PoseTextError
from sdf_pose_bridge.geometry.poses import Pose, relative_pose
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.poses import pose_format_of, pose_from_text
from sdf_pose_bridge.sdformat.source_formats import source_format_of, SourceFormat
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.urdf.robot import robot_from_tree, RobotJoint
from sdf_pose_bridge.sdformat.urdf.values import pose_from_xyz_rpy
from sdf_pose_bridge.sdformat.values import number_from_word
from sdf_pose_bridge.sdformat.versions import Version, version_of
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file, START_TAG, xml_from_bytes
from sdf_pose_bridge.sdformat.xml_tree import first_child, text_of, words_of, written_tag

_WITH_POSES = Version(1, 4)
_TEXT_AFTER_COMMENTS = re.compile(rb'(?:\s*<!--.*?-->)*([^<]*)', re.DOTALL)
_WORD = re.compile(rb'[^ \t\n\r]+')
_INDENTATION = re.compile(rb'\s*?(\r?\n[ \t]*)?(?=<)')
_SAME_ROTATION = 1e-12
_NO_BREAKS = bytes.maketrans(b'\r\n', b'  ')


class PoseText:
    """
    The text of a file, in which poses can be changed.

    Elements are counted in the order of their start tags, from 0.

    :raises SdfError: if it is not well-formed URDF, or SDFormat 1.4 or newer.
    """

    def __init__(self, content: bytes, path: str) -> None:
        self._path, place = path, Place(path)
        file = xml_from_bytes(content, path)
        root = file.root
        self.source_format = source_format_of(root, place)
        for warning in file.warnings:
            msg = f'{warning.message}; correct this before a pose is set in the file'
            raise PoseNotSetError(msg, warning.place)
        if self.source_format is SourceFormat.SDFORMAT and version_of(root, place) < _WITH_POSES:
            msg = (f'this is SDFormat {root.get("version")}, which writes poses in another way; '
                   f'convert the file to {_WITH_POSES} or newer first')
            raise PoseNotSetError(msg, place)
        self._encoding = file.encoding
        # With its byte order mark.
        self._text = content.decode(self._encoding).encode()
        self.elements = list(root.iter(etree.Element))
        """The elements by their numbers."""
        self._tags = [
            (tag.start(), tag.end(1)) for tag in START_TAG.finditer(self._text) if tag[1]]
        if len(self._tags) != len(self.elements) or self._encoded(self._text) != content:
            msg = f'the text cannot be changed in its encoding, {self._encoding}'
            raise PoseNotSetError(msg, place)

    def with_a_line_for_each_tag(self) -> bytes:
        """Return a text of the same meaning, in which each line has one start tag."""
        lines = []
        position = 0
        for _, end in self._tags:
            cut = end - self._is_closed(end)
            lines.append(self._text[position:cut].translate(_NO_BREAKS))
            position = cut
        return self._encoded(b'\n'.join([*lines, self._text[position:]]))

    def element_at_line(self, line: int) -> int:
        """
        Return the number of an element by its line in :meth:`with_a_line_for_each_tag`.

        :raises PoseNotSetError: if there is none.
        """
        if not 0 < line <= len(self._tags):
            msg = 'the file alone does not place this element'
            raise PoseNotSetError(msg, Place(self._path))
        return line - 1

    def joints_to_move(self, name: str, *, is_included: bool) -> Iterator[tuple[int, RobotJoint]]:
        """Find joints as a ``Robot`` of URDF does, with the elements for :meth:`with_origin`."""
        root, sources = self.elements[0], Sources()
        sources.add_path(self._path)
        sources.add_tree(self._path, root, {})
        for joint in robot_from_tree(root, sources, is_included=is_included).joints_to_move(name):
            origin = first_child(joint.xml, 'origin')
            yield self.elements.index(joint.xml if origin is None else origin), joint

    def is_plain_urdf(self, element: int) -> bool:
        """Return whether neither xacro nor an attribute for a quaternion says the numbers."""
        return self.elements[element].get('quat_xyzw') is None and not (
            self._path.endswith('.xacro')
            or any(written_tag(each).startswith('xacro:') for each in self.elements))

    def line(self, element: int) -> int:
        """Return the line of an element in the unchanged text."""
        return self._text.count(b'\n', 0, self._tags[element][0]) + 1

    def pose(self, element: int) -> Pose:
        """
        Read a pose as written.

        :raises PoseNotSetError: if it is not a ``<pose>``, or does not consist of plain numbers.
        """
        try:
            pose_format = self._format(element)
            text = ' '.join(word[0].decode() for word in self._words(element))
            return pose_from_text(text, pose_format)[0]
        except PoseTextError as error:
            raise PoseNotSetError(str(error), self._place(element)) from error

    def with_pose(self, element: int, pose: Pose, tolerance: float) -> FileChange:
        """
        Change the numbers of a pose.

        :param pose: the new pose, in the frame that this pose is relative to.
        :param tolerance: largest difference of the written pose, in metres and radians.
        :raises PoseNotSetError: as :meth:`pose`.
        """
        old, words = self.pose(element), self._words(element)
        new_words = _words_from_pose(
            pose, self._format(element), tolerance, [word[0].decode() for word in words], old)
        if not words:
            return self._with_content(element, ' '.join(new_words).encode())
        begin, end = words[0].start(), words[-1].end()
        return self._change(begin, end, _with_words(self._text[begin:end], new_words))

    def with_new_pose(self, element: int, pose: Pose, tolerance: float) -> FileChange:
        """
        Insert a pose, indented like the next line, or one step deeper than the end tag.

        :param element: the number of the element that it places.
        """
        words = _words_from_pose(pose, PoseFormat(), tolerance)
        return self._with_child(element, b'<pose>%s</pose>' % ' '.join(words).encode())

    def with_origin(self, element: int, pose: Pose, tolerance: float) -> FileChange:
        """Change an ``<origin>`` of URDF, or insert one into a joint as :meth:`with_new_pose`."""
        xml = self.elements[element]
        is_new = xml.tag != 'origin'
        old = [word for name in ('xyz', 'rpy') for word in words_of(xml.get(name, '0 0 0'))]
        numbers = [number_from_word(word)[0] for word in old]
        words = _words_from_pose(
            pose, PoseFormat(), tolerance, old, pose_from_xyz_rpy(numbers[:3], numbers[3:]))
        begin, end = self._tags[element]
        tag = b'<origin/>' if is_new else self._text[begin:end + 1]
        # A missing attribute becomes the first one.
        for name, new in (b'rpy', words[3:]), (b'xyz', words[:3]):
            value = re.search(rb'\s%s\s*=\s*["\']([^"\']*)' % name, tag)
            if value is not None:
                tag = tag[:value.start(1)] + _with_words(value[1], new) + tag[value.end(1):]
            elif is_new or {*new} != {'0'}:
                tag = tag.replace(
                    b'<origin', b'<origin %s="%s"' % (name, ' '.join(new).encode()), 1)
        return self._with_child(element, tag) if is_new else self._change(begin, end + 1, tag)

    def _with_child(self, element: int, new: bytes) -> FileChange:
        end = self._tags[element][1]
        indentation = _INDENTATION.match(self._text, end + 1)
        if not self._is_closed(end) and indentation is not None and indentation[1]:
            is_empty = self._text.startswith(b'</', indentation.end())
            new = indentation[1] + (self._step(element) if is_empty else b'') + new
        return self._with_content(element, new)

    def _step(self, element: int) -> bytes:
        """Return the indentation of an element relative to its parent; if none, two spaces."""
        parent = next(self.elements[element].iterancestors())
        own, outer = (
            line[:len(line) - len(line.lstrip(b' \t'))]
            for each in (element, self.elements.index(parent))
            for line in [self._text[:self._tags[each][0]].rpartition(b'\n')[2]])
        return own.removeprefix(outer) or b'  '

    def _with_content(self, element: int, content: bytes) -> FileChange:
        end = self._tags[element][1]
        if not self._is_closed(end):
            return self._change(end + 1, end + 1, content)
        end_tag = f'</{written_tag(self.elements[element])}>'.encode()
        return self._change(end - 1, end + 1, b'>' + content + end_tag)

    def _change(self, begin: int, end: int, new: bytes) -> FileChange:
        """Return a change of the file, by its range in the text in UTF-8."""
        parts = self._text[:begin], self._text[begin:end], new, self._text[end:]
        return FileChange(self._path, self._encoding, *map(self._encoded, parts))

    def _format(self, element: int) -> PoseFormat:
        xml = self.elements[element]
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
            words = list(_WORD.finditer(self._text, *text.span(1))) if text else []
        if [word[0].decode() for word in words] != words_of(text_of(self.elements[element])):
            msg = 'the numbers of the pose are not written as plain text'
            raise PoseNotSetError(msg, self._place(element))
        return words

    def _is_closed(self, end: int) -> bool:
        return self._text[end - 1:end] == b'/'

    def _place(self, element: int) -> Place:
        return Place(self._path, self.line(element))

    def _encoded(self, text: bytes) -> bytes:
        return text.decode().encode(self._encoding)


def pose_text_from_file(path: str) -> PoseText:
    """
    Read a file in which a pose shall be changed.

    :raises SdfError: as for :class:`PoseText`, or if it is in the cache of Gazebo Fuel.
    """
    cache = Path(os.path.realpath(resource_finder().fuel_cache))
    if cache in Path(os.path.realpath(path)).parents:
        msg = 'the file is in the cache of Gazebo Fuel; copy the model and include the copy'
        raise PoseNotSetError(msg, Place(path))
    return PoseText(bytes_from_file(path, Usage()), path)


def _words_from_pose(
    pose: Pose, pose_format: PoseFormat, tolerance: float, old_words: Sequence[str] = (),
    old: Pose | None = None,
) -> list[str]:
    """
    Write a pose in the shortest numbers; numbers that are right already stay.

    :param old: the pose of the old words. If its rotation is the same, their angles stay.
    """
    keeps_rotation = old is not None and (
        max(map(abs, relative_pose(old, pose)[3:6])) < _SAME_ROTATION)
    # Together, the errors of all numbers stay within the tolerance.
    numbers = [(metres, tolerance / 2.0) for metres in pose[:3]]
    if pose_format.is_quaternion:
        numbers += [(component, tolerance / 8.0) for component in pose[3:]]
    else:
        unit = degrees_from_radians(1.0) if pose_format.is_degrees else 1.0
        numbers += [
            (angle * unit, tolerance / 4.0 * unit) for angle in rpy_from_quaternion(pose[3:])]
    words = [shortest_decimal(*each) for each in numbers]
    for index, (word, (number, most)) in enumerate(zip(old_words, numbers, strict=False)):
        if abs(number_from_word(word)[0] - number) <= most or (keeps_rotation and index >= 3):
            words[index] = word
    return words


def _with_words(text: bytes, words: Sequence[str]) -> bytes:
    """Return a text with other words, between which the white space stays."""
    remaining = iter(words)
    return _WORD.sub(lambda _: next(remaining).encode(), text)


def shortest_decimal(number: float, tolerance: float) -> str:
    """Return the decimal with the fewest digits that differs by no more than a tolerance."""
    text = next(
        text for digits in count()
        if abs(float(text := f'{number:.{digits}f}') - number) <= tolerance)
    return '0' if float(text) == 0.0 else text
