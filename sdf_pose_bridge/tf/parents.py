# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Choose the TF parent of every element: what it is fixed to, or what a joint connects it to.

``relative_to`` says only where things start. What moves with what is said by ``attached_to`` and
by joints. So the parent of a frame is what it is attached to, that of a model its canonical link,
and that of a link the link on the other side of a joint.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Container
from collections.abc import Iterable
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.scene.scene import Joint
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.grammar import Kind

# Plain integers: numpy is slow at comparing an array with an Enum.
_MODEL = int(Kind.MODEL)
_LINK = int(Kind.LINK)
_JOINT = int(Kind.JOINT)
_FRAME = int(Kind.FRAME)
_SENSOR = int(Kind.SENSOR)


class TfParents(NamedTuple):
    """The TF parents of all elements of a scene."""

    parents: Indices
    """Index of the parent of each element; -1 for worlds and implicit roots."""
    free_bodies: frozenset[int]
    """Links and models whose parent is the root, although no joint connects them to it."""
    loop_joints: tuple[Joint, ...]
    """Joints that close a loop, which a tree cannot have; in file order."""


def tf_parents_from_scene(scene: Scene) -> TfParents:
    """
    Choose parents for all elements.

    Of joints that form a loop the last one in the file is left out. A tree of joints starts at the
    world if a joint connects it to the world, else at a static model, else at the canonical link
    of a model.

    :param scene: the scene.
    :return: the parents; they form one tree for each world or implicit root.
    """
    kinds = scene.kinds
    # A canonical link represents its model where bodies are connected.
    representatives = np.where(
        scene.canonical_links < 0, np.arange(len(kinds), dtype=np.int32), scene.canonical_links)
    bodies = representatives[scene.bodies]
    is_sensor_of_joint = (kinds == _SENSOR) & (kinds[scene.parents] == _JOINT)
    parents = np.select(
        [kinds == _FRAME, kinds == _MODEL, kinds == _JOINT, is_sensor_of_joint],
        [scene.attachments, scene.canonical_links, bodies, bodies[scene.parents]], scene.parents)
    bodies_of_frames = bodies.tolist()
    ends = [
        (bodies_of_frames[joint.parent], bodies_of_frames[joint.child]) for joint in scene.joints]
    starts = representatives[_elements_by_rank(scene, [child for _, child in ends])].tolist()
    loop_joints: list[int] = []
    joint_parents = _parents_along_joints(ends, starts)
    # Without loops every joint leads to another body.
    if len(joint_parents) < len(ends):
        loop_joints = _joints_that_close_loops(ends)
        left_out = set(loop_joints)
        joint_parents = _parents_along_joints(
            [pair for joint, pair in enumerate(ends) if joint not in left_out], starts)
    free_parents = _parents_of_free_bodies(scene, joint_parents)
    for chosen in (joint_parents, free_parents):
        parents[list(chosen)] = list(chosen.values())
    free_bodies = frozenset(
        body for body, parent in free_parents.items() if scene.parents[parent] < 0)
    return TfParents(parents, free_bodies, tuple(scene.joints[joint] for joint in loop_joints))


def _elements_by_rank(scene: Scene, children: Sequence[int]) -> Indices:
    """
    Order elements by how much a tree of joints should start at them.

    :param scene: the scene.
    :param children: the bodies that are the child of a joint.
    :return: all roots, models and links.
    """
    kinds, has_link = scene.kinds, scene.canonical_links >= 0
    is_root, is_model, is_link = scene.parents < 0, kinds == _MODEL, kinds == _LINK
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


def _parents_along_joints(
    ends: Iterable[tuple[int, int]], starts: Sequence[int],
) -> dict[int, int]:
    """
    Walk along joints, in both directions, from one start after the other.

    :param ends: the two bodies that each joint connects.
    :param starts: bodies.
    :return: for each body that a joint led to, the body that it led from.
    """
    neighbours = defaultdict[int, list[int]](list)
    for first, second in ends:
        neighbours[first].append(second)
        neighbours[second].append(first)
    parents: dict[int, int] = {}
    reached: set[int] = set()
    for start in starts:
        waiting = [] if start in reached or start not in neighbours else [start]
        reached.add(start)
        while waiting:
            body = waiting.pop()
            for neighbour in neighbours[body]:
                if neighbour not in reached:
                    reached.add(neighbour)
                    parents[neighbour] = body
                    waiting.append(neighbour)
    return parents


def _joints_that_close_loops(ends: Iterable[tuple[int, int]]) -> list[int]:
    """Return which joints connect what the joints before them connect already (union-find)."""
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

    That is the canonical link of the model around; for a canonical link, which represents its
    model, the canonical link of the next model around.
    """
    parents, canonical_links = scene.parents.tolist(), scene.canonical_links.tolist()
    is_link, is_model = scene.kinds == _LINK, scene.kinds == _MODEL
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
