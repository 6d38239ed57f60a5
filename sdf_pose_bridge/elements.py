# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The typed form of a file: a table of its elements that carry a pose, with their references."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
from typing import NamedTuple
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.names import Kind

NOWHERE = -1
"""Stands for an index where there is none."""


CAMERA_TYPES = frozenset({
    'boundingbox', 'boundingbox_camera', 'camera', 'depth', 'depth_camera', 'multicamera', 'rgbd',
    'rgbd_camera', 'segmentation', 'segmentation_camera', 'thermal', 'thermal_camera',
    'wideanglecamera',
})
"""Types of sensors that take images."""


class Reference(NamedTuple):
    """A name that an element uses, as written, and where."""

    name: str
    line: int


class ModelFacts(NamedTuple):
    """What only a model has."""

    is_static: bool
    canonical_link: str
    """Value of the attribute; empty for the first link."""
    placement_frame: str
    """The frame that the pose places; an empty name for the model frame."""


class FrameFacts(NamedTuple):
    """What only an explicit frame has."""

    attached_to: str
    """Value of the attribute; empty for the frame of its scope."""
    placement_frame: str = ''
    """The frame that the pose places, for a frame that stands for a merged model's."""


class JointFacts(NamedTuple):
    """What only a joint has."""

    type: str
    """As written: ``revolute``, ``fixed``, ..."""
    parent: Reference
    child: Reference
    expressed_in: tuple[Reference, ...]
    """The frames that its axes are given in, where one is named."""


class SensorFacts(NamedTuple):
    """What only a sensor has."""

    type: str
    """As written: ``camera``, ``gpu_lidar``, ..."""
    frame_id: str
    """The frame id that Gazebo stamps on its messages, where the file sets one; else empty."""
    is_camera: bool
    """True if its type is a camera's or it has a ``<camera>``: an optical frame belongs to it."""
    optical_frame_id: str
    """Name of the optical frame, where the file sets one; else empty."""


Facts: TypeAlias = ModelFacts | FrameFacts | JointFacts | SensorFacts


class Element(NamedTuple):
    """One element that carries a pose."""

    kind: Kind
    name: str
    """Its own name, without its scope."""
    parent: int
    """Index of the element that holds it; -1 for a world and the implicit root."""
    scope: int
    """Index of the model, world or root whose names its references use."""
    file: int
    """Index of the file that it stands in."""
    line: int
    relative_to: str = ''
    """The frame that its pose is given in, as written; empty for the default of its kind."""
    pose_line: int = 0
    facts: Facts | None = None


class Elements(NamedTuple):
    """
    All elements of a load, each after the one that holds it, in the order of the file.

    Row i of the poses is that of element i as written: x y z in metres, unit quaternion x y z w,
    in the frame that it is relative to.
    """

    elements: Sequence[Element]
    poses: npt.NDArray[np.float64]
    files: Sequence[str]
    missing: Mapping[int, Mapping[str, str]]
    """For each element that should hold something that was not found: its name and URI. An empty
    name stands for a merge, which could have brought any name."""

    def place(self, index: int, line: int = 0, part: str = '') -> Place:
        """
        Tell where an element stands.

        :param index: its index.
        :param line: line of the part of it that is meant; 0 for its own.
        :param part: what is meant of it, such as ``pose``; empty for the element itself.
        :return: its file, line and path.
        """
        element = self.elements[index]
        path = element_path(self.elements, index)
        return Place(
            self.files[element.file],
            line or element.line,
            f'{path}/{part}' if part else path,
        )


def element_path(elements: Sequence[Element], index: int) -> str:
    """
    Return the path of an element, such as ``/sdf/model[@name="m"]/link[@name="l"]``.

    :param elements: the table.
    :param index: index of an element in it; -1 for the document itself.
    :return: its path from the outermost element.
    """
    steps: list[str] = []
    while index >= 0:
        element = elements[index]
        if element.kind is Kind.INERTIAL:
            steps.append(element.kind.label)
        elif element.kind is not Kind.ROOT:
            steps.append(step(element.kind.label, element.name))
        index = element.parent
    return '/'.join(['/sdf', *reversed(steps)])


def step(label: str, name: str) -> str:
    """
    Return one step of an element's path.

    :param label: the element's tag.
    :param name: its name.
    :return: such as ``link[@name="l"]``.
    """
    return f'{label}[@name="{name}"]'
