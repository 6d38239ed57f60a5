# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Choose the parent of every frame in TF: what it is fixed to, or what a joint moves it on.

``relative_to`` says only where things start. What moves with what is said by attachment and by
joints, so those make the tree: frames hang on what they are attached to, models on their canonical
link, links on the link at the other side of a joint.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.scene import Joint
from sdf_pose_bridge.scene import Scene

NO_PARENT = -1


class TfParents(NamedTuple):
    """The parent of each element of a scene, and how the tree hangs on its root."""

    parents: list[int]
    """Index of the element that each hangs on; -1 for worlds and implicit roots."""
    anchored: frozenset[int]
    """Elements that hang on their root only because nothing else holds them: free models."""
    loop_joints: tuple[Joint, ...]
    """Joints that close a loop, which a tree has to leave out."""


def tf_parents_from_scene(scene: Scene) -> TfParents:
    """
    Choose parents for all elements.

    Of joints that close a loop the first ones in the file are kept. Joints to the world come
    before everything else: what is bolted to the world hangs on it.

    :param scene: the scene.
    :return: a tree for each world or implicit root.
    """
    return _Builder(scene).parents()


class _Builder:

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._kinds = [Kind(kind) for kind in scene.kinds.tolist()]
        self._holders: list[int] = scene.parents.tolist()
        self._roots: list[int] = scene.roots.tolist()
        self._bodies: list[int] = scene.bodies.tolist()
        self._canonical: list[int] = scene.canonical_links.tolist()

    def parents(self) -> TfParents:
        parents = [NO_PARENT] * len(self._kinds)
        attachments: list[int] = self._scene.attachments.tolist()
        for index, kind in enumerate(self._kinds):
            if kind is Kind.MODEL:
                parents[index] = self._canonical[index]
            elif kind is Kind.FRAME:
                parents[index] = attachments[index]
            elif kind is Kind.SENSOR and self._kinds[self._holders[index]] is Kind.JOINT:
                parents[index] = self._node(self._holders[index])
            elif kind is not Kind.LINK:
                parents[index] = self._holders[index]
        for joint in self._scene.joints:
            parents[joint.element] = self._node(joint.element)
        neighbours, loops = self._joint_forest()
        anchored = self._hang_bodies(parents, neighbours)
        return TfParents(parents, frozenset(anchored), tuple(loops))

    def _node(self, frame: int) -> int:
        """Return the body that carries a frame; for a static model its canonical link."""
        body = self._bodies[frame]
        canonical = self._canonical[body]
        return canonical if canonical >= 0 else body

    def _joint_forest(self) -> tuple[dict[int, list[int]], list[Joint]]:
        """Take joints in file order, leaving out those that join what is joined already."""
        leaders: dict[int, int] = {}

        def leader(node: int) -> int:
            while (above := leaders.setdefault(node, node)) != node:
                leaders[node] = node = leaders[above]
            return node

        neighbours: dict[int, list[int]] = {}
        loops = []
        for joint in self._scene.joints:
            ends = self._node(joint.parent), self._node(joint.child)
            first, second = leader(ends[0]), leader(ends[1])
            if first == second:
                loops.append(joint)
                continue
            leaders[second] = first
            neighbours.setdefault(ends[0], []).append(ends[1])
            neighbours.setdefault(ends[1], []).append(ends[0])
        return neighbours, loops

    def _hang_bodies(
        self, parents: list[int], neighbours: dict[int, list[int]],
    ) -> list[int]:
        anchored = []
        reached: set[int] = set()
        for seed in self._seeds():
            if seed in reached:
                continue
            reached.add(seed)
            if self._holders[seed] >= 0:
                parents[seed] = self._fallback(seed)
                if parents[seed] == self._roots[seed]:
                    anchored.append(seed)
            waiting = deque([seed])
            while waiting:
                node = waiting.popleft()
                for neighbour in neighbours.get(node, ()):
                    if neighbour not in reached:
                        reached.add(neighbour)
                        parents[neighbour] = node
                        waiting.append(neighbour)
        return anchored

    def _seeds(self) -> Iterator[int]:
        """Yield bodies, those first that the others should hang on; some more than once."""
        children = {self._node(joint.child) for joint in self._scene.joints}
        top: list[int] = []
        nested: list[int] = []
        free: list[int] = []
        rest: list[int] = []
        for index, kind in enumerate(self._kinds):
            if kind in (Kind.WORLD, Kind.ROOT):
                yield index
            elif kind is Kind.MODEL:
                canonical = self._canonical[index]
                body = canonical if canonical >= 0 else index
                is_top = self._holders[index] == self._roots[index]
                if is_top and index in self._scene.static_models:
                    yield body
                elif canonical >= 0:
                    (top if is_top else nested).append(body)
                else:
                    rest.append(index)
            elif kind is Kind.LINK:
                (rest if index in children else free).append(index)
        yield from top
        yield from nested
        yield from free
        yield from rest

    def _fallback(self, body: int) -> int:
        """
        Return what a body hangs on that no joint holds: the canonical link of a model around it.

        The canonical link of a model, which may lie in a nested one, stands for all of that model;
        so it is the models around that one which count.
        """
        holder = start = self._holders[body]
        while holder != self._roots[body]:
            if self._canonical[holder] == body:
                start = self._holders[holder]
            holder = self._holders[holder]
        holder = start
        while holder != self._roots[body]:
            canonical = self._canonical[holder]
            if canonical >= 0 and canonical != body:
                return canonical
            holder = self._holders[holder]
        return holder
