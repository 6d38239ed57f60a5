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
from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.chains import ends_from_pointers, Indices
from sdf_pose_bridge.names import scoped_name
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
    joints: Mapping[int, Joint]
    """The joint of each body that a joint connects to its parent."""
    loop_joints: tuple[Joint, ...]
    """Joints that close a loop, which a tree cannot have; in file order."""
    free_models: Mapping[int, int] = MappingProxyType({})
    """The models that move freely in their root, by their canonical links."""

    def with_free_models(
        self, scene: Scene, is_detached: NDArray[np.bool_] | None = None, only_model: str = '',
        models: Collection[int] | None = None,
    ) -> TfParents:
        """
        Let models move freely in their root, which becomes the parent of their canonical links.

        Models that a joint connects to another body, and static models, stay as they are.

        :param is_detached: for each element whether it is a body that gets no transform from the
            root; models in a model with such a body stay too. None for no such body.
        :param only_model: the scoped name of the only model that is published; empty for all.
        :param models: the models that may move freely; None for all.
        """
        published = scoped_name(only_model, '')
        free_models: dict[int, int] = {}
        for model in np.flatnonzero(scene.canonical_links >= 0).tolist():
            link = scene.canonical_links.item(model)
            top_link = scene.canonical_links.item(scene.top_level_element(model))
            name = scoped_name(scene.names[model], '')
            # A model with the canonical link of a model in it comes before that.
            if not (link in free_models or link in self.joints or scene.is_static(link)
                    or (is_detached is not None and is_detached[top_link]) or scene.roots[model]
                    ) and (name.startswith(published) or published.startswith(name)) and (
                        models is None or model in models):
                free_models[link] = model
        parents = self.parents.copy()
        parents[list(free_models)] = 0
        return self._replace(parents=parents, free_models=free_models)

    def free_models_around(self) -> Indices:
        """Return the free model with which each element moves; -1 for none, shape (n,)."""
        models = np.full(len(self.parents), -1, np.int32)
        models[list(self.free_models)] = list(self.free_models.values())
        found: Indices = models[ends_from_pointers(np.where(models >= 0, -1, self.parents))]
        return found


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
    parents = np.select(
        [kinds == Kind.FRAME, kinds == Kind.MODEL, kinds == Kind.JOINT, kinds == Kind.SENSOR],
        [scene.attachments, scene.canonical_links, bodies, bodies[scene.parents]], scene.parents)
    children = bodies[[joint.child for joint in scene.joints]]
    starts = representatives[_elements_by_rank(scene, children)].tolist()
    neighbors, loop_joints = _neighbors_along_joints(scene.joints, bodies.tolist())
    joints: dict[int, Joint] = {}
    for start in starts:
        waiting = [start]
        while waiting:
            body = waiting.pop()
            for neighbor, joint in neighbors.pop(body, ()):
                # Without loops, only one joint leads to a body, from its other end.
                if neighbor in neighbors:
                    joints[neighbor], parents[neighbor] = joint, body
                    waiting.append(neighbor)
    is_free = (kinds == Kind.LINK) | ((kinds == Kind.MODEL) & (scene.canonical_links < 0))
    is_free[list(joints)] = False
    parents[is_free] = 0 if scene.is_urdf else (
        _parents_of_free_bodies(scene, representatives)[is_free])
    return TfParents(parents, joints, loop_joints)


def _elements_by_rank(scene: Scene, children: Indices) -> Indices:
    """Order roots, models and links by their preference as roots; children of joints are last."""
    kinds, has_link = scene.kinds, scene.canonical_links >= 0
    is_root, is_model, is_link = scene.parents < 0, kinds == Kind.MODEL, kinds == Kind.LINK
    is_static, is_child = (
        np.isin(np.arange(len(kinds)), each) for each in (list(scene.static_models), children))
    is_top_level = is_model & (scene.parents == scene.roots)
    ranks = np.select([
        is_root | (is_top_level & is_static),
        is_top_level & has_link,
        is_model & has_link,
        is_link & ~is_child,
    ], [0, 1, 2, 3], 4)
    elements = np.flatnonzero(is_root | is_model | is_link).astype(np.int32)
    return elements[np.argsort(ranks[elements], kind='stable')]


def _neighbors_along_joints(
    joints: Sequence[Joint], bodies: Sequence[int],
) -> tuple[defaultdict[int, list[tuple[int, Joint]]], tuple[Joint, ...]]:
    """
    Return the neighbors of each body, and the joints that are left out.

    These are the joints whose ends are connected by earlier joints already (union-find).
    """
    leaders: dict[int, int] = {}

    def leader(body: int) -> int:
        while (above := leaders.setdefault(body, body)) != body:
            leaders[body] = body = leaders[above]
        return body

    neighbors = defaultdict[int, list[tuple[int, Joint]]](list)
    loop_joints = []
    for joint in joints:
        parent, child = bodies[joint.parent], bodies[joint.child]
        first, second = leader(parent), leader(child)
        if first == second:
            loop_joints.append(joint)
        else:
            leaders[second] = first
            neighbors[parent].append((child, joint))
            neighbors[child].append((parent, joint))
    return neighbors, tuple(loop_joints)


def _parents_of_free_bodies(scene: Scene, representatives: Indices) -> Indices:
    """
    Choose the parents of links, and of models without links, that have no parent along joints.

    It is the canonical link of their model; for a canonical link, the next outer one. A model
    without links leaves it to the model around it.
    """
    canonical_links = scene.canonical_links
    scopes = ends_from_pointers(np.where(canonical_links >= 0, -1, scene.parents))
    # The outermost model of those with one canonical link comes first in the file.
    outermost = np.arange(len(canonical_links), dtype=np.int32)
    models = np.flatnonzero(canonical_links >= 0)[::-1]
    outermost[canonical_links[models]] = models
    found: Indices = representatives[scopes[scene.parents[outermost]]]
    return found
