# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find the poses in a text with names."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import takewhile
import re
from typing import NamedTuple

from sdf_pose_bridge.geometry import pose_names as tables
from sdf_pose_bridge.geometry.formats import (
    Format,
    format_from_name,
    POSE_FORMATS,
    PoseFormatError,
)
from sdf_pose_bridge.geometry.named_numbers import is_number, Named, named_from_text, SCALARS
from sdf_pose_bridge.geometry.pose_attributes import (
    boolean_from_text,
    FORMAT_ATTRIBUTES,
    pose_format_from_attributes,
)
from sdf_pose_bridge.geometry.pose_names import FORMATS, name_in_tables, Names, numbers_of
from sdf_pose_bridge.geometry.units import DEGREES, RADIANS
from sdf_pose_bridge.printed_text import listed, shortened


class FoundPose(NamedTuple):
    """A pose or rotation in a text."""

    words: Sequence[str]
    """Its numbers, as they are written."""
    format: Format
    text: str
    """The names that say the format, for people; empty if none does."""
    path: tuple[str, ...]
    """The names around it."""
    notes: tuple[str, ...] = ()
    """Clauses for people."""
    name: str = ''
    """The name of a pose in a list; empty if it has none."""


def poses_from_text(text: str, source: Format | None) -> Sequence[FoundPose]:
    """
    Find a pose, or a list of poses.

    :param source: the requested format, in which numbers are that other names do not define.
    :return: none if no name is that of a pose.
    :raises PoseFormatError: if names are missing, left over or there twice, or if several poses
        are no list.
    """
    is_abb = source is not None and source.name == 'abb'
    frames = [*tables.FRAME_OF_ABB.finditer(text)]
    targets = [match for match in frames if match[2] or is_abb]
    if len(targets) == 1:
        words = re.findall(r'[^\s,\[\]]+', targets[0][1])
        return [FoundPose(words, POSE_FORMATS['abb'], 'a target of ABB', ())]
    search = _Search(named_from_text(text), source)
    if frames[1:]:
        search.add_fault(99, f'the text has {len(frames)} frames; give one with --from abb')
    if search.fault[1] and not search.poses:
        raise PoseFormatError(search.fault[1])
    return search.list_of_poses()


def _plain(name: str) -> str:
    """Return a name of a text without what tells it from others of the same name."""
    return re.sub('[<{#][0-9]+$', '', name)


def _text(names: Sequence[str]) -> str:
    return ' '.join(name.lstrip('@') for name in names)


_ZEROS = tables.names_of('', 'sdf_rpy', '0 0 0')


