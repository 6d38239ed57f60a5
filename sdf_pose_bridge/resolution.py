# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Resolve poses: from each in the frame that it is relative to, to all in the root."""

from __future__ import annotations

from collections.abc import Sequence
import itertools

import numpy as np

from sdf_pose_bridge.frame_graph import FrameGraph
from sdf_pose_bridge.poses import Pose
from sdf_pose_bridge.poses import pose_inverse
from sdf_pose_bridge.poses import pose_product
from sdf_pose_bridge.poses import pose_products
from sdf_pose_bridge.poses import PoseArray
from sdf_pose_bridge.rotation import canonical_quaternion

_FEW = 16
"""Up to so many poses at one depth, plain floats are faster than arrays."""


def root_poses_from_graph(poses: PoseArray, graph: FrameGraph) -> PoseArray:
    """
    Resolve all poses.

    :param poses: shape (n, 7), row i that of element i in the frame that it is relative to, or of
        its placement frame.
    :param graph: what each is relative to; without rings.
    :return: shape (n, 7), row i the pose of element i in its world or implicit root; unit
        quaternions with w >= 0.
    """
    edges = _solved_placements(poses, graph)
    resolved: PoseArray = edges.copy()
    references = np.array(graph.references, dtype=np.intp)
    depths = np.array(_depths(graph.references), dtype=np.intp)
    order = np.argsort(depths, kind='stable')
    ends = np.cumsum(np.bincount(depths))
    for start, end in itertools.pairwise(ends.tolist()):
        indices = order[start:end]
        if len(indices) > _FEW:
            resolved[indices] = pose_products(resolved[references[indices]], edges[indices])
            continue
        for index in indices.tolist():
            reference = Pose(*resolved[graph.references[index]].tolist())
            resolved[index] = pose_product(reference, Pose(*edges[index].tolist()))
    resolved[:, 3:] = canonical_quaternion(resolved[:, 3:])
    resolved[:, :3] += 0.0  # no negative zeros
    return resolved


def _solved_placements(poses: PoseArray, graph: FrameGraph) -> PoseArray:
    """
    Replace the pose of each placement frame by that of its model frame.

    With R what the pose is relative to, P the placement frame and M the model frame,
    ``X_RM = X_RP inverse(X_MP)``. The innermost models, which are last, come first.
    """
    models = [index for index, frame in enumerate(graph.placements) if frame >= 0]
    if not models:
        return poses
    edges: PoseArray = poses.copy()
    for model in reversed(models):
        frame = graph.placements[model]
        in_model = Pose()
        while frame != model:
            in_model = pose_product(Pose(*edges[frame].tolist()), in_model)
            frame = graph.references[frame]
        edges[model] = pose_product(Pose(*edges[model].tolist()), pose_inverse(in_model))
    return edges


def _depths(references: Sequence[int]) -> list[int]:
    """Count the poses between each element and the end of its chain."""
    depths = [-1] * len(references)
    for start in range(len(references)):
        chain = []
        node = start
        while node >= 0 and depths[node] < 0:
            chain.append(node)
            node = references[node]
        depth = -1 if node < 0 else depths[node]
        for passed in reversed(chain):
            depth += 1
            depths[passed] = depth
    return depths
