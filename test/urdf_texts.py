# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Short URDF texts for tests."""

MASS = ('<mass value="{mass}"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>')


def robot(content):
    """Put content into a robot, ``r``."""
    return f'<robot name="r">{content}</robot>'


def link(name, content='', *, mass=1.0, center='0 0 0'):
    """Return a link with a mass."""
    inertial = f'<origin xyz="{center}"/>{MASS.format(mass=mass)}'
    return f'<link name="{name}"><inertial>{inertial}</inertial>{content}</link>'


def joint(name, parent, child, joint_type='fixed', content=''):
    """Return a joint."""
    return (f'<joint name="{name}" type="{joint_type}"><parent link="{parent}"/>'
            f'<child link="{child}"/>{content}</joint>')


def origin(xyz='0 0 0', rpy='0 0 0'):
    return f'<origin xyz="{xyz}" rpy="{rpy}"/>'


def gazebo(content, reference=''):
    """Return SDFormat for a link or a joint, or for the robot."""
    attribute = f' reference="{reference}"' if reference else ''
    return f'<gazebo{attribute}>{content}</gazebo>'


def shape(tag, pose='', name=''):
    """Return a visual or a collision."""
    attribute = f' name="{name}"' if name else ''
    return f'<{tag}{attribute}>{pose}<geometry><sphere radius="1"/></geometry></{tag}>'
