# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Give the links and joints of a robot, and the robot itself, names that differ.

In URDF a joint may have the name of a link. In SDFormat links and joints share a name space.
"""

from __future__ import annotations

from itertools import count

from sdf_pose_bridge.names import JOINT_SUFFIX
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.urdf.robot import Joint
from sdf_pose_bridge.sdformat.urdf.robot import Robot


def robot_with_different_names(robot: Robot, sources: Sources, problems: Problems) -> Robot:
    """
    Rename joints that have the name of a link, and a robot that has the name of either.

    Links keep their names, which robot_state_publisher gives to frames.

    :param robot: the robot.
    :param sources: where its elements were written.
    :param problems: takes a warning for each new name.
    :return: the robot with the new names.
    """
    used = {*robot.links, *robot.joint_names}
    names = {name: name for name in robot.joint_names}
    for joint in robot.parent_joints.values():
        if joint.name in robot.links:
            names[joint.name] = _unused_name(f'{joint.name}{JOINT_SUFFIX}', used)
            problems.warning(
                f'the joint has the name of link "{joint.name}"; it is called '
                f'"{names[joint.name]}" here', sources.place(joint.xml))

    def renamed(joint: Joint) -> Joint:
        return joint._replace(name=names[joint.name])

    return robot._replace(
        name=_unused_name(f'{robot.name}_model', used) if robot.name in used else robot.name,
        joint_names=names,
        parent_joints={
            child: renamed(joint) for child, joint in robot.parent_joints.items()},
        child_joints={
            parent: [renamed(joint) for joint in joints]
            for parent, joints in robot.child_joints.items()})


def _unused_name(name: str, used: set[str]) -> str:
    candidates = (f'{name}{number or ""}' for number in count())
    new_name = next(each for each in candidates if each not in used)
    used.add(new_name)
    return new_name
