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
from collections.abc import Sequence
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.scene.scene import Joint
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.grammar import Kind

if TYPE_CHECKING:
    import numpy.typing as npt

NO_PARENT = -1

# Arrays are compared with plain numbers: numpy takes long to find out what an Enum is.
_MODEL = int(Kind.MODEL)
_LINK = int(Kind.LINK)
_JOINT = int(Kind.JOINT)
_FRAME = int(Kind.FRAME)
_SENSOR = int(Kind.SENSOR)

_FIRST = 0
_LAST = 4
"""Classes of bodies by how much the others should hang on them."""


class TfParents(NamedTuple):
    """The parent of each element of a scene, and how the tree hangs on its root."""

    parents: Indices
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
        self._own = np.arange(len(scene.kinds), dtype=np.int32)
        # The body that carries each frame; for a static model its canonical link.
        canonical = scene.canonical_links.take(scene.bodies)
        self._nodes = np.where(canonical >= 0, canonical, scene.bodies)
        _, _, starts, ends = zip(*scene.joints, strict=True) if scene.joints else [()] * 4
        self._ends = (self._nodes.take(_places(starts)), self._nodes.take(_places(ends)))

    def parents(self) -> TfParents:
        scene = self._scene
        kinds, holders = scene.kinds, scene.parents
        parents = np.where(kinds == _FRAME, scene.attachments, holders)
        parents = np.where(kinds == _MODEL, scene.canonical_links, parents)
        parents = np.where(kinds == _JOINT, self._nodes, parents)
        sensors = np.flatnonzero(kinds == _SENSOR)
        of_joints = sensors[kinds[holders[sensors]] == _JOINT]
        parents[of_joints] = self._nodes[holders[of_joints]]
        parents[kinds == _LINK] = NO_PARENT
        bodies, ranks = self._ranked_bodies()
        movers = self._movers_if_trees_hang_on_first(bodies, ranks)
        loops: list[Joint] = []
        if movers is None:
            movers, loops = self._movers_of_any(bodies[np.argsort(ranks)].tolist())
        held = bodies[(movers.take(bodies) == NO_PARENT) & (holders.take(bodies) >= 0)]
        fallbacks = self._fallbacks(held)
        moved = np.flatnonzero(movers != NO_PARENT)
        parents[moved] = movers[moved]
        parents[held] = fallbacks
        anchored = held[fallbacks == scene.roots[held]]
        return TfParents(parents, frozenset(anchored.tolist()), tuple(loops))

    def _ranked_bodies(self) -> tuple[Indices, npt.NDArray[np.int64]]:
        """
        Rank bodies by how much the others should hang on them.

        :return: all bodies, some more than once; and their ranks, no two of which are the same.
        """
        scene = self._scene
        models = np.flatnonzero(scene.kinds == _MODEL).astype(np.int32)
        links = np.flatnonzero(scene.kinds == _LINK).astype(np.int32)
        roots = np.flatnonzero(scene.parents < 0).astype(np.int32)
        canonical = scene.canonical_links.take(models)
        is_static = np.zeros(len(self._own), np.bool_)
        is_static[list(scene.static_models)] = True
        is_child = np.zeros(len(self._own), np.bool_)
        is_child[self._ends[1]] = True
        is_top = scene.parents.take(models) == scene.roots.take(models)
        is_static_top = is_top & is_static.take(models)
        is_empty = ~is_static_top & (canonical < 0)
        models_in_classes = np.where(
            is_static_top, _FIRST, np.where(is_empty, _LAST, np.where(is_top, 1, 2)))
        classes = np.concatenate([
            np.full(len(roots), _FIRST), models_in_classes,
            np.where(is_child.take(links), _LAST, 3)])
        places = np.concatenate([roots, models, links])
        bodies = np.concatenate([roots, np.where(canonical >= 0, canonical, models), links])
        return bodies, classes * len(self._own) + places

    def _movers_if_trees_hang_on_first(
        self, bodies: Indices, ranks: npt.NDArray[np.int64],
    ) -> Indices | None:
        """
        Let every joint move its child on its parent, if that is what a search would find.

        It would if joints make trees, and in each tree the body that no joint moves is the first.

        :param bodies: all bodies, some more than once.
        :param ranks: their ranks; the lowest one of a body counts.
        :return: the body that each one is moved on; None if only a search can tell.
        """
        starts, ends = self._ends
        movers = np.full(len(self._own), NO_PARENT, dtype=np.int32)
        movers[ends] = starts
        if np.count_nonzero(movers != NO_PARENT) != len(ends):
            return None
        tops = self._own.copy()
        tops[ends] = above = starts
        for _ in range(len(ends).bit_length()):
            higher = tops.take(above)
            if np.array_equal(higher, above):
                break
            tops[ends] = above = higher
        if (movers.take(above) != NO_PARENT).any():
            return None
        lowest = np.full(len(tops), np.iinfo(np.int64).max)
        np.minimum.at(lowest, bodies, ranks)
        return movers if (lowest.take(above) < lowest.take(ends)).all() else None

    def _movers_of_any(self, seeds: list[int]) -> tuple[Indices, list[Joint]]:
        """Search from one seed after the other; return also the joints that close loops."""
        neighbours, loops = self._joint_forest()
        movers = np.full(len(self._own), NO_PARENT, dtype=np.int32)
        reached: set[int] = set()
        for seed in seeds:
            if seed in reached:
                continue
            reached.add(seed)
            waiting = deque([seed])
            while waiting:
                node = waiting.popleft()
                for neighbour in neighbours.get(node, ()):
                    if neighbour not in reached:
                        reached.add(neighbour)
                        movers[neighbour] = node
                        waiting.append(neighbour)
        return movers, loops

    def _joint_forest(self) -> tuple[dict[int, list[int]], list[Joint]]:
        """Take joints in file order, leaving out those that join what is joined already."""
        leaders: dict[int, int] = {}

        def leader(node: int) -> int:
            while (above := leaders.setdefault(node, node)) != node:
                leaders[node] = node = leaders[above]
            return node

        neighbours: dict[int, list[int]] = {}
        loops = []
        starts, ends = (each.tolist() for each in self._ends)
        for joint, start, end in zip(self._scene.joints, starts, ends, strict=True):
            first, second = leader(start), leader(end)
            if first == second:
                loops.append(joint)
                continue
            leaders[second] = first
            neighbours.setdefault(start, []).append(end)
            neighbours.setdefault(end, []).append(start)
        return neighbours, loops

    def _fallbacks(self, bodies: Indices) -> Indices:
        """
        Return what bodies hang on that no joint holds: canonical links of models around them.

        The canonical link of a model, which may lie in a nested one, stands for all of that model;
        so it is the models around that one which count.
        """
        holders, roots = self._scene.parents, self._scene.roots
        starts = holders[bodies]
        for rows, around in self._models_around(bodies, starts):
            stands_for = self._scene.canonical_links[around] == bodies[rows]
            starts[rows[stands_for]] = holders[around[stands_for]]
        found = roots[bodies]
        is_found = np.zeros(len(bodies), np.bool_)
        for rows, around in self._models_around(bodies, starts):
            canonical = self._scene.canonical_links[around]
            is_first = (canonical >= 0) & (canonical != bodies[rows]) & ~is_found[rows]
            found[rows[is_first]] = canonical[is_first]
            is_found[rows[is_first]] = True
        return found

    def _models_around(
        self, bodies: Indices, starts: Indices,
    ) -> Iterator[tuple[npt.NDArray[np.intp], Indices]]:
        """Climb from models to the roots, all at once; yield who still climbs, and where."""
        holders, roots = self._scene.parents, self._scene.roots
        rows = np.flatnonzero(starts != roots[bodies])
        around = starts[rows]
        while len(rows):
            yield rows, around
            around = holders[around]
            goes_on = around != roots[bodies[rows]]
            rows, around = rows[goes_on], around[goes_on]


def _places(elements: Sequence[int]) -> npt.NDArray[np.intp]:
    return np.fromiter(elements, np.intp, len(elements))
