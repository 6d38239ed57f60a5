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

_UNREPORTED = NEVER - 1
"""The time of a position that no message has reported."""


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
    changed: list[int]
    """All of these, which get a position."""
    models: list[int]
    """The numbers of their top-level models."""


class JointPositions:
    """
    The positions of the degrees of freedom of a scene; at first zero, or the only position.

    The positions of joints whose lower limit is the upper one are known from the beginning.

    :param model: the scoped name of the only model whose joints have names; empty for all.
    :param unreported: whether joints without a reported position count as being at zero.
    """

    def __init__(
        self, scene: Scene, dofs: Sequence[DegreeOfFreedom], model: str = '',
        unreported: UnreportedJoints = UnreportedJoints.NONE,
    ) -> None:
        self.names = tuple(each.name for each in dofs)
        """The name of each degree of freedom."""
        self._is_fixed = np.array([
            each.axis.lower == each.axis.upper and abs(each.axis.lower) <= LARGEST_POSITION
            for each in dofs], np.bool_)
        self.values = np.where(self._is_fixed, [each.axis.lower for each in dofs], 0.0)
        """The position of each degree of freedom, in radians or metres. A change is another array,
        so that another thread has all values of one time."""
        self._stamps_of_values_ns = np.full(len(dofs), _UNREPORTED)
        self.reported_count = 0
        """Number of degrees of freedom that :attr:`is_reported` has."""
        self._unreported = unreported
        self._joints = [each.joint.element for each in dofs]
        top_level_elements = [scene.top_level_element(joint) for joint in self._joints]
        # The top-level models have numbers.
        elements, self._models = np.unique(top_level_elements, return_inverse=True)
        self._stamps_of_models_ns = [NEVER] * len(elements)
        self._indices = _indices_from_names(scene, dofs, top_level_elements, model)
        self._slides = frozenset(each.name + SLIDE_SUFFIX for each in dofs if each.is_screw)
        self._followers: dict[int, list[Follower]] = {}
        self._is_free = np.ones(len(dofs), np.bool_)
        leaders = {(each.joint.element, each.number): dof for dof, each in enumerate(dofs)}
        for dof, each in enumerate(dofs):
            mimic = each.axis.mimic
            if mimic is not None and (mimic.joint, mimic.axis) in leaders:
                leader = leaders[mimic.joint, mimic.axis]
                self._followers.setdefault(leader, []).append(Follower(dof, leader, mimic))
                self._is_free[dof] = False

    @property
    def models(self) -> tuple[str, ...]:
        """The top-level models of a world that have such names; none in a model file."""
        return tuple(filter(None, self._indices))

    @property
    def is_known(self) -> NDArray[np.bool_]:
        """Whether the position of each is known."""
        if self._unreported is UnreportedJoints.NONE:
            return self.is_reported | self._is_fixed
        return np.ones(len(self.names), np.bool_)

    @property
    def is_reported(self) -> NDArray[np.bool_]:
        """Whether each has a reported position, or follows from one that has."""
        found: NDArray[np.bool_] = self._stamps_of_values_ns != _UNREPORTED
        return found

    @property
    def stamps_ns(self) -> NDArray[np.int64]:
        """The newest stamp of a message about the top-level model of each."""
        return np.array(self._stamps_of_models_ns, np.int64)[self._models]

    def unreported(self) -> list[str]:
        """Return a name of each joint without a known position that does not follow another."""
        names: dict[int, str] = {}
        for dof in np.flatnonzero(self._is_free & ~self.is_known).tolist():
            names.setdefault(self._joints[dof], self.names[dof])
        return list(names.values())

    def selection(self, names: Sequence[str], model: str = '') -> Selection:
        """
        Look up names.

        :param model: one of :attr:`models`, if only joints inside it are meant; else empty.
        """
        indices = self._indices[model]
        rows = [row for row, name in enumerate(names) if name in indices]
        dofs = [indices[names[row]] for row in rows]
        reached: dict[int, Follower | None] = dict.fromkeys(dofs)
        for leader in (changed := list(reached)):
            for follower in self._followers.get(leader, ()):
                if follower.dof not in reached:
                    reached[follower.dof] = follower
                    changed.append(follower.dof)
        return Selection(
            np.array(rows, np.intp), np.array(dofs, np.intp),
            tuple(filter(None, reached.values())), changed,
            np.unique(self._models[changed]).tolist())

    def unknown(self, names: Iterable[str], model: str = '') -> list[str]:
        """Find names that are unknown or ambiguous, in a model as for :meth:`selection`."""
        indices = self._indices[model]
        return [name for name in names if name not in indices and name not in self._slides]

    def hint(self, name: str, model: str = '') -> str:
        """Return the end of a message about such a name, with the nearest one if there is one."""
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
        dofs, new, invalid = selection.dofs, values[selection.rows], []
        newest_ns = max((self._stamps_of_models_ns[each] for each in selection.models), default=0)
        is_late = stamp_ns < newest_ns and not ignore_stamps
        # Most often all are valid. Comparisons with NaN are false.
        if is_late or not np.abs(new).max(initial=0.0) <= LARGEST_POSITION:
            is_taken = np.abs(new) <= LARGEST_POSITION
            invalid = [self.names[dof] for dof in dofs[~is_taken].tolist()]
            if not ignore_stamps:
                is_taken &= self._stamps_of_values_ns[dofs] <= stamp_ns
            dofs, new = dofs[is_taken], new[is_taken]
        for model in selection.models:
            self._stamps_of_models_ns[model] = max(self._stamps_of_models_ns[model], stamp_ns)
        changed = self.values.copy()
        changed[dofs] = new
        self._stamps_of_values_ns[dofs] = stamp_ns
        is_changed = set(dofs.tolist())
        for dof, leader, mimic in selection.followers:
            value = mimic.multiplier * (changed[leader] - mimic.reference) + mimic.offset
            if leader in is_changed and abs(value) <= LARGEST_POSITION:
                changed[dof] = value
                self._stamps_of_values_ns[dof] = stamp_ns
                is_changed.add(dof)
        self.values = changed
        if self.reported_count < len(self.names):
            self._count_reported()
        return invalid

    def forget_stamps(self) -> None:
        """Accept any time next, after time has jumped back."""
        self._stamps_of_models_ns = [NEVER] * len(self._stamps_of_models_ns)
        np.minimum(self._stamps_of_values_ns, NEVER, out=self._stamps_of_values_ns)

    def take_over(self, before: JointPositions) -> None:
        """Continue with the positions that joints of the same names had before."""
        rows = {name: row for row, name in enumerate(before.names) if before.is_reported[row]}
        here = [dof for dof, name in enumerate(self.names) if name in rows]
        there = [rows[self.names[dof]] for dof in here]
        self.values = self.values.copy()
        self.values[here] = before.values[there]
        self._stamps_of_values_ns[here] = before._stamps_of_values_ns[there]
        for new, old in zip(self._models[here], before._models[there], strict=True):
            self._stamps_of_models_ns[new] = before._stamps_of_models_ns[old]
        self._count_reported()

    def _count_reported(self) -> None:
        self.reported_count = int(np.count_nonzero(self.is_reported))


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
    scene: Scene, dofs: Sequence[DegreeOfFreedom], top_level_elements: Sequence[int], model: str,
) -> dict[str, dict[str, int]]:
    """
    Return all names of the degrees of freedom, with their indices.

    In URDF and in old SDFormat, a joint may have the name of a link; it is then renamed. Its own
    name is still accepted.

    :return: the names for ``''``, and for each top-level model of a world those that mean its own
        degrees of freedom, whatever other models have.
    """
    own: dict[str, dict[str, int]] = {'': {}}
    aliases: dict[str, dict[str, set[int]]] = {'': {}}
    for index, (dof, top) in enumerate(zip(dofs, top_level_elements, strict=True)):
        scoped = scene.names[dof.joint.element]
        if scene.roots[dof.joint.element] or (
                model and not scoped.startswith(model + SEPARATOR)):
            continue
        before = scoped.removesuffix(JOINT_SUFFIX)
        shorter = set()
        for each in {scoped, before} if scene.has(before) else {scoped}:
            steps = each.split(SEPARATOR)
            # All endings of deeply nested names would take the square of their memory.
            for count in {0, *range(max(len(steps) - _MOST_STEPS, 0), len(steps))}:
                for separator in (SEPARATOR, '/'):
                    shorter.add(separator.join(steps[count:]) + dof.suffix)
        is_in_model = scene.world_names and scene.kinds[top] == Kind.MODEL
        for scope in ('', scene.names[top]) if is_in_model else ('',):
            own.setdefault(scope, {}).setdefault(dof.name, index)
            names = aliases.setdefault(scope, {})
            for alias in shorter:
                names.setdefault(alias, set()).add(index)
    return {
        scope: {name: min(found) for name, found in names.items() if len(found) == 1} | own[scope]
        for scope, names in aliases.items()}
