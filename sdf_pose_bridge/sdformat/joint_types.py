# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The types of joints: in which ways they move, and what they are called in URDF."""

from __future__ import annotations

from collections.abc import Mapping
import enum
from typing import NamedTuple


class Motion(enum.Enum):
    """What a joint does along or about an axis."""

    TURN = enum.auto()
    """The position is an angle in radians."""
    SLIDE = enum.auto()
    """The position is a distance in metres."""
    SCREW = enum.auto()
    """The position is an angle in radians; the pitch of the thread says how far that moves it."""


class DofType(NamedTuple):
    """One of the ways in which joints of a type can move."""

    motion: Motion
    axis: int | tuple[float, float, float] = 0
    """Which axis of the joint it has, 0 or 1, or a fixed direction in the frame of the joint."""
    suffix: str = ''
    """What its name in ``joint_states`` has after that of the joint."""


class JointType(NamedTuple):
    """A type of joints in SDFormat."""

    dofs: tuple[DofType, ...]
    """Its degrees of freedom, from its parent to its child."""

    @property
    def has_thread(self) -> bool:
        """Whether the pitch of a thread says how it moves."""
        return any(dof.motion is Motion.SCREW for dof in self.dofs)


class UrdfJointType(NamedTuple):
    """A type of joints in URDF."""

    sdformat: str
    """The type that it becomes, a key of :data:`JOINT_TYPES`; empty if there is none."""
    has_axis: bool
    has_limit: bool
    """Whether it has, and must have, a ``<limit>`` of its position."""


_ONE_TURN = JointType((DofType(Motion.TURN),))
_TWO_TURNS = JointType((DofType(Motion.TURN), DofType(Motion.TURN, 1, '_axis2')))

JOINT_TYPES: Mapping[str, JointType] = {
    'ball': JointType((
        DofType(Motion.TURN, (0.0, 0.0, 1.0), '_yaw'),
        DofType(Motion.TURN, (0.0, 1.0, 0.0), '_pitch'),
        DofType(Motion.TURN, (1.0, 0.0, 0.0), '_roll'))),
    'continuous': _ONE_TURN,
    'fixed': JointType(()),
    'gearbox': _ONE_TURN,
    'prismatic': JointType((DofType(Motion.SLIDE),)),
    'revolute': _ONE_TURN,
    'revolute2': _TWO_TURNS,
    'screw': JointType((DofType(Motion.SCREW),)),
    'universal': _TWO_TURNS,
}
"""The types of joints by the names that they have in SDFormat."""

URDF_JOINT_TYPES: Mapping[str, UrdfJointType] = {
    'continuous': UrdfJointType('revolute', has_axis=True, has_limit=False),
    'fixed': UrdfJointType('fixed', has_axis=False, has_limit=False),
    'floating': UrdfJointType('', has_axis=False, has_limit=False),
    'planar': UrdfJointType('', has_axis=True, has_limit=False),
    'prismatic': UrdfJointType('prismatic', has_axis=True, has_limit=True),
    'revolute': UrdfJointType('revolute', has_axis=True, has_limit=True),
}
"""The types of joints by the names that they have in URDF."""
