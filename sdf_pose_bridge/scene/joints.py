# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Check that every joint joins two bodies: libsdformat's rules, at every level of nesting."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import ExpressedInError
from sdf_pose_bridge.errors import JointChildError
from sdf_pose_bridge.errors import JointParentError
from sdf_pose_bridge.errors import JointSameLinkError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scopes import Scopes
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.elements import Indices


class JointEnds(NamedTuple):
    """The frames that a joint joins, by index; -1 where the name means nothing."""

    joint: int
    parent: int
    child: int


def check_joints(
    table: Elements,
    scopes: Scopes,
    joints: Sequence[JointEnds],
    bodies: Indices,
    problems: Problems,
) -> None:
    """
    Check the ends and the axes of joints.

    :param table: the elements.
    :param scopes: their names.
    :param joints: the joints and the frames that their ends name.
    :param bodies: for each element the link, static model or root that carries it.
    :param problems: takes what is wrong.
    """
    for ends in _doubtful(table, scopes, joints, bodies):
        _JointCheck(table, scopes, ends, bodies, problems).run()


def _doubtful(
    table: Elements, scopes: Scopes, joints: Sequence[JointEnds], bodies: Indices,
) -> Sequence[JointEnds]:
    """Leave out joints with which nothing is wrong, all at once."""
    if not joints:
        return joints
    joint, parent, child = np.array(joints).T
    body = bodies[child]
    is_doubtful = (
        (parent < 0) | (child < 0) | (parent == joint) | (child == joint)
        | (body == bodies[parent]) | (body == np.array(scopes.roots)[child]))
    axes = [(place, reference.name) for place, ends in enumerate(joints)
            for reference in table.joints[ends.joint].expressed_in]
    scopes_of_axes: list[int] = table.scopes[joint[[place for place, _ in axes]]].tolist()
    frames = scopes.frames(scopes_of_axes, [name for _, name in axes])
    is_doubtful[[place for (place, _), frame in zip(axes, frames, strict=True)
                 if frame is None]] = True
    return [joints[place] for place in np.flatnonzero(is_doubtful).tolist()]


class _JointCheck:

    def __init__(
        self,
        table: Elements,
        scopes: Scopes,
        ends: JointEnds,
        bodies: Indices,
        problems: Problems,
    ) -> None:
        self._table = table
        self._scopes = scopes
        self._ends = ends
        self._bodies = bodies
        self._problems = problems
        self._name = table.names[ends.joint]
        self._scope = int(table.scopes[ends.joint])
        self._facts = table.joints[ends.joint]

    def run(self) -> None:
        good = self._check_child() & self._check_parent()
        if good:
            self._check_bodies()
        for reference in self._facts.expressed_in:
            if self._scopes.frame(self._scope, reference.name) is None:
                self._unknown(ExpressedInError, 'axis', 'expressed_in', *reference)

    def _check_child(self) -> bool:
        name, line = self._facts.child
        if not name:
            return False
        if name == WORLD_FRAME:
            msg = '"world" cannot be the child of a joint, only its parent'
            self._error(JointChildError, msg, line, 'child')
        elif self._ends.child < 0:
            self._unknown(JointChildError, 'child', 'child', name, line)
        else:
            return self._ends.child != self._ends.joint
        return False

    def _check_parent(self) -> bool:
        name, line = self._facts.parent
        if not name:
            return False
        if self._ends.parent < 0:
            self._unknown(JointParentError, 'parent', 'parent', name, line)
        elif self._ends.parent == self._ends.joint:
            msg = f'the joint names itself, "{name}", as its parent'
            self._error(JointParentError, msg, line, 'parent')
        else:
            return True
        return False

    def _check_bodies(self) -> None:
        child_body = self._bodies[self._ends.child]
        parent_body = self._bodies[self._ends.parent]
        child = self._facts.child
        parent = self._facts.parent
        if child_body == self._scopes.roots[self._scope]:
            msg = f'child "{child.name}" is attached to the world, so nothing can move it'
            self._error(JointChildError, msg, child.line, 'child')
        elif child_body == parent_body or parent.name == child.name:
            msg = (f'parent "{parent.name}" and child "{child.name}" are both attached to '
                   f'"{self._scopes.names[child_body]}"; a joint joins two bodies')
            self._error(JointSameLinkError, msg, 0, '')

    def _unknown(
        self, error_class: type[SdfError], part: str, what: str, name: str, line: int,
    ) -> None:
        msg = (f'{what} "{name}" names no frame in {self._scopes.described(self._scope)}'
               f'{self._scopes.hint(self._scope, name)}')
        self._error(error_class, msg, line, part)

    def _error(self, error_class: type[SdfError], message: str, line: int, part: str) -> None:
        index = self._ends.joint
        self._problems.error(error_class(message, self._table.place(index, line, part)))
