# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Choose the TF parent of every element: the frame that it is fixed to or joined with.

``relative_to`` gives initial poses only; ``attached_to`` and joints define which elements move
together. So the parent of a frame is its attachment, the parent of a model is its canonical link,
and the parent of a link is the link on the other side of a joint.

A URDF keeps its own tree: a link without a joint, except the root, belongs to a floating joint and
has no parent.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container, Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.grammar import Kind

ROOT_IS_PARENT = -1
"""Parent of a frame whose parent is the root frame."""
NO_PARENT = -2
"""Parent of a frame that has no transform."""


class TfParents(NamedTuple):
    """The TF parents of all elements of a scene."""

    parents: Indices
    """Index of the parent of each element; -1 for worlds and implicit roots."""
    free_bodies: frozenset[int]
    """Links and models whose parent is the root, although no joint connects them to it."""
    joints: Mapping[int, Joint]
    """The joint of each body that a joint connects to its parent."""
    reversed_bodies: frozenset[int]
    """Those of these bodies that are at the parent's end of their joint."""
    loop_joints: tuple[Joint, ...]
    """Joints that close a loop, which a tree cannot have; in file order."""


def tf_parents_from_scene(scene: Scene) -> TfParents:
    """
    Choose parents for all elements.

    The last joint of a loop in the file is left out. A tree of joints starts at the world if a
    joint connects it to the world, else at a static model, else at the canonical link of a model.

    :return: the parents; they form one tree for each world or implicit root.
    """
    kinds = scene.kinds
    # A canonical link represents its model where bodies are connected.
    representatives = np.where(
        scene.canonical_links < 0, np.arange(len(kinds), dtype=np.int32), scene.canonical_links)
    bodies = representatives[scene.bodies]
    is_sensor_of_joint = (kinds == Kind.SENSOR) & (kinds[scene.parents] == Kind.JOINT)
    parents = np.select(
        [kinds == Kind.FRAME, kinds == Kind.MODEL, kinds == Kind.JOINT, is_sensor_of_joint],
        [scene.attachments, scene.canonical_links, bodies, bodies[scene.parents]], scene.parents)
    bodies_of_frames = bodies.tolist()
    ends = [
        (bodies_of_frames[joint.parent], bodies_of_frames[joint.child]) for joint in scene.joints]
    starts = representatives[_elements_by_rank(scene, [child for _, child in ends])].tolist()
    loop_joints = _joints_that_close_loops(ends)
    joints = _joints_from_bodies(ends, starts, frozenset(loop_joints))
    joint_parents = {
        body: parent if body == child else child
        for body, joint in joints.items() for parent, child in [ends[joint]]}
    parents[list(joint_parents)] = list(joint_parents.values())
    free_parents = _parents_of_free_bodies(scene, joint_parents)
    free_bodies = np.array(list(free_parents), np.int32)
    parents[free_bodies] = list(free_parents.values())
    return TfParents(
        parents=parents,
        free_bodies=frozenset(free_bodies[scene.parents[parents[free_bodies]] < 0].tolist()),
        joints={body: scene.joints[joint] for body, joint in joints.items()},
        reversed_bodies=frozenset(
            body for body, joint in joints.items() if body == ends[joint][0]),
        loop_joints=tuple(scene.joints[joint] for joint in loop_joints))


def _elements_by_rank(scene: Scene, children: Sequence[int]) -> Indices:
    """
    Order elements by their preference as roots of trees of joints.

    :param children: the bodies that are the child of a joint.
    :return: all roots, models and links.
    """
    kinds, has_link = scene.kinds, scene.canonical_links >= 0
    is_root, is_model, is_link = scene.parents < 0, kinds == Kind.MODEL, kinds == Kind.LINK
    is_static, is_child = np.zeros((2, len(kinds)), np.bool_)
    is_static[list(scene.static_models)] = True
    is_child[children] = True
    is_top_level = is_model & (scene.parents == scene.roots)
    ranks = np.select([
        is_root | (is_top_level & is_static),
        is_top_level & has_link,
        is_model & has_link,
        is_link & ~is_child,
    ], [0, 1, 2, 3], 4)
    elements = np.flatnonzero(is_root | is_model | is_link).astype(np.int32)
    return elements[np.argsort(ranks[elements], kind='stable')]


def _joints_from_bodies(
    ends: Sequence[tuple[int, int]], starts: Sequence[int], left_out: Container[int],
) -> dict[int, int]:
    """
    Follow joints, in both directions, from one start after the other.

    :param ends: the two bodies that each joint connects, parent and child.
    :param left_out: the joints that close loops.
    :return: for each body the joint on the way to it.
    """
    joints_of_bodies = defaultdict[int, list[int]](list)
    for joint, (parent, child) in enumerate(ends):
        if joint not in left_out:
            joints_of_bodies[parent].append(joint)
            joints_of_bodies[child].append(joint)
    joints: dict[int, int] = {}
    for start in starts:
        waiting = [start] if start in joints_of_bodies else []
        while waiting:
            body = waiting.pop()
            for joint in joints_of_bodies.pop(body):
                parent, child = ends[joint]
                neighbour = parent if body == child else child
                # Without loops, only one joint leads to a body, from its other end.
                if neighbour in joints_of_bodies:
                    joints[neighbour] = joint
                    waiting.append(neighbour)
    return joints


def _joints_that_close_loops(ends: Iterable[tuple[int, int]]) -> list[int]:
    """Return the joints whose ends are connected by earlier joints already (union-find)."""
    leaders: dict[int, int] = {}

    def leader(body: int) -> int:
        while (above := leaders.setdefault(body, body)) != body:
            leaders[body] = body = leaders[above]
        return body

    found = []
    for joint, (parent, child) in enumerate(ends):
        first, second = leader(parent), leader(child)
        if first == second:
            found.append(joint)
        leaders[second] = first
    return found


def _parents_of_free_bodies(scene: Scene, connected: Container[int]) -> dict[int, int]:
    """
    Choose the parents of links, and of models without links, that have no parent along joints.

    It is the canonical link of their model; for a canonical link, the next outer one; in
    URDF the root.
    """
    parents, canonical_links = scene.parents.tolist(), scene.canonical_links.tolist()
    is_link, is_model = scene.kinds == Kind.LINK, scene.kinds == Kind.MODEL
    if scene.urdf_root is not None:
        return dict.fromkeys(
            (link for link in np.flatnonzero(is_link).tolist() if link not in connected), 0)
    common_parents = {root: root for root in np.flatnonzero(scene.parents < 0).tolist()}
    outermost_models: dict[int, int] = {}
    for model in np.flatnonzero(is_model).tolist():
        link = canonical_links[model]
        common_parents[model] = link if link >= 0 else common_parents[parents[model]]
        outermost_models.setdefault(link, model)
    return {
        body: common_parents[parents[outermost_models.get(body, body)]]
        for body in np.flatnonzero(is_link | (is_model & (scene.canonical_links < 0))).tolist()
        if body not in connected}
