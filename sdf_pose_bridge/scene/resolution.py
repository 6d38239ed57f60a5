# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Resolve poses: from each in the frame that it is relative to, to all in the root."""

from __future__ import annotations

import math

import numpy as np

from sdf_pose_bridge.geometry.chains import poses_along_chains
from sdf_pose_bridge.geometry.poses import canonical_poses
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import pose_inverse
from sdf_pose_bridge.geometry.poses import pose_product
from sdf_pose_bridge.geometry.poses import pose_products
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.geometry.poses import relative_pose
from sdf_pose_bridge.geometry.poses import transformed_points
from sdf_pose_bridge.scene.frame_graph import FrameGraph
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.grammar import Kind


def root_poses_from_graph(poses: PoseArray, graph: FrameGraph) -> PoseArray:
    """
    Resolve all poses.

    :param poses: shape (n, 7), pose of each element, or of its placement frame, in the frame that
        it is relative to.
    :return: shape (n, 7), pose of each element in its world or implicit root; unit quaternions
        with w >= 0.
    """
    edges = _edges_of_model_frames(poses, graph)
    references = graph.references
    is_reference = np.zeros(len(references), dtype=bool)
    is_reference[references[references >= 0]] = True
    resolved = poses_along_chains(edges, references, np.flatnonzero(is_reference))
    others = np.flatnonzero(~is_reference & (references >= 0))
    resolved[others] = pose_products(resolved[references[others]], edges[others])
    return canonical_poses(resolved)


def set_automatic_inertials(root_poses: PoseArray, elements: Elements) -> None:
    """
    Move automatic inertials to the centers of mass of their links' collisions.

    :param root_poses: shape (n, 7), pose of each element in its root; changed in place.
    """
    collisions: dict[int, list[int]] = {}
    if elements.automatic_inertials:
        for index in np.flatnonzero(elements.kinds == Kind.COLLISION).tolist():
            collisions.setdefault(int(elements.parents[index]), []).append(index)
    for index, masses in elements.automatic_inertials.items():
        link = int(elements.parents[index])
        points = transformed_points(
            root_poses[collisions[link]],
            np.array([(0.0, 0.0, mass.center_z_m) for mass in masses]))
        root_poses[index, :3] = np.average(
            points, axis=0, weights=[mass.mass_kg for mass in masses])
        root_poses[index, 3:] = root_poses[link, 3:]


def axis_in_joint(
    xyz: tuple[float, float, float], expressed_in: int, joint: int, root_poses: PoseArray,
) -> tuple[float, float, float]:
    """
    Return the direction of an axis of a joint (``JointAxis::ResolveXyz``).

    :param xyz: the axis as written; not zero.
    :param expressed_in: the frame that it is expressed in.
    :param root_poses: shape (n, 7), pose of each element in its root.
    :return: unit vector in the frame of the joint.
    """
    length = math.hypot(*xyz)
    x, y, z = (component / length for component in xyz)
    if expressed_in == joint:
        return x, y, z
    rotations = (
        Pose(0.0, 0.0, 0.0, *root_poses[index, 3:].tolist()) for index in (joint, expressed_in))
    direction = pose_product(relative_pose(*rotations), Pose(x, y, z))
    return direction.x, direction.y, direction.z


def _edges_of_model_frames(poses: PoseArray, graph: FrameGraph) -> PoseArray:
    """
    Replace the pose of each placement frame by that of its model frame.

    With the reference R, the placement frame P and the model frame M,
    ``X_RM = X_RP inverse(X_MP)``. Inner models, which come last, are solved first.
    """
    if not graph.placements:
        return poses
    edges: PoseArray = poses.copy()
    for model in sorted(graph.placements, reverse=True):
        frame = graph.placements[model]
        in_model = Pose()
        while frame != model:
            in_model = pose_product(Pose(*edges[frame].tolist()), in_model)
            frame = int(graph.references[frame])
        edges[model] = pose_product(Pose(*edges[model].tolist()), pose_inverse(in_model))
    return edges
