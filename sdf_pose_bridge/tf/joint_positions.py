# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The current positions of joints, by the names that ``joint_states`` uses.

A joint is named like a frame id (``arm/elbow``), or as in SDF (``arm::elbow``). The names of
models around it can be left out if the rest is unambiguous. A second axis is called
``<joint>_axis2``; a ball joint has ``<joint>_roll``, ``<joint>_pitch`` and ``<joint>_yaw``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
import enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.errors import JointPositionError, Place, SdfWarning
from sdf_pose_bridge.names import hint_from_names, JOINT_SUFFIX, quoted_names, SEPARATOR
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.joints import Mimic
from sdf_pose_bridge.tf.frame_ids import FrameNames, FrameNaming
from sdf_pose_bridge.tf.joint_motion import DegreeOfFreedom, JointMotion
from sdf_pose_bridge.tf.parents import tf_parents_from_scene

LARGEST_POSITION = 1e9
"""The largest accepted position, in radians or metres."""

SLIDE_SUFFIX = '_slide'
"""Appended to the name of a screw joint for its second joint in URDF. Publishers of joint states
that read URDF name it too; its position follows from the first one."""

_MOST_STEPS = 10
"""Largest number of innermost steps of a name that can replace it."""

_MOST_NAMES_SHOWN = 6

NEVER = -1
"""A time before all others, in nanoseconds."""


class UnreportedJoints(enum.Enum):
    """Treatment of joints that no message has named."""

    NONE = 'none'
    """The frames that they move have no pose."""
    ZERO = 'zero'
    """They are at zero, as in the file."""


class Follower(NamedTuple):
    """A degree of freedom whose position follows from the position of another one."""

    dof: int
    leader: int
    mimic: Mimic


class Selection(NamedTuple):
    """The degrees of freedom of a list of names."""

    rows: NDArray[np.intp]
    """The entries of the list that name degrees of freedom."""
    dofs: NDArray[np.intp]
    """The degree of freedom of each of these entries."""
    followers: tuple[Follower, ...]
    """Other degrees of freedom that follow these; each after its leader."""
    beside: NDArray[np.intp]
    """All degrees of freedom in the same top-level models."""

    @property
    def changed(self) -> list[int]:
        """All degrees of freedom that get a position."""
        return [*self.dofs.tolist(), *(follower.dof for follower in self.followers)]


class UnreportedDofs(NamedTuple):
    """Degrees of freedom without a known position."""

    joint_count: int
    """The number of their joints."""
    first: int
    """The first of them."""


