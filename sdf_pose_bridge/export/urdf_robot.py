# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make a tree of links and joints of URDF from the frames of a model in TF.

Each frame becomes a link. A joint of URDF is at its child link. So if a joint of SDFormat is not
at the link that it moves, a link without a mass is inserted there, named after the joint, and the
moved link is fixed to it. A joint with several degrees of freedom becomes a chain of joints with
one each.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import Place, SdfWarning, UrdfNotMadeError
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_product, relative_pose
from sdf_pose_bridge.names import unused_name
from sdf_pose_bridge.printed_text import quoted_names
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.joints import JointAxis, Mimic, NO_REFERENCE, Reference
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frames import is_same_place, LINK_SUFFIX
from sdf_pose_bridge.tf.joint_motion import DegreeOfFreedom, JointMotion
from sdf_pose_bridge.tf.joint_positions import SLIDE_SUFFIX
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT, tf_parents_from_scene
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, elements_in_model, tf_tree_from_scene, TfOptions

NO_LIMIT = 1e16
"""The usual value in URDF and Gazebo for no limit."""

_LONGEST_NAMES = 50_000_000
"""Largest length of all names in a URDF together. The scoped names of a small file can have any
length, and a text is copied several times before it is written."""


class UrdfJoint(NamedTuple):
    """A joint of URDF."""

    name: str
    type: str
    """``fixed``, ``revolute``, ``continuous`` or ``prismatic``."""
    parent: str
    """The name of its parent link."""
    origin: Pose
    """Its pose in its parent link, also the pose of its child link at zero."""
    axis: JointAxis | None = None
    """Its axis with limits, dynamics, and the joint that it follows; None for a fixed joint."""


class UrdfLink(NamedTuple):
    """A link of URDF, with the joint to it."""

    name: str
    element: int
    """The link of the scene; -1 for another frame."""
    joint: UrdfJoint | None
    """None for the first link."""


class UrdfRobot(NamedTuple):
    """A tree of links and joints."""

    name: str
    elements: frozenset[int]
    """The elements of the scene in its model."""
    links: tuple[UrdfLink, ...]
    """In depth-first order, parents before children."""
    warnings: tuple[SdfWarning, ...]


def robot_from_scene(scene: Scene, options: TfOptions) -> UrdfRobot:
    """
    Make the links and joints of a model.

    :param options: the model, which may be left out if the file has only one, and which elements
        become links, with which names. Links do in any case. Names have no prefix.
    :raises SdfError: if the file is URDF, if there is no such model, or none is named where there
        are several, or if its frames cannot have these names.
    """
    if scene.is_urdf:
        msg = 'the file is URDF already'
        raise UrdfNotMadeError(msg, Place(scene.path))
    model = _model(scene, options.model)
    kinds = options.kinds or DEFAULT_KINDS
    return _RobotMaker(scene, model, options._replace(
        model=scene.names[model], kinds=kinds | {Kind.LINK}, frame_prefix='',
        pose_frame='', anchor_models=AnchorModels.ALL, use_joint_states=False,
        follows_models=False, has_joint_links=False)).robot()


def _model(scene: Scene, name: str) -> int:
    if name:
        return int(np.flatnonzero(elements_in_model(scene, name))[0])
    models = np.flatnonzero((scene.kinds == Kind.MODEL) & (scene.parents == 0)).tolist()
    if len(models) != 1:
        names = [scene.names[model] for model in models]
        msg = 'URDF describes one robot, and the file has ' + (
            f'the models {quoted_names(names)}; choose one by --model or the '
            'parameter model' if names else 'no model')
        raise UrdfNotMadeError(msg, Place(scene.path))
    return int(models[0])


