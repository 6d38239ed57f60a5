# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Check that every joint joins two bodies, and that its axes refer to frames and joints.

Source: ``checkJointParentChildNames``, ``checkJointAxisExpressedInValues`` and
``checkJointAxisMimicValues`` of libsdformat. They skip joints of models in models, except for
unknown children and one name at both ends; here the rest are warnings.
"""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.errors import (
    AttachedToError,
    ExpressedInError,
    JointChildError,
    JointParentError,
    JointSameLinkError,
    MimicError,
    SdfError,
)
from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.names import MODEL_FRAME, SEPARATOR, WORLD_FRAME
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.name_scopes import NameScopes
from sdf_pose_bridge.sdformat.elements import Elements, NO_ELEMENT
from sdf_pose_bridge.sdformat.joints import AXIS_TAGS, DEFAULT_END, Mimic, Reference


class JointEnds(NamedTuple):
    """The frames that a joint joins, by index; -1 for a name that names no frame."""

    joint: int
    parent: int
    child: int
    axes: tuple[tuple[int, int], ...]
    """The frame in which the vector of each axis is expressed, and the joint that the axis mimics;
    -1 for none."""


class JointChecks:
    """
    Checks the ends and the axes of joints.

    :param bodies: for each frame the link, static model or root that it is attached to.
    """

    def __init__(
        self, elements: Elements, scopes: NameScopes, bodies: Indices, problems: Problems,
    ) -> None:
        self._elements = elements
        self._scopes = scopes
        self._bodies: list[int] = bodies.tolist()
        self._problems = problems

    def ends_of(self, joint: int, parent: int, child: int) -> JointEnds | None:
        """Return a joint with the references of its axes; None if it does not join two bodies."""
        ends = JointEnds(joint, parent, child, tuple(
            (joint, NO_ELEMENT) if axis is None else (
                self._expressed_in(joint, tag, axis.expressed_in),
                self._leader(joint, tag, axis.mimic))
            for tag, axis in zip(AXIS_TAGS, self._elements.joints[joint].axes, strict=True)))
        return ends if self._are_valid(ends) else None

    def _expressed_in(self, joint: int, tag: str, reference: Reference) -> int:
        found = joint if not reference.name else self._scopes.frame(
            self._scopes.scope_of[joint], reference.name)
        if found is None:
            self._report_unknown(ExpressedInError, joint, reference, 'expressed_in', tag)
            return joint
        return found

    def _leader(self, joint: int, tag: str, mimic: Mimic | None) -> int:
        if mimic is None:
            return NO_ELEMENT
        name, scope = mimic.leader.name, self._scopes.scope_of[joint]
        leader = self._scopes.frame(scope, name) if name else None
        if leader is None or leader not in self._elements.joints:
            msg = f'mimic joint="{name}" names no joint'
        elif not self._is_found_by_parts(leader, scope, name):
            msg = (f'mimic joint="{name}" names no joint: libsdformat finds none in a model whose '
                   f'own name holds "{SEPARATOR}"')
        elif self._elements.joints[leader].axes[mimic.axis] is None:
            msg = f'mimic: joint "{name}" has no <{AXIS_TAGS[mimic.axis]}>'
        else:
            return leader
        self._report(MimicError, msg, joint, mimic.leader.line, tag)
        return NO_ELEMENT

    def _is_found_by_parts(self, leader: int, scope: int, name: str) -> bool:
        """Return whether each part of a scoped name is the whole name of a model or joint."""
        parents = self._elements.parents
        if parents[leader] == scope:
            return True
        for part in reversed(name.split(SEPARATOR)):
            if self._elements.names[leader] != part:
                return False
            leader = int(parents[leader])
        return True

    def _are_valid(self, ends: JointEnds) -> bool:
        """Check that a joint joins two bodies."""
        joint, root = ends.joint, self._scopes.roots[ends.joint]
        details = self._elements.joints[joint]
        parent, child = details.parent, details.child
        if child.name == WORLD_FRAME:
            msg = '"world" cannot be the child of a joint, only its parent'
            self._report(JointChildError, msg, joint, child.line, 'child')
        elif child.name and not _is_found(ends.child, child):
            self._report_unknown(JointChildError, joint, child, 'child')
        if parent.name and parent.name == child.name:
            msg = f'parent and child are both "{child.name}"; a joint joins two bodies'
            # libsdformat checks this in nested models too.
            self._problems.error(JointSameLinkError(msg, self._elements.place(joint)))
            return False
        if parent.name and not _is_found(ends.parent, parent):
            # libsdformat looks for other parents before it resolves them.
            is_model_frame = parent.name.rpartition(SEPARATOR)[2] == MODEL_FRAME
            self._report_unknown(
                AttachedToError if is_model_frame else JointParentError, joint, parent, 'parent')
        elif ends.parent == joint:
            msg = f'the joint names itself, "{parent.name}", as its parent'
            self._report(JointParentError, msg, joint, parent.line, 'parent')
        if (min(ends.parent, ends.child) < 0 or joint in (ends.parent, ends.child)
                or child.name == WORLD_FRAME):
            return False
        parent_body, child_body = self._bodies[ends.parent], self._bodies[ends.child]
        if child_body == parent_body:
            msg = (f'parent "{parent.name}" and child "{child.name}" are both attached to '
                   f'"{self._scopes.names[child_body]}"; a joint joins two bodies')
            self._report(JointSameLinkError, msg, joint)
        elif child_body == root:
            msg = f'child "{child.name}" is attached to the world, so nothing can move it'
            self._report(JointChildError, msg, joint, child.line, 'child')
        return child_body != parent_body

    def _report_unknown(
        self, error_class: type[SdfError], joint: int, reference: Reference, what: str,
        part: str = '',
    ) -> None:
        if reference.name == DEFAULT_END:
            msg = f'the joint has no <{what}>; it must name a frame'
        else:
            name, scope = reference.name, self._scopes.scope_of[joint]
            msg = f'{what} "{name}" {self._scopes.reason_without_frame(scope, name)}'
        self._report(error_class, msg, joint, reference.line, part or what)

    def _report(
        self, error_class: type[SdfError], message: str, joint: int, line: int = 0,
        part: str = '',
    ) -> None:
        """Report an error, or a warning if libsdformat does not check this in nested models."""
        scope, root = self._scopes.scope_of[joint], self._scopes.roots[joint]
        place = self._elements.place(joint, line, part)
        if error_class is JointChildError or root in (scope, self._elements.parents[scope]):
            self._problems.error(error_class(message, place))
        else:
            self._problems.warning(
                f'{message}; libsdformat does not check this here', place, error_class.code)


def _is_found(end: int, reference: Reference) -> bool:
    """Return whether libsdformat finds an end of a joint; others may be called ``::a``."""
    return end >= 0 and not reference.name.startswith(SEPARATOR)
