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
from collections.abc import Iterator, Sequence
from itertools import count
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import Place, SdfWarning, UrdfNotMadeError
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_product, relative_pose
from sdf_pose_bridge.names import quoted_names
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.joints import JointAxis, Mimic
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frame_ids import FrameNaming
from sdf_pose_bridge.tf.joint_links import is_same_place, LINK_SUFFIX
from sdf_pose_bridge.tf.joint_motion import dofs_from_joint
from sdf_pose_bridge.tf.joint_positions import SLIDE_SUFFIX
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT, tf_parents_from_scene
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, elements_in_model, tf_tree_from_scene, TfOptions

NO_LIMIT = 1e16
"""The usual value in URDF and Gazebo for no limit."""

_MOST_NAMES_SHOWN = 10


class UrdfMimic(NamedTuple):
    """The joint that a joint follows: ``multiplier * position + offset``."""

    joint: str
    multiplier: float
    offset: float


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
    """Its axis with limits and dynamics; None for a fixed joint."""
    mimic: UrdfMimic | None = None


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
    if scene.urdf_root is not None:
        msg = 'the file is URDF already'
        raise UrdfNotMadeError(msg, Place(scene.path))
    model = _model(scene, options.model)
    kinds = options.kinds or DEFAULT_KINDS
    return _RobotMaker(scene, model, options._replace(
        model=scene.names[model], kinds=kinds | {Kind.LINK}, frame_prefix='',
        pose_frame='', anchor_models=AnchorModels.ALL, use_joint_states=False)).robot()


def _model(scene: Scene, name: str) -> int:
    if name:
        return int(np.flatnonzero(elements_in_model(scene, name))[0])
    models = np.flatnonzero((scene.kinds == Kind.MODEL) & (scene.parents == 0)).tolist()
    if len(models) != 1:
        names = [scene.names[model] for model in models]
        msg = 'URDF describes one robot, and the file has ' + (
            f'the models {quoted_names(names, _MOST_NAMES_SHOWN)}; choose one by --model or the '
            'parameter model' if names else 'no model')
        raise UrdfNotMadeError(msg, Place(scene.path))
    return int(models[0])


class _Names:
    """Unique names."""

    def __init__(self, used: set[str]) -> None:
        self._used = used

    def new(self, name: str) -> str:
        """Return a name, with a number if it is used already."""
        candidates = (f'{name}_{number}' if number else name for number in count())
        unused = next(each for each in candidates if each not in self._used)
        self._used.add(unused)
        return unused


class _Step(NamedTuple):
    """A joint of URDF that is made from a degree of freedom."""

    name: str
    type: str
    axis: JointAxis


