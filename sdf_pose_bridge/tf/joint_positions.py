# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The current positions of joints and poses of free models, by the names that messages use.

A joint is named like a frame id (``arm/elbow``), or as in SDF (``arm::elbow``). The names of
models around it can be left out if the rest is unambiguous. A second axis is called
``<joint>_axis2``; a ball joint has ``<joint>_roll``, ``<joint>_pitch`` and ``<joint>_yaw``.
A free model has its name as in SDF or as a frame id.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
import enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.errors import JointPositionError, Place, SdfWarning
from sdf_pose_bridge.geometry.poses import relative_pose
from sdf_pose_bridge.names import JOINT_SUFFIX, SEPARATOR
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.printed_text import quoted_names
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


class Selection(NamedTuple):
    """The degrees of freedom of a list of names."""

    rows: NDArray[np.intp]
    """The entries of the list that name degrees of freedom."""
    dofs: NDArray[np.intp]
    """The degree of freedom of each of these entries."""
    coordinates: NDArray[np.intp]
    """The coordinates of each: shape (k,) for joints, (k, 7) for free models."""
    followers: list[int]
    """Other degrees of freedom that follow these; each after its leader."""
    changed: list[int]
    """All of these, which get a position."""
    models: list[int]
    """The numbers of their top-level models."""


