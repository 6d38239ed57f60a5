# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The typed form of a file: a table of its elements that carry a pose, with their references."""

from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any
from typing import NamedTuple
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.names import Kind

NOWHERE = -1
"""Stands for an index where there is none."""

Indices: TypeAlias = np.ndarray[Any, np.dtype[np.int32]]

_Integers: TypeAlias = Sequence[int] | np.ndarray[Any, np.dtype[Any]]

CAMERA_TYPES = frozenset({
    'boundingbox', 'boundingbox_camera', 'camera', 'depth', 'depth_camera', 'multicamera', 'rgbd',
    'rgbd_camera', 'segmentation', 'segmentation_camera', 'thermal', 'thermal_camera',
    'wideanglecamera',
})
"""Types of sensors that take images."""


JOINT_TYPES = frozenset({
    'ball', 'continuous', 'fixed', 'gearbox', 'prismatic', 'revolute', 'revolute2', 'screw',
    'universal',
})
"""Types of joints."""


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


class Elements(NamedTuple):
    """
    All elements of a load, each after the one that holds it, in the order of the file.

    Entry i of each sequence and array is about element i.
    """

    kinds: np.ndarray[Any, np.dtype[np.uint8]]
    """Values of :class:`~sdf_pose_bridge.names.Kind`."""
    names: Sequence[str]
    """Their own names, without their scopes."""
    parents: Indices
    """The element that holds each; -1 for a world and the implicit root."""
    scopes: Indices
    """The model, world or root whose names the references of each use."""
    file_indices: Indices
    """Which of the files each stands in."""
    lines: Indices
    pose_lines: Indices
    """The line of each one's pose; 0 where none is written."""
    poses: np.ndarray[Any, np.dtype[np.float64]]
    """Shape (n, 7): the pose of each as written, x y z in metres, unit quaternion x y z w, in the
    frame that it is relative to; the identity where none is written."""
    relative_to: Mapping[int, str]
    """The frame that a pose is given in, as written, where that is not the default of its kind."""
    models: Mapping[int, ModelFacts]
    frames: Mapping[int, FrameFacts]
    joints: Mapping[int, JointFacts]
    sensors: Mapping[int, SensorFacts]
    files: Sequence[str]
    missing: Mapping[int, Mapping[str, str]]
    """For each element that should hold something that was not found: its name and URI. An empty
    name stands for a merge, which could have brought any name."""

    def kind(self, index: int) -> Kind:
        """
        Tell what an element is.

        :param index: its index.
        :return: its kind.
        """
        return Kind(int(self.kinds[index]))

    def place(self, index: int, line: int = 0, part: str = '') -> Place:
        """
        Tell where an element stands.

        :param index: its index.
        :param line: line of the part of it that is meant; 0 for its own.
        :param part: what is meant of it, such as ``pose``; empty for the element itself.
        :return: its file, line and path.
        """
        path = element_path(self.kinds, self.names, self.parents, index)
        return Place(
            self.files[self.file_indices[index]],
            line or int(self.lines[index]),
            f'{path}/{part}' if part else path,
        )


def element_path(
    kinds: _Integers, names: Sequence[str], parents: _Integers, index: int,
) -> str:
    """
    Return the path of an element, such as ``/sdf/model[@name="m"]/link[@name="l"]``.

    :param kinds: the kind of each element.
    :param names: the name of each.
    :param parents: the element that holds each; -1 for none.
    :param index: index of an element; -1 for the document itself.
    :return: its path from the outermost element.
    """
    steps: list[str] = []
    while index >= 0:
        kind = Kind(int(kinds[index]))
        if kind is Kind.INERTIAL:
            steps.append(kind.label)
        elif kind is not Kind.ROOT:
            steps.append(step(kind.label, names[index]))
        index = int(parents[index])
    return '/'.join(['/sdf', *reversed(steps)])


def step(label: str, name: str) -> str:
    """
    Return one step of an element's path.

    :param label: the element's tag.
    :param name: its name.
    :return: such as ``link[@name="l"]``.
    """
    return f'{label}[@name="{name}"]'
