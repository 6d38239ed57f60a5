# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Resolve poses, with placement frames and automatic inertials, and axes; make the scene."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import compress
import math
from typing import TypeVar

import numpy as np

from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.geometry.chains import Indices, poses_along_chains
from sdf_pose_bridge.geometry.poses import (
    canonical_poses,
    Pose,
    pose_inverse,
    pose_product,
    pose_products,
    PoseArray,
    relative_pose,
)
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.frame_graph import FrameGraph
from sdf_pose_bridge.scene.joints import JointEnds
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.documents import Document
from sdf_pose_bridge.sdformat.elements import Elements, NO_ELEMENT
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.inertials import Inertial, moments_from_matrix, moved_moments
from sdf_pose_bridge.sdformat.joints import JointAxis, NO_REFERENCE

_Details = TypeVar('_Details')
_NO_AXIS = JointAxis((0.0, 0.0, 1.0))
_LARGEST_M = 1e300
"""Differences of larger coordinates, as in TF, would exceed the range of a double."""


def scene_from_graph(
    document: Document, elements: Elements, graph: FrameGraph, problems: Problems,
) -> Scene:
    """
    Resolve all poses, and leave out unresolved elements.

    :raises SdfError: if a pose is too large.
    """
    poses = _root_poses(elements, graph)
    computed_inertials = _place_automatic_inertials(poses, elements)
    count = len(elements.names)
    is_kept = np.ones(count, dtype=bool)
    is_kept[list(graph.unresolved)] = False
    is_too_large = is_kept & ~(np.abs(poses) <= _LARGEST_M).all(axis=1)
    # A pose that is relative to such a pose follows from it.
    for index in np.flatnonzero(is_too_large & ~is_too_large[graph.references]).tolist():
        msg = (f'the {elements.kind(index).label} "{graph.names[index]}" is not within '
               f'{_LARGEST_M:g} m of the origin of its world or file; poses that are relative to '
               'one another add up')
        problems.error(ElementInvalidError(msg, elements.place_of_pose(index)))
    problems.raise_errors()
    # The last entry is for index -1.
    new_index = np.append(np.where(is_kept, np.cumsum(is_kept) - 1, NO_ELEMENT), NO_ELEMENT)
    new_index_of: list[int] = new_index.tolist()

    def reindexed(old: Sequence[int] | Indices) -> Indices:
        return new_index[np.asarray(old, dtype=np.intp)[is_kept]].astype(np.int32)

    def kept(details: Mapping[int, _Details]) -> Mapping[int, _Details]:
        return {new_index_of[index]: each for index, each in details.items() if is_kept[index]}

    return Scene(
        path=document.path,
        source_format=document.source_format,
        files=tuple(elements.paths),
        names=tuple(compress(graph.names, is_kept.tolist())),
        kinds=elements.kinds[is_kept],
        parents=reindexed(elements.parents),
        roots=reindexed(graph.roots),
        poses=poses[is_kept],
        references=reindexed(graph.references),
        placements=kept({
            model: new_index_of[frame] for model, frame in graph.placements.items()}),
        attachments=reindexed(graph.attachments),
        bodies=reindexed(graph.bodies),
        canonical_links=reindexed(graph.canonical_links),
        static_models=frozenset(
            model for model, details in kept(elements.models).items() if details.is_static),
        joints=tuple(
            _joint(ends, elements, poses, new_index_of)
            for ends in graph.joints if is_kept[ends.joint]),
        sensors=kept(elements.sensors),
        inertials=kept({
            index: inertial
            for index, inertial in {**elements.inertials, **computed_inertials}.items()
            if isinstance(inertial, Inertial)}),
        has_shapes=elements.has_shapes,
        shapes=kept(elements.shapes),
        plugins=kept(elements.plugins),
        urdf_texts=kept({
            model: details.urdf_texts for model, details in elements.models.items()
            if details.urdf_texts}),
        lines=elements.lines[is_kept],
        pose_lines=elements.pose_lines[is_kept],
        includes=kept(elements.includes),
        automatic_inertials=frozenset(kept(elements.automatic_inertials)),
        file_indices=elements.file_indices[is_kept],
        world_names=kept({
            index: elements.names[index]
            for index in np.flatnonzero(elements.kinds == Kind.WORLD).tolist()}),
        warnings=problems.warnings,
        urdf_root=document.urdf_root,
    )