class JointPositions:
    """
    The positions of the degrees of freedom of a scene; all are zero at first.

    :param frame_names: the part of a scoped name that the name of a joint contains.
    :param model: the scoped name of the only model whose joints have names; empty for all.
    :param unreported: whether joints without a reported position count as being at zero.
    """

    def __init__(
        self, scene: Scene, dofs: Sequence[DegreeOfFreedom],
        frame_names: FrameNames = FrameNames.AUTO, model: str = '',
        unreported: UnreportedJoints = UnreportedJoints.NONE,
    ) -> None:
        self.values = np.zeros(len(dofs))
        """The position of each degree of freedom, in radians or metres. A change is another array,
        so that another thread has all values of one time."""
        self.is_reported = np.zeros(len(dofs), np.bool_)
        """Whether each has a reported position, or follows from one that has."""
        self.unreported_count = len(dofs)
        """Number of those that have none."""
        self.stamps_ns = np.full(len(dofs), NEVER)
        """The newest stamp of a message about the top-level model of each."""
        self._stamps_of_values_ns = np.full(len(dofs), NEVER)
        self._newest_stamp_ns = NEVER
        self._unreported = unreported
        self.dofs = tuple(dofs)
        joints = np.array([each.joint.element for each in dofs], np.int32)
        names = FrameNaming(frame_names).frame_ids_from_scene(scene, joints)
        self.names = tuple(
            name + each.suffix for name, each in zip(names, dofs, strict=True))
        """The name of each degree of freedom."""
        self._top_level_elements = np.array(
            [scene.top_level_element(joint) for joint in joints.tolist()], np.intp)
        self._indices = _indices_from_names(
            self.names, scene, dofs, self._top_level_elements.tolist(), model)
        self._followers = _followers(dofs)
        # Followers have the position of their leader.
        self._is_free = np.ones(len(dofs), np.bool_)
        self._is_free[[each.dof for found in self._followers.values() for each in found]] = False
        self._joints = joints
        self._slides = frozenset(
            name + SLIDE_SUFFIX for name, each in zip(self.names, dofs, strict=True)
            if each.rad_per_unit and each.m_per_unit)

    @property
    def models(self) -> tuple[str, ...]:
        """The top-level models of a world that have such names; none in a model file."""
        return tuple(filter(None, self._indices))

    @property
    def is_known(self) -> NDArray[np.bool_]:
        """Whether the position of each is known."""
        if self._unreported is UnreportedJoints.NONE:
            return self.is_reported
        return np.ones(len(self.dofs), np.bool_)

    def unreported(self) -> UnreportedDofs | None:
        """Find the free degrees of freedom without a known position; None if there are none."""
        dofs = np.flatnonzero(self._is_free & ~self.is_known)
        if not len(dofs):
            return None
        return UnreportedDofs(len(np.unique(self._joints[dofs])), int(dofs[0]))

    def selection(self, names: Sequence[str], model: str = '') -> Selection:
        """
        Look up names.

        :param model: one of :attr:`models`, if only joints inside it are meant; else empty.
        """
        indices = self._indices[model]
        rows = [row for row, name in enumerate(names) if name in indices]
        dofs = [indices[names[row]] for row in rows]
        reached = dict.fromkeys(dofs)
        followers: list[Follower] = []
        for leader in (waiting := list(reached)):
            for follower in self._followers.get(leader, ()):
                if follower.dof not in reached:
                    reached[follower.dof] = None
                    followers.append(follower)
                    waiting.append(follower.dof)
        top_level = self._top_level_elements[list(reached)]
        return Selection(
            np.array(rows, np.intp), np.array(dofs, np.intp), tuple(followers),
            np.flatnonzero(np.isin(self._top_level_elements, top_level)))

    def unknown(self, names: Iterable[str], model: str = '') -> list[str]:
        """
        Find names that are unknown or ambiguous.

        :param model: as for :meth:`selection`.
        """
        indices = self._indices[model]
        return [name for name in names if name not in indices and name not in self._slides]

    def hint(self, name: str, model: str = '') -> str:
        """
        Return the end of a message about an unknown or ambiguous name.

        :param model: as for :meth:`selection`.
        :return: the nearest name, or the possible names; else an empty string.
        """
        return hint_from_names(name, self._indices[model])

    def update(
        self, selection: Selection, values: NDArray[np.float64], stamp_ns: int = 0,
        *, ignore_stamps: bool = False,
    ) -> list[str]:
        """
        Set positions.

        :param selection: the degrees of freedom of the values.
        :param values: a value for each name that was looked up, in radians or metres.
        :param stamp_ns: their time. A position of a later time stays.
        :param ignore_stamps: whether no position stays.
        :return: the names whose values are not finite or too large; their positions stay.
        """
        dofs, new = selection.dofs, values[selection.rows]
        invalid: list[str] = []
        sizes = np.abs(new)
        # NaN is the largest.
        if not sizes.max(initial=0.0) <= LARGEST_POSITION:
            is_valid = sizes <= LARGEST_POSITION
            invalid = [self.names[dof] for dof in dofs[~is_valid].tolist()]
            dofs, new = dofs[is_valid], new[is_valid]
        stamps_ns, newest_of_models_ns = self._stamps_of_values_ns, stamp_ns
        if stamp_ns < self._newest_stamp_ns:
            newest_of_models_ns = np.maximum(self.stamps_ns[selection.beside], stamp_ns)
            if not ignore_stamps:
                is_newer = stamps_ns[dofs] <= stamp_ns
                dofs, new = dofs[is_newer], new[is_newer]
        self.stamps_ns[selection.beside] = newest_of_models_ns
        self._newest_stamp_ns = max(self._newest_stamp_ns, stamp_ns)
        changed = self.values.copy()
        changed[dofs] = new
        stamps_ns[dofs] = stamp_ns
        if self.unreported_count:
            self.is_reported[dofs] = True
        found = set(dofs.tolist()) if selection.followers else set()
        for dof, leader, mimic in selection.followers:
            value = mimic.multiplier * (changed[leader] - mimic.reference) + mimic.offset
            if leader in found and abs(value) <= LARGEST_POSITION:
                changed[dof] = value
                stamps_ns[dof] = stamp_ns
                self.is_reported[dof] = True
                found.add(dof)
        self.values = changed
        if self.unreported_count:
            self.unreported_count = int(np.count_nonzero(~self.is_reported))
        return invalid

    def forget_stamps(self) -> None:
        """Accept any time next, after time has jumped back."""
        self.stamps_ns[:] = self._stamps_of_values_ns[:] = NEVER
        self._newest_stamp_ns = NEVER

    def take_over(self, before: JointPositions) -> None:
        """
        Continue with the positions of joints that have the same names.

        :param before: the positions in the scene that is replaced.
        """
        rows = {name: row for row, name in enumerate(before.names)}
        pairs = [(dof, rows[name]) for dof, name in enumerate(self.names) if name in rows]
        here, there = np.reshape(np.array(pairs, np.intp), (-1, 2)).T
        values = self.values.copy()
        values[here] = before.values[there]
        self.values = values
        self.is_reported[here] = before.is_reported[there]
        self.unreported_count = int(np.count_nonzero(~self.is_reported))
        self.stamps_ns[here] = before.stamps_ns[there]
        self._stamps_of_values_ns[here] = before._stamps_of_values_ns[there]
        self._newest_stamp_ns = before._newest_stamp_ns


