# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Random trees of links and joints, with their poses calculated independently of the package.

The tree is that of the links' numbers: each link but the first is joined to one before it, which
is the parent or the child of the joint.
"""

from __future__ import annotations

from dataclasses import dataclass

from matrices import matrix_from_degrees
import numpy as np
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import strategies as st

TYPES = ('revolute', 'continuous', 'prismatic', 'screw', 'universal', 'revolute2', 'gearbox',
         'ball', 'fixed')
SUFFIXES = {
    'ball': ('_yaw', '_pitch', '_roll'), 'universal': ('', '_axis2'), 'revolute2': ('', '_axis2'),
    'fixed': ()}
LENGTHS = st.integers(-16, 16).map(lambda value: value / 8)
ANGLES = st.integers(-12, 12).map(lambda value: value * 15)
POSES = st.tuples(*[LENGTHS] * 3, *[ANGLES] * 3)
AXES = st.tuples(*[st.integers(-2, 2).map(float)] * 3).filter(any)
PAIRS_OF_AXES = st.tuples(AXES, AXES)
PITCHES = st.sampled_from([-0.5, 0.01, 0.25, 2.0])
POSITIONS = st.floats(-4.0, 4.0).map(lambda value: round(value, 3))


@dataclass(frozen=True)
class RandomJoint:
    """The joint of link ``number`` with an earlier one."""

    number: int
    other: int
    type: str
    is_reversed: bool
    """Whether the earlier link is its child."""
    pose: tuple[float, ...]
    axes: tuple[tuple[float, float, float], ...]
    expressed_in: tuple[str, ...]
    """For each axis a frame; empty for that of the joint."""
    pitch_m: float
    has_old_pitch: bool

    @property
    def name(self):
        return f'j{self.number}'

    @property
    def position_names(self):
        return [self.name + suffix for suffix in SUFFIXES.get(self.type, ('',))]

    def text(self):
        """Write the joint."""
        ends = [f'l{self.other}', f'l{self.number}']
        parent, child = ends[::-1] if self.is_reversed else ends
        axes = ''.join(
            f'<{tag}><xyz expressed_in="{frame}">{" ".join(map(str, axis))}</xyz></{tag}>'
            for tag, axis, frame in zip(
                ('axis', 'axis2'), self.axes, self.expressed_in, strict=True)
            if tag == 'axis' or self.type in ('universal', 'revolute2'))
        pitch = (
            f'<thread_pitch>{-2.0 * np.pi / self.pitch_m!r}</thread_pitch>' if self.has_old_pitch
            else f'<screw_thread_pitch>{self.pitch_m}</screw_thread_pitch>')
        return (
            f'<joint name="{self.name}" type="{self.type}">{pose_text(self.pose)}'
            f'<parent>{parent}</parent><child>{child}</child>'
            f'{"" if self.type in ("ball", "fixed") else axes}'
            f'{pitch if self.type == "screw" else ""}</joint>')


@st.composite
def random_joints(draw, count, types=TYPES, axes=PAIRS_OF_AXES):
    """Draw the joints of a tree of ``count`` links."""
    frames = ['', *(f'l{number}' for number in range(count)), '__model__']
    return [
        RandomJoint(
            number, draw(st.integers(0, number - 1)), draw(st.sampled_from(types)),
            draw(st.booleans()), draw(POSES), draw(axes),
            (draw(st.sampled_from(frames)),) * 2, draw(PITCHES), draw(st.booleans()))
        for number in range(1, count)]


def pose_text(pose):
    return f'<pose degrees="true">{" ".join(map(str, pose))}</pose>'


def model_text(link_poses, joints, extra=''):
    """Write a model whose links have these poses in it."""
    links = ''.join(
        f'<link name="l{number}">{pose_text(pose)}</link>'
        for number, pose in enumerate(link_poses))
    return (
        f'<sdf version="1.9"><model name="m">{links}'
        f'{"".join(joint.text() for joint in joints)}{extra}</model></sdf>')


def link_matrices(link_poses, joints, positions):
    """
    Calculate the poses of all links in the model, whose first link stays.

    :param positions: the position of each degree of freedom, by its name.
    :return: 4x4 matrices.
    """
    start = [matrix_from_degrees(*pose) for pose in link_poses]
    matrices = [start[0]]
    for joint in joints:
        child = joint.other if joint.is_reversed else joint.number
        frame = start[child] @ matrix_from_degrees(*joint.pose)
        motion = np.eye(4)
        for twist, name in zip(_twists(joint, frame, start), joint.position_names, strict=True):
            motion = motion @ exponential(twist * positions[name])
        if joint.is_reversed:
            motion = np.linalg.inv(motion)
        in_other = np.linalg.inv(start[joint.other]) @ frame
        in_joint = np.linalg.inv(frame) @ start[joint.number]
        matrices.append(matrices[joint.other] @ in_other @ motion @ in_joint)
    return matrices


def _twists(joint, frame, start):
    """Return a 4x4 matrix for each degree of freedom, in the frame of the joint."""
    if joint.type == 'ball':
        return [_twist(axis, 0.0) for axis in np.eye(3)[::-1]]
    axes = []
    for axis, name in zip(joint.axes, joint.expressed_in, strict=True):
        other = {'': frame, '__model__': np.eye(4)}.get(name)
        other = start[int(name[1:])] if other is None else other
        vector = frame[:3, :3].T @ other[:3, :3] @ np.array(axis)
        axes.append(vector / np.linalg.norm(vector))
    if joint.type == 'prismatic':
        twist = np.zeros((4, 4))
        twist[:3, 3] = axes[0]
        return [twist]
    pitch = joint.pitch_m / (2.0 * np.pi) if joint.type == 'screw' else 0.0
    return [_twist(axis, pitch) for axis in axes[:len(joint.position_names)]]


def _twist(axis, pitch):
    x, y, z = axis
    return np.array([
        [0.0, -z, y, pitch * x], [z, 0.0, -x, pitch * y], [-y, x, 0.0, pitch * z], [0.0] * 4])


def exponential(matrix):
    """Calculate the exponential of a matrix by its series, after halving it often enough."""
    halvings = 8
    result = term = np.eye(4)
    for number in range(1, 20):
        term = term @ matrix / (number * 2 ** halvings)
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return result
