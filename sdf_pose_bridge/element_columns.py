# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The table of elements while it grows: one at a time, or a run of many at once."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.elements import element_path
from sdf_pose_bridge.elements import Elements
from sdf_pose_bridge.elements import FrameFacts
from sdf_pose_bridge.elements import Indices
from sdf_pose_bridge.elements import JointFacts
from sdf_pose_bridge.elements import ModelFacts
from sdf_pose_bridge.elements import SensorFacts
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.pose_text import poses_from_texts
from sdf_pose_bridge.pose_text import PoseText

if TYPE_CHECKING:
    import numpy.typing as npt

    from sdf_pose_bridge.element_rows import Columns


class ElementColumns:
    """Columns of :class:`~sdf_pose_bridge.elements.Elements`, to which rows can be added."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.relative_to: dict[int, str] = {}
        self.models: dict[int, ModelFacts] = {}
        self.frames: dict[int, FrameFacts] = {}
        self.joints: dict[int, JointFacts] = {}
        self.sensors: dict[int, SensorFacts] = {}
        self._kinds = array('B')
        self._parents = array('i')
        self._scopes = array('i')
        self._files = array('i')
        self._lines = array('i')
        self._pose_lines = array('i')
        self._posed = array('i')
        self._texts: list[str] = []
        self._quaternions = array('i')
        self._degrees = array('i')

    def __len__(self) -> int:
        """Count the elements."""
        return len(self.names)

    def kind(self, index: int) -> Kind:
        """
        Tell what an element is.

        :param index: its index.
        :return: its kind.
        """
        return Kind(self._kinds[index])

    def parent(self, index: int) -> int:
        """
        Tell what holds an element.

        :param index: its index.
        :return: index of its holder; -1 for none.
        """
        return self._parents[index]

    def file(self, index: int) -> int:
        """
        Tell which file an element stands in.

        :param index: its index.
        :return: index of the file.
        """
        return self._files[index]

    def line(self, index: int) -> int:
        """
        Tell which line an element stands in.

        :param index: its index.
        :return: the line.
        """
        return self._lines[index]

    def path(self, index: int) -> str:
        """
        Return the path of an element.

        :param index: its index; -1 for the document itself.
        :return: as :func:`~sdf_pose_bridge.elements.element_path` does.
        """
        return element_path(self._kinds, self.names, self._parents, index)

    def append(
        self, kind: Kind, name: str, parent: int, scope: int, file: int, line: int, pose_line: int,
    ) -> int:
        """
        Add an element, in the order of the columns.

        :return: its index.
        """
        index = len(self.names)
        self.names.append(name)
        self._kinds.append(kind)
        self._parents.append(parent)
        self._scopes.append(scope)
        self._files.append(file)
        self._lines.append(line)
        self._pose_lines.append(pose_line)
        return index

    def set_pose(self, index: int, pose: PoseText) -> None:
        """
        Say where the element that was added last is.

        :param index: its index.
        :param pose: its pose as written.
        """
        if pose.is_quaternion:
            self._quaternions.append(len(self._texts))
        if pose.is_degrees:
            self._degrees.append(len(self._texts))
        self._posed.append(index)
        self._texts.append(pose.text)

    def append_run(
        self, rows: Columns, start: int, end: int, scope: int, holder: int, file: int,
    ) -> None:
        """
        Add a run of rows: children of one model or world, and all that they hold.

        :param rows: those of a document.
        :param start: the first row.
        :param end: the row after the last.
        :param scope: the row of the model or world, -1 for the document itself.
        :param holder: the element that this is.
        :param file: index of the file that they stand in.
        """
        run = slice(start, end)
        offset = len(self.names) - start
        self.names += rows.names[run]
        self._kinds.frombytes(rows.kinds[run].tobytes())
        _extend(self._lines, rows.lines[run])
        _extend(self._pose_lines, rows.pose_lines[run])
        _extend(self._files, np.full(end - start, file))
        for column, pointers in ((self._parents, rows.parents), (self._scopes, rows.scopes)):
            old = pointers[run]
            _extend(column, np.where(old == scope, holder, old + offset))
        for target, facts in (
            (self.relative_to, rows.relative_to), (self.models, rows.models),
            (self.frames, rows.frames), (self.joints, rows.joints), (self.sensors, rows.sensors),
        ):
            facts.copy_to(target, start, end, offset)
        first, last = np.searchsorted(rows.posed, (start, end)).tolist()
        offset_of_text = len(self._texts) - first
        _extend(self._posed, rows.posed[first:last] + offset)
        self._texts += rows.texts[first:last]
        for texts, forms in ((self._quaternions, rows.quaternions), (self._degrees, rows.degrees)):
            here = forms[np.searchsorted(forms, first):np.searchsorted(forms, last)]
            _extend(texts, here + offset_of_text)

    def elements(
        self, files: Sequence[str], missing: Mapping[int, Mapping[str, str]],
    ) -> tuple[Elements, list[tuple[int, str]]]:
        """
        Read the poses and finish the table.

        :param files: the files that elements stand in.
        :param missing: what elements should hold, but was not found.
        :return: the table; and, for each pose that cannot be read and so is the identity, the
            index of its element and the reason.
        """
        written, failures = poses_from_texts(
            self._texts, quaternions=self._quaternions, degrees=self._degrees)
        poses = np.zeros((len(self.names), 7))
        poses[:, 6] = 1.0
        poses[np.array(self._posed, dtype=np.intp)] = written
        table = Elements(
            kinds=np.array(self._kinds, dtype=np.uint8), names=self.names,
            parents=_indices(self._parents), scopes=_indices(self._scopes),
            file_indices=_indices(self._files), lines=_indices(self._lines),
            pose_lines=_indices(self._pose_lines), poses=poses, relative_to=self.relative_to,
            models=self.models, frames=self.frames, joints=self.joints, sensors=self.sensors,
            files=files, missing=missing)
        return table, [(self._posed[text], reason) for text, reason in failures]


def _extend(column: array[int], values: npt.NDArray[np.integer]) -> None:
    column.frombytes(values.astype(np.int32).tobytes())


def _indices(column: array[int]) -> Indices:
    return np.array(column, dtype=np.int32)