class _Search:
    """Finds poses by the names in a text."""

    def __init__(self, found: Sequence[Named], source: Format | None) -> None:
        self.poses: list[FoundPose] = []
        self.fault = 0, ''
        """Why names are no pose, behind the number of those that are right."""
        self._source = source
        self._groups: dict[tuple[str, ...], dict[str, Named]] = {}
        """By a path the names in it, and ``a.b`` for those in these."""
        self._twice: set[tuple[tuple[str, ...], str]] = set()
        self._changes: dict[tuple[str, ...], str] = {}
        """By a path the first name in it that may say what numbers are."""
        self._used: set[tuple[str, ...]] = set()
        """The paths of what is in a pose or beside it."""
        for each in found[1:]:
            if not tables.PARTS_OF_ECHO.isdisjoint(each.path):
                each.path = tuple(part for part in each.path if part[0] != '#')
            if each.kind == 'element' and not each.words:
                continue
            name = name_in_tables(each.name, is_attribute=each.is_attribute)
            self._add(each.path[:-1], name, each)
            if each.around:
                self._add(each.path[:-2], f'{name_in_tables(each.around)}.{name}', each)
            if each.words and tables.UNIT.fullmatch(name) and not (
                    each.is_attribute and each.around == 'pose'):
                msg = f'"{shortened(name)}" is left over; numbers with units need names of these'
                raise PoseFormatError(msg)
        self._compiler = {
            each.name: ' '.join(each.words) for each in found if each.around == 'compiler'}
        for path, group in self._groups.items():
            if not tables.KNOWN.isdisjoint(group):
                self._read_group(path)
        for each in found[1:]:
            if each.path not in self._used and (each.words or each.kind == 'element'):
                self._read_words(each)
        self.poses = [each for each in self.poses if each.path not in self._used]
        if not self.poses and source is not None:
            self.poses = [
                FoundPose(numbers, source, '', each.path) for each in found[1:]
                if len(numbers := numbers_of(each)[0]) == source.row_length]

    def _add(self, path: tuple[str, ...], name: str, named: Named) -> None:
        group = self._groups.setdefault(path, {})
        if name in group:
            self._twice.add((path, name))
        group[name] = named
        if named.words and tables.CHANGES.fullmatch(name):
            self._changes.setdefault(path, name)

    def add_fault(self, nearness: int, message: str) -> None:
        """Keep the fault of the names that are nearest to a pose."""
        self.fault = max(self.fault, (nearness, message))

    def list_of_poses(self) -> Sequence[FoundPose]:
        """Return the poses; several ones have names, and are at the same depth in one list."""
        if not self.poses[1:]:
            return self.poses
        paths = [pose.path for pose in self.poses]
        places = [place for place, parts in enumerate(zip(*paths, strict=False)) if {*parts} != {
            paths[0][place]}]
        if len(places) != 1 or len({*map(len, paths)}) > 1 or len(
                {pose.format.name for pose in self.poses}) > 1:
            names = dict.fromkeys(
                '.'.join(_plain(part) or part for part in path) for path in paths)
            msg = f'the text has several poses, which are no list: {listed([*names], 3)}'
            raise PoseFormatError(msg)
        return [pose._replace(name=self._name_of(pose.path, places[0])) for pose in self.poses]

    def _name_of(self, path: tuple[str, ...], place: int) -> str:
        """Return the name of an item of a list, at a place of its path; empty if it has none."""
        for end in range(len(path), place, -1):
            for name in ('child_frame_id', 'name'):
                if (named := self._groups.get(path[:end], {}).get(name)) is not None:
                    return ' '.join(named.words)
        return path[place] if path[place] == _plain(path[place]) else ''

    # Names of a group

    def _read_group(self, path: tuple[str, ...]) -> None:
        group = self._groups[path]
        arguments = group.get('args') or group.get('arguments')
        if arguments and any(each.words == [tables.PUBLISHER] for each in group.values()):
            self._read_call(tables.PUBLISHER, ' '.join(arguments.words).split(), path)
        position = self._part(path, tables.POSITIONS)
        rotation = self._part(path, tables.ROTATIONS)
        part = position or rotation
        if part is None:
            return
        around = next(filter(None, map(_plain, reversed(path))), '').lower()
        if not rotation and 'w' in group and around in ('', 'quaternion'):
            rotation = self._part(path, tables.QUATERNION)
        if rotation and (text := tables.TEXTS.get(rotation.format)):
            self._add_pose(path, rotation, FORMATS[rotation.format], text)
            return
        first, _, is_dotted = part.names[0].partition('.')
        may_be_missing = around == 'origin' or first[:2] == '--' or bool(
            is_dotted and around in ('pose', 'poses') and first in group
            and group[first].name.lower() in tables.OF_ROS)
        others = dict.fromkeys(
            name for each in (tables.ROTATIONS if position else tables.POSITIONS)
            if each.format not in tables.TEXTS
            for name in (*each.names, each.names[0].partition('.')[0]) if name in group)
        if not others:
            rotation = rotation or (_ZEROS if may_be_missing or part.names[0] == '@pos' else None)
            position = position or (_ZEROS if may_be_missing else None)
        if position and rotation:
            self._read_parts(path, position, rotation)
            return
        what = 'rotation' if position else 'position, such as x y z'
        if wrong := [name.lstrip('@') for name in others if name not in ('t', 'T')]:
            hint = '' if all(len(group[each].words) != 4 for each in others) else (
                '; the order of four numbers is not said: x y z w is sdf_quat_xyzw, and w x y z is'
                ' mujoco')
            raise PoseFormatError(self.fault[1] or (
                f'"{listed(wrong)}" beside {_text(part.names)} is no {what}{hint}'))
        if len(part.numbers) < 9:
            self.add_fault(len(part.numbers), f'the text has {_text(part.names)} without a {what}')

    def _read_parts(self, path: tuple[str, ...], position: Names, rotation: Names) -> None:
        names, group = position.names + rotation.names, self._groups[path]
        text = '<origin>' if path and _plain(path[-1]) == 'origin' else (
            tables.PUBLISHER if names[0][:2] == '--' else ', '.join(dict.fromkeys(
                _plain(group[name].path[len(path)]) for name in names if name in group)))
        if rotation.format == 'euler':
            axes = self._compiler.get('eulerseq', 'xyz')
            pose_format = format_from_name(
                f'{"r" if axes.islower() else "s"}{axes.lower()}', POSE_FORMATS)._replace(
                angle=RADIANS if self._compiler.get('angle') == 'radian' else DEGREES)
        else:
            pose_format = FORMATS[rotation.format]
        numbers = [*position.numbers, *rotation.numbers]
        self._add_pose(path, rotation._replace(names=names, numbers=numbers), pose_format, text)

    def _part(self, path: tuple[str, ...], parts: Sequence[Names]) -> Names | None:
        """Return the first position or rotation that is complete; raise an error for one twice."""
        group = self._groups[path]
        for part in parts:
            hits = [name for name in part.names if name in group]
            around = group.get(part.names[0].rpartition('.')[0])
            if not hits and not (part.numbers and around and not around.words and (
                    around.path not in self._groups)):
                continue
            numbers = {name: numbers_of(group[name])[0] for name in hits}
            wrong = [name for name in hits if len(numbers[name]) != part.width]
            missing, filled = [name for name in part.names if name not in hits], part.numbers
            if around and around.name.lower() not in tables.OF_ROS:
                filled = []
            if filled and 'orientation.w' in missing and any(
                    float(number) for each in numbers.values() for number in each):
                # Protobuf leaves out zeros. In a message of ROS, 1 would be the default.
                is_protobuf = around is not None and around.kind == 'opening'
                filled, missing = ([*'0000'], missing) if is_protobuf else ([], missing[-1:])
            if wrong:
                is_one, words = part.width == 1, group[wrong[0]].words
                # Lists of other lengths may be of other names.
                if is_one or not all(map(is_number, words)):
                    text = ' '.join(words)
                    hint = '; replace it first, as xacro does' if '$' in text else ''
                    self.add_fault(len(hits), f'"{_text(wrong[:1])}" is {shortened(text)!r}, not'
                                   f' {"a number" if is_one else f"{part.width} numbers"}{hint}')
            elif missing and not filled:
                self.add_fault(len(hits), f'{_text(missing)} is missing beside {_text(hits)}')
            elif twice := [name for name in hits if (path, name) in self._twice]:
                msg = f'"{_text(twice[:1])}" is given twice'
                raise PoseFormatError(msg)
            else:
                words = [word for index, name in enumerate(part.names)
                         for word in numbers.get(name, filled[index:index + 1])]
                return part._replace(names=(*hits,) or part.names, numbers=words)
        return None

    def _add_pose(
        self, path: tuple[str, ...], part: Names, pose_format: Format, text: str,
    ) -> None:
        """Add a pose; raise an error for names that are left over."""
        names, around = part.names, {name.rpartition('.')[0] for name in part.names}
        is_mjcf = any(name[:1] == '@' for name in names)
        for name, named in self._groups[path].items():
            (numbers, unit), what = numbers_of(named), ''
            if name in names or name in around or name == 'matrix':
                self._used.add(named.path)
            if name in names:
                if unit not in ('', pose_format.length.name, pose_format.angle and (
                        pose_format.angle.name)):
                    what = f'is in {unit}, and {pose_format.name} is not'
            elif not (name in around or '<' in named.path[len(path)] or (
                    tables.BESIDE.fullmatch(name)) or (
                    is_mjcf and tables.BESIDE_MJCF.fullmatch(name))) and (
                    numbers or (named.words and tables.CHANGES.fullmatch(name))):
                what = 'is left over beside the pose'
            if what:
                msg = f'"{shortened(name.lstrip("@"))}" {what}'
                raise PoseFormatError(msg)
        self.poses.append(FoundPose(part.numbers, pose_format, text, path))

    # Words of one name

    def _read_words(self, named: Named) -> None:
        name = named.name.split(' ')[-1]
        if name == 'pose' and named.kind == 'element':
            self._read_element(named)
        elif name == 'origin' and named.kind == 'element':
            if named.path not in self._groups:
                self.poses.append(
                    FoundPose([*'000000'], POSE_FORMATS['sdf_rpy'], '<origin>', named.path))
        elif name == tables.PUBLISHER or (name in tables.CALLS and named.kind == 'opening'):
            self._read_call(name, named.words, named.path)
        elif len(numbers := numbers_of(named)[0]) >= 9 and not tables.NO_POSE.fullmatch(
                named.name.lower()):
            self._read_matrix(named, numbers)

    def _read_matrix(self, named: Named, numbers: Sequence[str]) -> None:
        name, count, path = shortened(named.name), len(numbers), named.path[:-1]
        if (pose_format := tables.MATRICES.get(count)) is None:
            if count < 16:
                self.add_fault(1, f'"{name}" has {count} numbers; a matrix has 9, 12 or 16')
            return
        if left_over := self._changes.get(path) or (count == 9 and next((
                other for other, each in self._groups[path].items()
                if each is not named and numbers_of(each)[0] and not tables.BESIDE.fullmatch(other)
                and not tables.NO_POSE.fullmatch(other)), '')):
            msg = f'"{shortened(left_over)}" is left over beside {name}'
            raise PoseFormatError(msg)
        if self._source and len(self._source.columns) == 9 and (
                bool(self._source.position) is bool(pose_format.position)):
            pose_format = self._source
        elif pose_format.position and tables.COLUMN_MAJOR.fullmatch(named.name):
            pose_format = POSE_FORMATS['franka_matrix']
        if count == 12 and pose_format.last_row[0] != 12:
            self.add_fault(12, f'"{name}" has 12 numbers, and {pose_format.name} has 16')
        else:
            if count == 12:
                pose_format = pose_format._replace(last_row=())
            self.poses.append(FoundPose(numbers, pose_format, f'the matrix {name}', named.path))

    def _read_call(self, name: str, words: Sequence[str], path: tuple[str, ...]) -> None:
        """Read all numbers of a format behind a name, without the frames behind them."""
        numbers = [*takewhile(is_number, words)] if name == tables.PUBLISHER else words
        text, *names = tables.CALLS[name]
        formats = {FORMATS[each].row_length: FORMATS[each] for each in names}
        if pose_format := formats.get(len(numbers)):
            self.poses.append(FoundPose(numbers, pose_format, text, path))
        elif name != tables.PUBLISHER:
            msg = f'{text} has 6 numbers, and this one {len(words)}'
            raise PoseFormatError(msg)
        elif words and words[0][:2] != '--':
            self.add_fault(9, f'{name} has {len(numbers)} numbers; it takes x y z yaw pitch roll,'
                           ' or x y z qx qy qz qw')

    def _read_element(self, named: Named) -> None:
        """Read a ``<pose>`` of SDFormat, by its attributes."""
        attributes = {name: ' '.join(each.words)
                      for name, each in self._groups.get(named.path, {}).items()}
        if not attributes.keys().isdisjoint(SCALARS):
            return
        given = pose_format_from_attributes(
            **{name: attributes.get(name, '') for name in FORMAT_ATTRIBUTES})
        if (degrees := attributes.get('degrees')) and boolean_from_text(degrees) is None:
            msg = f'degrees="{shortened(degrees)}" is not a boolean (true, false, 1 or 0)'
            raise PoseFormatError(msg)
        pose_format = POSE_FORMATS['sdf_quat_xyzw' if given.is_quaternion else (
            'sdf_rpy_degrees' if given.is_degrees else 'sdf_rpy')]
        words = named.words or [*'0000001'[:pose_format.row_length]]
        if len(words) != pose_format.row_length or not all(map(is_number, words)):
            msg = (f'<pose> has {pose_format.row_length} numbers ({pose_format.meaning}), and this'
                   f' one "{shortened(" ".join(words))}"')
            raise PoseFormatError(msg)
        self.poses.append(FoundPose(words, pose_format, '<pose>', named.path, (*(
            f'{shortened(name)}="{shortened(value)}" of <pose> is not defined in SDFormat'
            for name, value in attributes.items()
            if name not in ('relative_to', *FORMAT_ATTRIBUTES)),)))
