# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The one table of the types of joints."""

import pytest

from sdf_pose_bridge.scene.scene import Joint
from sdf_pose_bridge.scene.scene import JointAxis
from sdf_pose_bridge.sdformat.joint_types import JOINT_TYPES
from sdf_pose_bridge.sdformat.joint_types import URDF_JOINT_TYPES
from sdf_pose_bridge.tf.joint_motion import dofs_from_joint

X, Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


def dofs_of(joint_type):
    return dofs_from_joint(Joint(0, joint_type, 1, 2, (JointAxis(X), JointAxis(Z)), 0.5))


def test_unknown_type_raises():
    with pytest.raises(KeyError):
        dofs_of('hinge')


@pytest.mark.parametrize('joint_type', JOINT_TYPES)
def test_names_of_the_degrees_of_freedom_of_a_joint_differ(joint_type):
    suffixes = [dof.suffix for dof in dofs_of(joint_type)]
    assert len(set(suffixes)) == len(suffixes)


@pytest.mark.parametrize('joint_type', JOINT_TYPES)
def test_every_degree_of_freedom_moves(joint_type):
    assert all(dof.rad_per_unit or dof.m_per_unit for dof in dofs_of(joint_type))


def test_only_joints_with_a_thread_turn_and_slide_at_once():
    both = {name for name in JOINT_TYPES for dof in dofs_of(name)
            if dof.rad_per_unit and dof.m_per_unit}
    assert both == {name for name, joint_type in JOINT_TYPES.items() if joint_type.has_thread}


def test_types_of_urdf_become_types_of_sdformat():
    assert {each.sdformat for each in URDF_JOINT_TYPES.values()} <= {'', *JOINT_TYPES}