def scene_at_positions(scene: Scene, positions: Mapping[str, float]) -> Scene:
    """
    Return a scene with its joints at other positions.

    :param scene: the scene, as it was loaded.
    :param positions: positions by the names of joints, in radians or metres. All other joints stay
        at zero, except those that mimic one of these.
    :return: a scene with other poses, and a warning for each position beyond the limits of its
        joint.
    :raises JointPositionError: if a name is unknown or ambiguous, or a position is not finite or
        too large.
    """
    motion = JointMotion(scene, tf_parents_from_scene(scene))
    state = JointPositions(scene, motion.dofs)
    selection = state.selection(list(positions))
    invalid = state.update(selection, np.array(list(positions.values()), float))
    for name in state.unknown(positions):
        known = (f'the moving joints are {quoted_names(state.names, _MOST_NAMES_SHOWN)}'
                 if state.names else 'the file has no moving joint')
        msg = f'"{name}" is not the name of one moving joint{state.hint(name)}; {known}'
        raise JointPositionError(msg, Place(scene.path))
    for name in invalid:
        msg = f'the position of "{name}" must be finite and at most {LARGEST_POSITION:g}'
        raise JointPositionError(msg, Place(scene.path))
    elements = np.arange(len(scene.names), dtype=np.int32)
    poses = motion.moved_poses(scene.poses, elements, state.values)
    warnings = []
    for name, dof, value in zip(
            state.names, motion.dofs, state.values.tolist(), strict=True):
        if not dof.axis.lower <= value <= dof.axis.upper:
            msg = (f'the position {value:g} of "{name}" is beyond its limits, '
                   f'{dof.axis.lower:g} to {dof.axis.upper:g}')
            warnings.append(SdfWarning('WARNING', msg, scene.place(dof.joint.element)))
    return dataclasses.replace(scene, poses=poses, warnings=(*scene.warnings, *warnings))


def _indices_from_names(
    names: Sequence[str], scene: Scene, dofs: Sequence[DegreeOfFreedom],
    top_level_elements: Sequence[int], model: str,
) -> dict[str, dict[str, int]]:
    """
    Return all names of the degrees of freedom, with their indices.

    In URDF and in old SDFormat, a joint may have the name of a link; it is then renamed. Its own
    name is still accepted.

    :return: the names for ``''``, and for each top-level model of a world those that mean its own
        degrees of freedom, whatever other models have.
    """
    aliases: dict[int, set[str]] = {}
    members: dict[str, list[int]] = {'': []}
    for index, (dof, top) in enumerate(zip(dofs, top_level_elements, strict=True)):
        scoped = scene.names[dof.joint.element]
        if scene.roots[dof.joint.element] or (
                model and not scoped.startswith(model + SEPARATOR)):
            continue
        before = scoped.removesuffix(JOINT_SUFFIX)
        found = aliases[index] = set()
        for each in {scoped, before} if scene.has(before) else {scoped}:
            steps = each.split(SEPARATOR)
            # All endings of deeply nested names would take the square of their memory.
            for count in {0, *range(max(len(steps) - _MOST_STEPS, 0), len(steps))}:
                for separator in (SEPARATOR, '/'):
                    found.add(separator.join(steps[count:]) + dof.suffix)
        members[''].append(index)
        if scene.world_names and scene.kinds[top] == Kind.MODEL:
            members.setdefault(scene.names[top], []).append(index)
    return {
        each: _unambiguous_names(names, aliases, indices) for each, indices in members.items()}


def _unambiguous_names(
    names: Sequence[str], aliases: Mapping[int, set[str]], indices: Sequence[int],
) -> dict[str, int]:
    """Return the names of some degrees of freedom, and those aliases that mean one of them."""
    own: dict[str, int] = {}
    shorter: dict[str, set[int]] = {}
    for index in indices:
        own.setdefault(names[index], index)
        for alias in aliases[index]:
            shorter.setdefault(alias, set()).add(index)
    return {name: min(found) for name, found in shorter.items() if len(found) == 1} | own


def _followers(dofs: Sequence[DegreeOfFreedom]) -> Mapping[int, list[Follower]]:
    """Return the degrees of freedom that mimic each one."""
    indices = {(each.joint.element, each.number): index for index, each in enumerate(dofs)}
    followers: dict[int, list[Follower]] = {}
    for index, dof in enumerate(dofs):
        mimic = dof.axis.mimic
        if mimic is not None and (mimic.joint, mimic.axis) in indices:
            leader = indices[mimic.joint, mimic.axis]
            followers.setdefault(leader, []).append(Follower(index, leader, mimic))
    return followers
