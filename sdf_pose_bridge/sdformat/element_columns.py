# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The table of elements while it grows: one at a time."""

from __future__ import annotations

from array import array
from collections.abc import Mapping
from collections.abc import Sequence

import numpy as np

from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.sdformat.elements import element_path
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.elements import FrameFacts
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.elements import JointFacts
from sdf_pose_bridge.sdformat.elements import ModelFacts
from sdf_pose_bridge.sdformat.elements import SensorFacts
from sdf_pose_bridge.sdformat.pose_text import poses_from_texts
from sdf_pose_bridge.sdformat.pose_text import PoseText


class ElementColumns:
    """Columns of the table of elements, to which rows can be added."""

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
        :return: as :func:`~sdf_pose_bridge.sdformat.elements.element_path` does.
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


def _indices(column: array[int]) -> Indices:
    return np.array(column, dtype=np.int32)