class _RobotMaker:

    def __init__(self, scene: Scene, model: int, options: TfOptions) -> None:
        self._scene = scene
        self._model = model
        self._problems = Problems(scene.files)
        self._naming = options.naming
        self._tree = tf_tree_from_scene(scene, options)
        elements = self._tree.elements
        self._elements: list[int] = elements.tolist()
        # The last entry is for the root frame.
        self._links: list[int] = [
            *np.where(scene.kinds[elements] == Kind.LINK, elements, -1).tolist(), -1]
        self._tf_parents = tf_parents_from_scene(scene)
        self._motion = JointMotion(scene, self._tf_parents, options.frame_names)
        self._link_names = dict.fromkeys((self._tree.root_frame, *self._tree.frame_ids), 0)
        self._joint_names: dict[str, int] = {}
        self._dofs: dict[tuple[int, int | None], tuple[str, Mimic | None]] = {}
        """For each degree of freedom the name of its joint, and the joint that it follows."""
        self._leaders: dict[str, Mimic | str] = {}
        """For joints that mimic another one the joint that they follow in the end, or the reason
        why there is none."""
        self._children: defaultdict[str, list[UrdfLink]] = defaultdict(list)

    def robot(self) -> UrdfRobot:
        scene, tree = self._scene, self._tree
        first, root = self._first_link()
        # The joints that move are named first, since joint_states has these names too.
        dofs: defaultdict[int, list[DegreeOfFreedom]] = defaultdict(list)
        for dof, body in zip(self._motion.dofs, self._motion.moved_bodies, strict=True):
            dofs[body].append(dof)
        bodies = {*self._elements, *np.flatnonzero(scene.parents < 0).tolist()}
        steps = [
            self._steps(dofs[element] if parent in bodies else ())
            for element in self._elements for parent in [self._tf_parents.parents.item(element)]]
        ids = (*tree.frame_ids, '', first)
        for frame, parent in enumerate(tree.parents.tolist()):
            if frame != root:
                self._add_frame(frame, ids[parent], steps[frame])
        links, waiting = [], [UrdfLink(first, self._links[root], None)]
        while waiting:
            links.append(waiting.pop())
            waiting += reversed(self._children[links[-1].name])
        self._check_length(links)
        return UrdfRobot(
            scene.own_name(self._model),
            frozenset(np.flatnonzero(elements_in_model(scene, scene.names[self._model])).tolist()),
            tuple(links), (*tree.warnings, *self._problems.warnings))

    def _first_link(self) -> tuple[str, int]:
        """Return the name of the link that has no parent, and its frame; -1 for the root."""
        scene, tree, tf_parents = self._scene, self._tree, self._tf_parents
        tops = np.flatnonzero(tree.parents == ROOT_IS_PARENT).tolist()
        # All but static ones, and those that a joint connects to the world.
        free = [
            frame for frame in tops for element in [self._elements[frame]]
            if not scene.is_static(element)
            and (element not in tf_parents.joints
                 or scene.parents[tf_parents.parents[element]] >= 0)]
        if len(tops) == 1 and free:
            return tree.frame_ids[tops[0]], tops[0]
        for frame in free:
            name = tree.frame_ids[frame]
            self._problems.warning(
                f'"{name}" is fixed to "{tree.root_frame}" in URDF, since nothing else holds it '
                'and URDF has only one tree', scene.place(self._elements[frame]))
        return tree.root_frame, -1

    def _check_length(self, links: Sequence[UrdfLink]) -> None:
        # The name of a link is written as that of the link and as the child of its joint.
        length = sum(
            2 * len(link.name) + (
                len(link.joint.name) + len(link.joint.parent) if link.joint is not None else 0)
            for link in links)
        if length > _LONGEST_NAMES:
            msg = (f'the names in the URDF would have {length} characters together, and it may '
                   f'have {_LONGEST_NAMES}; shorten the names of models, or make names relative '
                   'to the model (frame_names)')
            raise UrdfNotMadeError(msg, self._scene.place(self._model))

    # Joints

    def _steps(self, dofs: Sequence[DegreeOfFreedom]) -> list[tuple[str, str, JointAxis]]:
        """Return the names, types and axes of joints with one degree of freedom each."""
        steps = []
        for dof in dofs:
            name, axis = unused_name(dof.name, self._joint_names), dof.axis
            self._dofs[dof.joint.element, dof.number] = name, axis.mimic
            has_limit = axis.lower > -NO_LIMIT or axis.upper < NO_LIMIT
            turning = 'revolute' if has_limit else 'continuous'
            steps.append((name, turning if dof.rad_per_unit else 'prismatic', axis))
            if dof.is_screw and dof.number is not None:
                # A screw joint slides too.
                follows = Mimic(
                    NO_REFERENCE, dof.number, dof.m_per_unit, 0.0, joint=dof.joint.element)
                steps.append((
                    unused_name(f'{name}{SLIDE_SUFFIX}', self._joint_names), 'prismatic',
                    JointAxis(axis.xyz, mimic=follows)))
        return steps

    def _add_frame(
        self, frame: int, parent: str, steps: Sequence[tuple[str, str, JointAxis]],
    ) -> None:
        tree, name, link = self._tree, self._tree.frame_ids[frame], self._links[frame]
        joint = self._tf_parents.joints.get(self._elements[frame])
        transform = Pose(*tree.transforms[frame].tolist())
        if joint is None or not steps:
            fixed = f'{name}_fixed' if joint is None else self._motion.joint_names[joint.element]
            self._add(name, link, UrdfJoint(
                unused_name(fixed, self._joint_names), 'fixed', parent, transform))
            return
        in_joint = relative_pose(
            self._scene.pose_of(joint.element), Pose(*tree.poses[frame].tolist()))
        is_at_joint = is_same_place(in_joint)
        origin = transform if is_at_joint else pose_product(transform, pose_inverse(in_joint))
        for number, (step, joint_type, axis) in enumerate(steps, 1):
            is_last = is_at_joint and number == len(steps)
            child = name if is_last else unused_name(
                self._naming.frame_id_from_name(f'{step}{LINK_SUFFIX}'), self._link_names)
            self._add(child, link if is_last else -1, UrdfJoint(
                step, joint_type, parent, origin,
                axis._replace(mimic=self._mimic(step, axis.mimic, joint.element))))
            parent, origin = child, Pose()
        if not is_at_joint:
            self._add(name, link, UrdfJoint(
                unused_name(f'{name}_fixed', self._joint_names), 'fixed', parent, in_joint))

    def _add(self, name: str, element: int, joint: UrdfJoint) -> None:
        self._children[joint.parent].append(UrdfLink(name, element, joint))

    def _mimic(self, name: str, follows: Mimic | None, element: int) -> Mimic | None:
        """Return the joint that a joint follows in the end, as not all readers follow several."""
        found = None if follows is None else self._leader(name, follows)
        if isinstance(found, str):
            self._problems.warning(
                f'joint "{name}" mimics nothing in URDF: {found}', self._scene.place(element))
            return None
        return found

    def _leader(self, name: str, follows: Mimic | None) -> Mimic | str:
        """Return the joint that a joint follows in the end, or the reason why there is none."""
        passed: dict[str, Mimic] = {}
        found: Mimic | str
        while follows is not None and name not in self._leaders:
            passed[name] = follows
            name, next_follows = self._dofs.get((follows.joint, follows.axis), ('', None))
            if not name or name in passed:
                found = (f'"{self._scene.names[follows.joint]}" '
                         f'{"follows it in turn" if name else "does not move"}')
                break
            follows = next_follows
        else:
            found = self._leaders.get(name, Mimic(Reference(name), 0, 1.0, 0.0))
        for passed_name, mimic in reversed(passed.items()):
            if isinstance(found, Mimic):
                found = Mimic(
                    found.leader, 0, mimic.multiplier * found.multiplier,
                    mimic.multiplier * (found.offset - mimic.reference) + mimic.offset)
            self._leaders[passed_name] = found
        return found