def _joint(
    ends: JointEnds, elements: Elements, poses: PoseArray, new_index_of: Sequence[int],
) -> Joint:
    details = elements.joints[ends.joint]
    axes = []
    for axis, (expressed_in, leader) in zip(details.axes, ends.axes, strict=True):
        if axis is None:
            axes.append(_NO_AXIS)
            continue
        leader = new_index_of[leader]
        axes.append(axis._replace(
            xyz=_axis_in_joint(axis.xyz, expressed_in, ends.joint, poses),
            expressed_in=NO_REFERENCE,
            mimic=axis.mimic._replace(joint=leader) if axis.mimic and leader >= 0 else None))
    return Joint(
        new_index_of[ends.joint], details.type, new_index_of[ends.parent],
        new_index_of[ends.child], (axes[0], axes[1]), details.screw_pitch_m)


def _root_poses(elements: Elements, graph: FrameGraph) -> PoseArray:
    """Return the pose of each element in its world or implicit root, canonical."""
    edges = poses_in_references(elements, graph)
    references = graph.references
    is_reference = np.zeros(len(references), dtype=bool)
    is_reference[references[references >= 0]] = True
    resolved = poses_along_chains(edges, references, np.flatnonzero(is_reference))
    others = np.flatnonzero(~is_reference & (references >= 0))
    resolved[others] = pose_products(resolved[references[others]], edges[others])
    return canonical_poses(resolved)


def _place_automatic_inertials(root_poses: PoseArray, elements: Elements) -> dict[int, Inertial]:
    """
    Move automatic inertials to the centers of mass of their links' collisions, in place.

    :return: the inertials, with the axes of their links.
    """
    if not elements.automatic_inertials:
        return {}
    collisions_of = defaultdict[int, list[int]](list)
    for index in np.flatnonzero(elements.kinds == Kind.COLLISION).tolist():
        collisions_of[int(elements.parents[index])].append(index)
    rotations, inertials = matrix_from_quaternion(root_poses[:, 3:]), {}
    for index, automatic in elements.automatic_inertials.items():
        link, masses = int(elements.parents[index]), np.array(automatic.masses_kg)
        collisions, to_link = collisions_of[link], rotations[link].T
        heights = np.array([solid.center_z_m for solid in automatic.solids])
        points = root_poses[collisions, :3] + (
            heights[:, np.newaxis] * rotations[collisions, :, 2])
        total_kg = float(masses.sum())
        root_poses[index] = root_poses[link]
        if total_kg:
            root_poses[index, :3] = masses @ points / total_kg
        axes = to_link @ rotations[collisions]
        moments = masses[:, np.newaxis] * [solid.moments_m2 for solid in automatic.solids]
        matrix = moved_moments(
            axes * moments[:, np.newaxis] @ axes.transpose(0, 2, 1), masses,
            (points - root_poses[index, :3]) @ to_link.T).sum(axis=0)
        scale = automatic.mass_kg / total_kg if automatic.mass_kg is not None and total_kg else 1.0
        inertials[index] = Inertial(scale * total_kg, moments_from_matrix(scale * matrix))
    return inertials


def _axis_in_joint(
    xyz: tuple[float, float, float], expressed_in: int, joint: int, root_poses: PoseArray,
) -> tuple[float, float, float]:
    """Return a unit vector in the frame of a joint (``JointAxis::ResolveXyz``)."""
    length = math.hypot(*xyz)
    x, y, z = (component / length for component in xyz)
    if expressed_in == joint:
        return x, y, z
    rotations = (
        Pose(0.0, 0.0, 0.0, *root_poses[index, 3:].tolist()) for index in (joint, expressed_in))
    direction = pose_product(relative_pose(*rotations), Pose(x, y, z))
    return direction.x, direction.y, direction.z


def poses_in_references(elements: Elements, graph: FrameGraph) -> PoseArray:
    """
    Return the pose of each element in the frame that it is relative to.

    The pose of a placement frame is replaced by its model frame's. With the reference R, the
    placement frame P and the model frame M, ``X_RM = X_RP inverse(X_MP)``. Inner models, which
    come last, are solved first.
    """
    models = sorted(graph.placements.keys() & elements.models.keys(), reverse=True)
    if not models:
        return elements.poses
    edges: PoseArray = elements.poses.copy()
    # Frames on the way to models that are solved, with these models and the poses in them.
    known: dict[int, tuple[int, Pose]] = {}
    for model in models:
        frame = graph.placements[model]
        steps = []
        while frame != model:
            if frame == NO_ELEMENT:  # as an index, it would be that of the last element
                msg = f'the placement frame of "{graph.names[model]}" is not in it'
                raise RuntimeError(msg)
            steps.append(frame)
            frame = known[frame][0] if frame in known else int(graph.references[frame])
        in_model = Pose()
        for frame in reversed(steps):
            pose = known[frame][1] if frame in known else Pose(*edges[frame].tolist())
            in_model = pose_product(in_model, pose)
            known[frame] = model, in_model
        edges[model] = pose_product(Pose(*edges[model].tolist()), pose_inverse(in_model))
    return edges