class _RobotMaker:

    def __init__(self, scene: Scene, model: int, options: TfOptions) -> None:
        self._scene = scene
        self._model = model
        self._problems = Problems(scene.files)
        self._tree = tf_tree_from_scene(scene, options)
        self._elements: list[int] = self._tree.elements.tolist()
        self._published = frozenset(self._elements)
        self._tf_parents = tf_parents_from_scene(scene)
        self._names_of_joints = _names_of_joints(scene, FrameNaming(options.frame_names))
        self._link_names = _Names({self._tree.root_frame, *self._tree.frame_ids})
        self._joint_names = _Names(set())
        self._dofs: dict[tuple[int, int | None], tuple[str, Mimic | None]] = {}
        """For each degree of freedom the name of its joint, and the joint that it follows."""
        self._leaders: dict[str, UrdfMimic | str] = {}
        """For joints that mimic another one the joint that they follow in the end, or the reason
        why there is none."""
        self._children: defaultdict[str, list[UrdfLink]] = defaultdict(list)

    def robot(self) -> UrdfRobot:
        scene, tree = self._scene, self._tree
        first, root = self._first_link()
        # The joints that move are named first, since joint_states has these names too.
        steps = [self._steps(element) for element in self._elements]
        ids = (*tree.frame_ids, '', first)
        for frame, parent in enumerate(tree.parents.tolist()):
            if frame != root:
                self._add_frame(frame, ids[parent], steps[frame])
        return UrdfRobot(
            scene.own_name(self._model),
            frozenset(np.flatnonzero(elements_in_model(scene, scene.names[self._model])).tolist()),
            tuple(self._in_order(UrdfLink(first, self._link_of(root), None))),
            (*tree.warnings, *self._problems.warnings))

    def _first_link(self) -> tuple[str, int]:
        """Return the name of the link that has no parent, and its frame; -1 for the root."""
        scene, tree = self._scene, self._tree
        tops = np.flatnonzero(tree.parents == ROOT_IS_PARENT).tolist()
        free = [frame for frame in tops if not self._is_anchored(self._elements[frame])]
        if len(tops) == 1 and free:
            return tree.frame_ids[tops[0]], tops[0]
        for frame in free:
            name = tree.frame_ids[frame]
            self._problems.warning(
                f'"{name}" is fixed to "{tree.root_frame}" in URDF, since nothing else holds it '
                'and URDF has only one tree', scene.place(self._elements[frame]))
        return tree.root_frame, -1

    def _is_anchored(self, element: int) -> bool:
        """Return whether a top-level element is static, or a joint connects it to the world."""
        parent = self._tf_parents.parents[element]
        return self._is_static(element) or (
            element in self._tf_parents.joints and self._scene.parents.item(parent) < 0)

    def _is_static(self, element: int) -> bool:
        scene = self._scene
        return not scene.static_models.isdisjoint(scene.with_ancestors(element))

    def _link_of(self, frame: int) -> int:
        element = -1 if frame < 0 else self._elements[frame]
        return element if element >= 0 and self._scene.kinds[element] == Kind.LINK else -1

    def _in_order(self, first: UrdfLink) -> Iterator[UrdfLink]:
        waiting = [first]
        while waiting:
            link = waiting.pop()
            yield link
            waiting += reversed(self._children[link.name])

    # Joints

    def _steps(self, element: int) -> list[_Step]:
        """List the joints with one degree of freedom each that lead to an element."""
        joint = self._tf_parents.joints.get(element)
        if joint is None or self._is_static(element):
            return []
        parent = int(self._tf_parents.parents[element])
        if parent not in self._published and self._scene.parents[parent] >= 0:
            return []
        is_reversed = element in self._tf_parents.reversed_bodies
        dofs = dofs_from_joint(joint)
        steps: list[_Step] = []
        for dof in reversed(dofs) if is_reversed else dofs:
            x, y, z = dof.axis.xyz
            axis = dof.axis._replace(xyz=(-x, -y, -z)) if is_reversed else dof.axis
            name = self._joint_names.new(self._names_of_joints[joint.element] + dof.suffix)
            self._dofs[joint.element, dof.number] = name, axis.mimic
            if dof.rad_per_unit:
                has_limit = axis.lower > -NO_LIMIT or axis.upper < NO_LIMIT
                steps.append(_Step(name, 'revolute' if has_limit else 'continuous', axis))
            if dof.m_per_unit and not dof.rad_per_unit:
                steps.append(_Step(name, 'prismatic', axis))
            elif dof.m_per_unit and dof.number is not None:
                # A screw joint slides too.
                follows = Mimic(joint.element, dof.number, dof.m_per_unit, 0.0, 0.0)
                steps.append(_Step(
                    self._joint_names.new(f'{name}{SLIDE_SUFFIX}'), 'prismatic',
                    JointAxis(axis.xyz, mimic=follows)))
        return steps

    def _add_frame(self, frame: int, parent: str, steps: Sequence[_Step]) -> None:
        tree, name = self._tree, self._tree.frame_ids[frame]
        link, transform = self._link_of(frame), Pose(*tree.transforms[frame].tolist())
        if not steps:
            joint = self._tf_parents.joints.get(self._elements[frame])
            self._add(name, link, UrdfJoint(
                self._joint_names.new(
                    f'{name}_fixed' if joint is None else self._names_of_joints[joint.element]),
                'fixed', parent, transform))
            return
        element = self._elements[frame]
        joint_pose = self._scene.pose_of(self._tf_parents.joints[element].element)
        in_joint = relative_pose(joint_pose, Pose(*tree.poses[frame].tolist()))
        is_at_joint = is_same_place(in_joint)
        origin = transform if is_at_joint else pose_product(transform, pose_inverse(in_joint))
        for step in steps:
            is_last = is_at_joint and step is steps[-1]
            child = name if is_last else self._link_names.new(f'{step.name}{LINK_SUFFIX}')
            self._add(child, link if is_last else -1, UrdfJoint(
                step.name, step.type, parent, origin, step.axis, self._mimic(step, element)))
            parent, origin = child, Pose()
        if not is_at_joint:
            self._add(name, link, UrdfJoint(
                self._joint_names.new(f'{name}_fixed'), 'fixed', parent, in_joint))

    def _add(self, name: str, element: int, joint: UrdfJoint) -> None:
        self._children[joint.parent].append(UrdfLink(name, element, joint))

    def _mimic(self, step: _Step, element: int) -> UrdfMimic | None:
        """Return the joint that a joint follows in the end, as not all readers follow several."""
        found = None if step.axis.mimic is None else self._leader(step.name, step.axis.mimic)
        if isinstance(found, str):
            self._problems.warning(
                f'joint "{step.name}" mimics nothing in URDF: {found}',
                self._scene.place(self._tf_parents.joints[element].element))
            return None
        return found

    def _leader(self, name: str, follows: Mimic | None) -> UrdfMimic | str:
        """Return the joint that a joint follows in the end, or the reason why there is none."""
        passed: dict[str, Mimic] = {}
        found: UrdfMimic | str | None = None
        while found is None:
            if follows is None:
                found = UrdfMimic(name, 1.0, 0.0)
            elif name in self._leaders:
                found = self._leaders[name]
            else:
                passed[name] = follows
                leader, next_follows = self._dofs.get((follows.joint, follows.axis), ('', None))
                if not leader or leader in passed:
                    found = (f'"{self._scene.names[follows.joint]}" '
                             f'{"follows it in turn" if leader else "does not move"}')
                name, follows = leader, next_follows
        for passed_name, mimic in reversed(passed.items()):
            if isinstance(found, UrdfMimic):
                found = UrdfMimic(
                    found.joint, mimic.multiplier * found.multiplier,
                    mimic.multiplier * (found.offset - mimic.reference) + mimic.offset)
            self._leaders[passed_name] = found
        return found


def _names_of_joints(scene: Scene, naming: FrameNaming) -> dict[int, str]:
    elements = [joint.element for joint in scene.joints]
    names = naming.frame_ids_from_scene(scene, np.array(elements, np.int32))
    return dict(zip(elements, names, strict=True))