class JointPositions:
    """
    The coordinates of a scene; at first everything is where the file puts it.

    The positions of joints whose lower limit is the upper one are known from the beginning.

    :param model: the scoped name of the only model whose joints have names; empty for all.
    :param unreported: whether joints without a reported position count as being at zero, and free
        models without a reported pose as being where the file puts them.
    :param is_spawned: whether the model of a model file is one of several in a world.
    """

    def __init__(
        self, scene: Scene, motion: JointMotion, model: str = '',
        unreported: UnreportedJoints = UnreportedJoints.NONE, *, is_spawned: bool = False,
    ) -> None:
        dofs = motion.dofs
        self.names = motion.names
        """The name of each degree of freedom."""
        self.free_models = tuple(scene.names[each] for each in motion.elements[len(dofs):])
        """The scoped names of the free models."""
        self.others = {
            name: dof for dof, name in enumerate(self.names) if dof >= len(motion.elements)}
        """The degrees of freedom of bodies that are not in the scene, by their names."""
        self.all_models = tuple(
            scene.names[each] for each in np.flatnonzero(scene.kinds == Kind.MODEL).tolist())
        """The scoped names of all models."""
        self.nested_models = {
            scene.names[model]: (
                scene.names[outer], relative_pose(scene.pose_of(outer), scene.pose_of(model)))
            for model in motion.elements[len(dofs):]
            if scene.kinds[outer := scene.parents.item(model)] == Kind.MODEL}
        """For each free model in a model the name of that, and its pose there in the file."""
        count = len(self.names)
        self._is_assumed = (np.arange(count) < len(motion.elements)) & (
            unreported is UnreportedJoints.ZERO)
        """Whether the position of each is known without a message."""
        self.values = motion.initial_coordinates.copy()
        """The coordinates. The array is replaced, never changed in place, so another thread has
        all values of one time."""
        self._motion = motion
        self._stamps_of_values_ns = np.full(count, _UNREPORTED)
        # Other bodies have no element, and count as parts of the root.
        top_level_elements = [
            *map(scene.top_level_element, motion.elements), *[0] * len(self.others)]
        # The top-level models have numbers.
        elements, self._models = np.unique(top_level_elements, return_inverse=True)
        self._stamps_of_models_ns = [NEVER] * len(elements)
        self._indices = _indices_from_names(
            scene, dofs, top_level_elements[:len(dofs)], model,
            has_models=is_spawned or bool(scene.world_names))
        self.fixed_joints = frozenset(
            scene.own_name(each.element) for each in scene.joints if each.type == 'fixed')
        """Names that messages may have, too: JointStatePublisher of Gazebo sends all joints."""
        self._slides = frozenset(each.name + SLIDE_SUFFIX for each in dofs if each.is_screw)
        self._followers: dict[int, list[int]] = {}
        self._leaders: dict[int, tuple[int, Mimic]] = {}
        """For each degree of freedom that follows another one, that one and how."""
        indices = {(each.joint.element, each.number): dof for dof, each in enumerate(dofs)}
        for dof, each in enumerate(dofs):
            mimic, lower = each.axis.mimic, each.axis.lower
            if lower == each.axis.upper and abs(lower) <= LARGEST_POSITION:
                self._is_assumed[dof], self.values[dof] = True, lower
            if mimic is not None and (mimic.joint, mimic.axis) in indices:
                leader = indices[mimic.joint, mimic.axis]
                self._followers.setdefault(leader, []).append(dof)
                self._leaders[dof] = leader, mimic

    @property
    def models(self) -> tuple[str, ...]:
        """The top-level models of a world that have such names; none in a model file."""
        return tuple(filter(None, self._indices))

    @property
    def is_known(self) -> NDArray[np.bool_]:
        """Whether the position of each is known."""
        return self.is_reported | self._is_assumed

    @property
    def is_reported(self) -> NDArray[np.bool_]:
        """Whether each has a reported position, or follows from one that has."""
        found: NDArray[np.bool_] = self._stamps_of_values_ns != _UNREPORTED
        return found

    @property
    def reported_count(self) -> int:
        """Number of degrees of freedom that :attr:`is_reported` has."""
        return int(np.count_nonzero(self.is_reported))

    @property
    def stamps_ns(self) -> NDArray[np.int64]:
        """The newest stamp of a message about the top-level model of each."""
        return np.array(self._stamps_of_models_ns, np.int64)[self._models]

    def is_model(self, dof: int) -> bool:
        """Return whether a degree of freedom is a free model, and not of a joint."""
        return dof >= len(self._motion.dofs)

    def unreported(self) -> tuple[list[str], list[str]]:
        """
        Find what has no known coordinates, of all that messages can name.

        :return: a name of each such joint that does not follow another, and the names of such
            free models.
        """
        joints, models, named = dict[int, str](), list[str](), {*self._indices[''].values()}
        for dof in np.flatnonzero(~self.is_known).tolist():
            if self.is_model(dof):
                models.append(self.names[dof])
            elif dof in named and dof not in self._leaders:
                joints.setdefault(self._motion.elements[dof], self.names[dof])
        return list(joints.values()), models

    def selection(self, names: Sequence[str], model: str = '') -> Selection:
        """
        Look up names.

        :param model: one of :attr:`models`, if only joints inside it are meant; else empty.
        """
        indices = self._indices[model]
        rows = [row for row, name in enumerate(names) if name in indices]
        dofs = [indices[names[row]] for row in rows]
        changed = list(dict.fromkeys(dofs))
        count, reached = len(changed), set(changed)
        for leader in changed:
            for follower in self._followers.get(leader, ()):
                if follower not in reached:
                    reached.add(follower)
                    changed.append(follower)
        indices_of_dofs = np.array(dofs, np.intp)
        return Selection(
            np.array(rows, np.intp), indices_of_dofs, indices_of_dofs,
            changed[count:], changed, np.unique(self._models[changed]).tolist())

    def selection_of_models(self, dofs: Sequence[int]) -> Selection:
        """Return the degrees of freedom of free models, for a message that has their poses."""
        indices = np.array(dofs)
        return Selection(
            np.arange(len(dofs)), indices, self._motion.coordinates(indices), [], list(dofs),
            np.unique(self._models[indices]).tolist())

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
        :param values: a value for each name that was looked up, in radians or metres; or a pose,
            shape (k, 7).
        :param stamp_ns: their time. A position of a later time stays.
        :param ignore_stamps: whether no position stays.
        :return: the names whose values are not finite or too large; their positions stay.
        """
        dofs, new = selection.dofs, values[selection.rows]
        is_valid = np.abs(new) <= LARGEST_POSITION  # NaN is not
        if new.ndim > 1:
            is_valid = np.all(is_valid, axis=1)
        is_taken = is_valid & (ignore_stamps | (self._stamps_of_values_ns[dofs] <= stamp_ns))
        for model in selection.models:
            self._stamps_of_models_ns[model] = max(self._stamps_of_models_ns[model], stamp_ns)
        changed = self.values.copy()
        changed[selection.coordinates[is_taken]] = new[is_taken]
        is_changed = set(dofs[is_taken].tolist())
        for dof in selection.followers:
            leader, mimic = self._leaders[dof]
            value = mimic.multiplier * (changed[leader] - mimic.reference) + mimic.offset
            if leader in is_changed and abs(value) <= LARGEST_POSITION:
                changed[dof] = value
                is_changed.add(dof)
        # In this order, as another thread may look up poses meanwhile.
        self.values = changed
        self._stamps_of_values_ns[[*is_changed]] = stamp_ns
        return [self.names[dof] for dof in dofs[~is_valid].tolist()]

    def forget_stamps(self) -> None:
        """Accept any time next, after time has jumped back."""
        self._stamps_of_models_ns = [NEVER] * len(self._stamps_of_models_ns)
        np.minimum(self._stamps_of_values_ns, NEVER, out=self._stamps_of_values_ns)

    def take_over(self, before: JointPositions) -> None:
        """Continue with the reported coordinates of joints and models of the same names."""
        reported = {before._key(dof): dof for dof in np.flatnonzero(before.is_reported).tolist()}
        pairs = [
            (dof, reported[key]) for dof in range(len(self.names))
            if (key := self._key(dof)) in reported]
        values = self.values.copy()
        for dof, old in pairs:
            values[self._coordinates(dof)] = before.values[before._coordinates(old)]
        # In this order, as in :meth:`update`.
        self.values = values
        for dof, old in pairs:
            self._stamps_of_values_ns[dof] = before._stamps_of_values_ns[old]
            self._stamps_of_models_ns[self._models[dof]] = (
                before._stamps_of_models_ns[before._models[old]])

    def _key(self, dof: int) -> tuple[str, bool]:
        """Return the name of a degree of freedom, and whether it is a free model."""
        return self.names[dof], self.is_model(dof)

    def _coordinates(self, dof: int) -> NDArray[np.intp]:
        """Return the coordinates of a degree of freedom."""
        dofs = np.array([dof])
        return self._motion.coordinates(dofs)[0] if self.is_model(dof) else dofs


def leading_dofs(scene: Scene) -> list[DegreeOfFreedom]:
    """Return the degrees of freedom of joints that follow no other one, in file order."""
    dofs = JointMotion(scene, tf_parents_from_scene(scene)).dofs
    return sorted((each for each in dofs if each.axis.mimic is None),
                  key=lambda each: each.joint.element)


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
    state = JointPositions(scene, motion)
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
    for name, dof, value in zip(state.names, motion.dofs, state.values.tolist(), strict=True):
        if not dof.axis.lower <= value <= dof.axis.upper:
            msg = (f'the position {value:g} of "{name}" is beyond its limits, '
                   f'{dof.axis.lower:g} to {dof.axis.upper:g}')
            warnings.append(SdfWarning('WARNING', msg, scene.place(dof.joint.element)))
    return dataclasses.replace(scene, poses=poses, warnings=(*scene.warnings, *warnings))


def _indices_from_names(
    scene: Scene, dofs: Sequence[DegreeOfFreedom], top_level_elements: Sequence[int], model: str,
    *, has_models: bool,
) -> dict[str, dict[str, int]]:
    """
    Return all names of the degrees of freedom, with their indices.

    In URDF and in old SDFormat, a joint may have the name of a link; it is then renamed. Its own
    name is still accepted.

    :param has_models: whether messages can be about a single top-level model.
    :return: the names for ``''``, and for each top-level model, if so, those that mean its own
        degrees of freedom, whatever other models have.
    """
    own: dict[str, dict[str, int]] = {'': {}}
    aliases: dict[str, dict[str, set[int]]] = {'': {}}
    for index, (dof, top) in enumerate(zip(dofs, top_level_elements, strict=True)):
        scoped = scene.names[dof.joint.element]
        if scene.roots[dof.joint.element] or (model and not scoped.startswith(model + SEPARATOR)):
            continue
        before = scoped.removesuffix(JOINT_SUFFIX)
        shorter = set()
        for each in {scoped, before} if scene.has(before) else {scoped}:
            steps = each.split(SEPARATOR)
            # All endings of deeply nested names would take the square of their memory.
            for count in {0, *range(max(len(steps) - _MOST_STEPS, 0), len(steps))}:
                for separator in (SEPARATOR, '/'):
                    shorter.add(separator.join(steps[count:]) + dof.suffix)
        is_in_model = has_models and scene.kinds[top] == Kind.MODEL
        for scope in ('', scene.names[top]) if is_in_model else ('',):
            own.setdefault(scope, {}).setdefault(dof.name, index)
            names = aliases.setdefault(scope, {})
            for alias in shorter:
                names.setdefault(alias, set()).add(index)
    return {
        scope: {name: min(found) for name, found in names.items() if len(found) == 1} | own[scope]
        for scope, names in aliases.items()}
