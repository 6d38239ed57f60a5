# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The TF tree of a scene: frame ids, parents and transforms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.errors import (
    DuplicateNameError,
    ElementInvalidError,
    Place,
    SdfWarning,
    UnknownFrameError,
)
from sdf_pose_bridge.geometry.chains import ends_from_pointers, Indices
from sdf_pose_bridge.geometry.poses import canonical_relative_poses, Pose, PoseArray
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.printed_text import quoted_names
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Joint, ReadOnly, Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.anchors import AnchorModels, AnchorPatterns, detached_bodies
from sdf_pose_bridge.tf.followed import followed_from_topics
from sdf_pose_bridge.tf.frame_ids import frame_ids_with_sensors, FrameNames, FrameNaming
from sdf_pose_bridge.tf.frames import (
    check_frames_of_sensors,
    Frame,
    Frames,
    frames_at_joints,
    older_frames_of_sensors,
    optical_frames_of_cameras,
)
from sdf_pose_bridge.tf.joint_motion import JointMotion, MovingFrames
from sdf_pose_bridge.tf.odometry import Odometry, odometry_from_scene
from sdf_pose_bridge.tf.parents import NO_PARENT, ROOT_IS_PARENT, tf_parents_from_scene, TfParents

DEFAULT_KINDS = frozenset({Kind.MODEL, Kind.LINK, Kind.FRAME, Kind.SENSOR})
"""The kinds of element that become frames unless the options say otherwise."""


class TfOptions(NamedTuple):
    """The elements that become frames, and the rules for their names."""

    root_frame: str = 'world'
    """The frame id of the world, or of a model file's implicit root."""
    anchor_models: AnchorModels | AnchorPatterns = AnchorModels.AUTO
    """The top-level models that get a transform from the root frame."""
    model: str = ''
    """The scoped name of the only model to publish; empty for everything."""
    frame_names: FrameNames = FrameNames.AUTO
    frame_separator: str = '/'
    """Replaces ``::``."""
    frame_prefix: str = ''
    """Precedes every frame id but the root's."""
    kinds: frozenset[Kind] | None = DEFAULT_KINDS
    """The kinds of element that become frames; None for the links of URDF, and for
    :data:`DEFAULT_KINDS` of SDFormat. The model of a URDF never does."""
    pose_frame: str = ''
    """The frame id of the frame in which poses are published; empty for the root frame."""
    optical_frames: bool = True
    """Whether each camera gets an optical frame besides its own."""
    use_joint_states: bool = False
    """Whether moving joints follow ``joint_states``."""
    joint_states_topics: tuple[str, ...] = ('joint_states', '{model}/joint_states')
    """The topics of joint states. If all are those of plugins, other joints do not follow any."""
    follows_models: bool = False
    """Whether the poses of models come from topics or from a simulator. Then
    :attr:`AnchorModels.AUTO` means all models."""
    model_pose_topics: tuple[str, ...] = ()
    """The topics of poses, as for joint states."""
    has_joint_links: bool = False
    """Whether the links without mass at joints of URDF are frames too."""
    others: tuple[str, ...] = ()
    """Names of bodies without parts that the file does not have, and that messages move."""

    @property
    def naming(self) -> FrameNaming:
        """The rules for frame ids."""
        return FrameNaming(self.frame_names, self.frame_separator, self.frame_prefix)


@dataclass(frozen=True, eq=False, repr=False)
class TfTree(ReadOnly):
    """
    The frames to publish, in the order of the file; optical frames follow all others.

    Entry i of each sequence and array is about frame i. The root frame has no entry.
    """

    root_frame: str
    frame_ids: tuple[str, ...]
    """Unique, not empty, without a leading slash."""
    poses: PoseArray
    """Shape (n, 7): pose of each frame in the root frame."""
    pose_frame: str
    """The frame id of the frame in which poses are published."""
    poses_in_pose_frame: PoseArray
    """Shape (n, 7): pose of each frame in that frame."""
    parents: Indices
    """Index of the parent of each frame, or :data:`ROOT_IS_PARENT`, or :data:`NO_PARENT`."""
    transforms: PoseArray
    """Shape (n, 7): pose of each frame in its parent; the identity if it has none."""
    elements: Indices
    """The element of the scene that each frame belongs to; -1 for an optical frame and for one
    at a joint. A sensor has two frames if Gazebo Harmonic sends another id than later releases."""
    nearest_frames: Indices
    """The frame of each element of the scene, or of the nearest element above it in TF that
    has one; or :data:`ROOT_IS_PARENT`, or :data:`NO_PARENT`."""
    moving: MovingFrames | None
    """The frames that joints and free models move; None if they follow no messages."""
    odometry: Mapping[tuple[int, str, str], Odometry]
    """The frames of odometry, as :func:`odometry_from_scene` finds them."""
    at_rest: tuple[Sequence[str], Sequence[str]]
    """A name of each joint that does not follow messages, but could, and the names of models."""
    topic_models: Mapping[str, str]
    """The scoped names of the models that topics of plugins are about, by their names."""
    world: str
    """The name of the world that the frames belong to; empty for a model file."""
    warnings: tuple[SdfWarning, ...]

    @cached_property
    def parent_ids(self) -> tuple[str, ...]:
        """Frame id of the parent of each frame; empty for a frame without a transform."""
        # The last two entries serve the two negative indices.
        ids = (*self.frame_ids, '', self.root_frame)
        return tuple(map(ids.__getitem__, self.parents.tolist()))

    @property
    def fixed_frame(self) -> str:
        """The root of the first tree: the root frame, unless no frame is below it."""
        if ROOT_IS_PARENT in self.parents or not self.frame_ids:
            return self.root_frame
        return self.frame_ids[int(np.flatnonzero(self.parents == NO_PARENT)[0])]

    @cached_property
    def fixed_indices(self) -> NDArray[np.intp]:
        """The frames with a transform that no message changes."""
        is_fixed = self.parents != NO_PARENT
        if self.moving is not None:
            is_fixed[self.moving.indices] = False
        return np.flatnonzero(is_fixed)

    def ids_of_transforms(self, indices: NDArray[np.intp]) -> tuple[list[str], list[str]]:
        """Return the frame ids of the parents of some frames, and their own."""
        rows = indices.tolist()
        return [self.parent_ids[row] for row in rows], [self.frame_ids[row] for row in rows]

    def kind_labels(self, scene: Scene) -> list[str]:
        """Return the label of the kind of each frame; ``optical frame`` for those of cameras."""
        return [
            'optical frame' if element < 0 else Kind(scene.kinds[element]).label
            for element in self.elements.tolist()]

    @property
    def transform_count(self) -> int:
        """Number of frames with a transform."""
        return int(np.count_nonzero(self.parents != NO_PARENT))


def tf_tree_from_scene(
    scene: Scene, options: TfOptions | None = None, *, finds_at_rest: bool = False,
) -> TfTree:
    """
    Make the TF tree of a scene.

    :param scene: the scene; of several worlds, the first one counts.
    :param options: the elements that become frames, and the rules for their names.
    :param finds_at_rest: whether to fill :attr:`TfTree.at_rest`, which takes long for many joints.
    :raises SdfError: if two frames would share an id, an id would be empty, or the model to
        publish does not exist; ``errors`` has all errors that were found.
    """
    options = options or TfOptions()
    naming = options.naming
    problems = Problems(scene.files)
    tf_parents = tf_parents_from_scene(scene)
    elements = _published_elements(scene, options, problems)
    frame_ids, sensor_names, optical_names, older_ids = frame_ids_with_sensors(
        dict(zip(elements.tolist(), _names(naming, scene, elements, problems), strict=True)),
        scene, naming, options.root_frame)
    # The implicit root of a URDF is its link "world", unless the root frame has its frame id.
    world_link = naming.frame_id_from_name(WORLD_FRAME)
    if (scene.urdf_root == WORLD_FRAME and world_link != options.root_frame
            and Kind.LINK in _kinds(scene, options)):
        frame_ids = {0: world_link, **frame_ids}
    elements = np.array(list(frame_ids), np.int32)
    anchors = options.anchor_models
    if anchors is AnchorModels.AUTO and options.follows_models:
        anchors = AnchorModels.ALL
    is_detached = detached_bodies(scene, tf_parents, anchors, problems)
    followed = followed_from_topics(
        scene, tf_parents, is_detached, options.model,
        options.joint_states_topics if options.use_joint_states else None,
        options.model_pose_topics if options.follows_models else None)
    tf_parents, joints = followed.tf_parents, followed.joints
    nearest_frames, parents = _nearest_frames_and_parents(scene, tf_parents, elements, is_detached)
    frames = Frames(list(frame_ids.values()), elements, parents, scene.poses[elements])
    optical_frames = optical_frames_of_cameras(
        frames, sensor_names, optical_names, scene, naming) if options.optical_frames else []
    frames = frames.with_frames(older_frames_of_sensors(
        older_ids, {'', options.root_frame, *frames.ids, *(each[0] for each in optical_frames)},
        nearest_frames, scene))
    element_count = len(frames.ids)
    check_frames_of_sensors(
        frames, sensor_names, older_ids, scene, options.root_frame, naming, problems)
    frames = frames.with_frames(optical_frames)
    _check_frame_ids(frames, scene, options.root_frame, problems)
    problems.raise_errors()
    _warn_of_loops(tf_parents, scene, problems)
    if options.has_joint_links:
        frames = frames.with_frames(frames_at_joints(
            frames, scene, JointMotion(scene, tf_parents, options.frame_names), tf_parents, naming,
            options.root_frame, joints))
    pose_frame = options.pose_frame or options.root_frame
    ids = [options.root_frame, *frames.ids]
    if pose_frame not in ids:
        hint = hint_from_names(pose_frame, ids)
        msg = f'there is no frame "{pose_frame}" to be the pose_frame{hint}'
        raise UnknownFrameError(msg, Place(scene.path))
    reference = ids.index(pose_frame) - 1
    moving, odometry = None, {}
    if options.use_joint_states or options.follows_models:
        motion = JointMotion(
            scene, tf_parents._replace(joints=joints), options.frame_names, options.others)
        others = {naming.frame_id_from_name(name): owner for owner, name in enumerate(
            options.others, len(scene.kinds) + len(motion.elements))}
        frames = frames.with_frames([
            Frame(each, others[each], ROOT_IS_PARENT, Pose())
            for each in sorted(others.keys() - {'', *ids})])
        moving = MovingFrames(motion, frames.poses, frames.parents, frames.owners, reference)
        odometry = odometry_from_scene(
            scene, followed.topics if options.follows_models else [], motion, problems)
    return TfTree(
        root_frame=options.root_frame,
        frame_ids=tuple(frames.ids),
        poses=frames.poses,
        pose_frame=pose_frame,
        poses_in_pose_frame=frames.poses if reference < 0 else canonical_relative_poses(
            frames.poses[reference], frames.poses),
        parents=frames.parents,
        transforms=frames.transforms(),
        elements=np.where(np.arange(len(frames.ids)) < element_count, frames.owners, -1),
        nearest_frames=nearest_frames,
        moving=moving,
        odometry=odometry,
        at_rest=followed.at_rest(
            scene, elements_in_model(scene, options.model), options.frame_names,
        ) if finds_at_rest else ([], []),
        topic_models={name: each.model for each in followed.topics if each.model
                      for name in (each.ros_name, each.gz_name)},
        world=scene.world_names.get(0, ''),
        warnings=problems.warnings,
    )


def _published_elements(scene: Scene, options: TfOptions, problems: Problems) -> Indices:
    is_root = scene.parents < 0
    for root in np.flatnonzero(is_root).tolist()[1:]:
        name = scene.world_names.get(root)
        what = 'the model beside the worlds' if name is None else f'world "{name}"'
        msg = f'{what} is not published; only the first world or model of a file is'
        problems.warning(msg, scene.place(root))
    is_inside = elements_in_model(scene, options.model) if options.model else scene.roots == 0
    kinds = _kinds(scene, options)
    is_wanted = np.array([kind in kinds for kind in Kind])[scene.kinds]
    return np.flatnonzero(is_inside & is_wanted & ~is_root).astype(np.int32)


def _kinds(scene: Scene, options: TfOptions) -> frozenset[Kind]:
    """Return the kinds of element that become frames."""
    if not scene.is_urdf:
        return DEFAULT_KINDS if options.kinds is None else options.kinds
    # Robots of one type have the same name, and a frame has one parent.
    return (frozenset({Kind.LINK}) if options.kinds is None else options.kinds) - {Kind.MODEL}


def elements_in_model(scene: Scene, name: str) -> NDArray[np.bool_]:
    """
    Find a model with its content.

    :param name: scoped name of the model; empty for everything.
    :return: shape (n,), True for the model and the elements in it.
    :raises UnknownFrameError: if there is no such model.
    """
    if not name:
        return np.ones(len(scene.names), np.bool_)
    models = np.flatnonzero(scene.kinds == Kind.MODEL).tolist()
    names = [scene.names[model] for model in models]
    if name not in names:
        models = f'; the models are {quoted_names(names)}' if names else ''
        msg = f'there is no model "{name}" to publish{hint_from_names(name, names)}{models}'
        raise UnknownFrameError(msg, Place(scene.path))
    # The first model of that name counts.
    return scene.are_in([models[names.index(name)]])


def _warn_of_loops(tf_parents: TfParents, scene: Scene, problems: Problems) -> None:
    """Warn of the joints that TF cannot have, once for each top-level model."""
    joints_of_models: dict[int, list[Joint]] = {}
    for joint in tf_parents.loop_joints:
        model = scene.top_level_element(joint.element)
        joints_of_models.setdefault(model, []).append(joint)
    for first, *others in joints_of_models.values():
        others_too = '' if not others else (
            '; like ' + quoted_names([scene.names[each.element] for each in others]))
        msg = (f'joint "{scene.names[first.element]}" closes a loop between '
               f'"{scene.names[first.parent]}" and "{scene.names[first.child]}"; TF is a tree, so '
               f'it moves nothing there{others_too}')
        problems.warning(msg, scene.place(first.element))


def _check_frame_ids(frames: Frames, scene: Scene, root_frame: str, problems: Problems) -> None:
    """Check that frame ids are unique and that TF accepts them."""
    owners = frames.owners.tolist()
    first = {root_frame: ROOT_IS_PARENT}
    clashes: dict[int, list[int]] = {}
    spaced: list[str] = []
    for index, frame_id in enumerate(frames.ids):
        other = first.setdefault(frame_id, index)
        if other == index and frame_id.split() == [frame_id]:
            continue
        owner = owners[index]
        if not frame_id:
            msg = (f'"{scene.names[owner]}" leaves no frame id: TF allows no leading slash and no '
                   'empty name')
            problems.error(ElementInvalidError(msg, scene.place(owner)))
        elif other == ROOT_IS_PARENT:
            msg = (f'"{scene.names[owner]}" would have the frame id "{frame_id}", which is that '
                   'of the root frame')
            problems.error(DuplicateNameError(msg, scene.place(owner)))
        elif other != index:
            clashes.setdefault(other, []).append(owner)
        else:
            spaced.append(frame_id)
    if spaced:
        msg = f'white space, which some tools reject, is in the frame ids {quoted_names(spaced)}'
        problems.warning(msg, scene.place(owners[first[spaced[0]]]))
    for index, others in clashes.items():
        owner, count = owners[index], len(others) - 1
        msg = (f'{_description(scene, others[0])} and {_description(scene, owner)} (line '
               f'{scene.lines[owner]}) would share the frame id "{frames.ids[index]}"'
               f'{f", like {count} more" if count else ""}; {_cure_of_clash(scene, owner)}')
        problems.error(DuplicateNameError(msg, scene.place(others[0])))


def _names(naming: FrameNaming, scene: Scene, elements: Indices, problems: Problems) -> list[str]:
    """Make names; scoped ones for a model file in which a frame has the name of the model."""
    names = naming.names_from_scene(scene, elements)
    if naming.names is not FrameNames.AUTO or not names:
        return names
    model = scene.top_level_element(int(elements[0]))
    name = scene.names[model]
    if names.count(name) < 2:
        return names
    msg = (f'a frame in the model has the name of the model, "{name}", so frame ids begin with '
           'it, as with frame_names "scoped"')
    problems.warning(msg, scene.place(model))
    return naming._replace(names=FrameNames.SCOPED).names_from_scene(scene, elements)


def _cure_of_clash(scene: Scene, element: int) -> str:
    sensor = scene.sensors.get(element)
    if sensor is None or not (sensor.frame_id or sensor.optical_frame_id):
        return 'frame_names "scoped", or another frame_separator, can tell them apart'
    return ('the file sets it, for example by <gz_frame_id>; sensors without one have the names '
            'of their models in their ids, and "kinds" can leave sensors out')


def _description(scene: Scene, element: int) -> str:
    return f'{Kind(scene.kinds[element]).label} "{scene.names[element]}"'


def _nearest_frames_and_parents(
    scene: Scene, tf_parents: TfParents, elements: Indices, is_detached: NDArray[np.bool_],
) -> tuple[Indices, Indices]:
    """
    Find the frame that each element is in, as in :class:`TfTree`, and the parent of each frame.

    The parent is the nearest TF ancestor of the frame's element that has a frame.
    """
    is_root = scene.parents < 0
    frames = np.full(len(is_root), NO_PARENT, np.int32)
    frames[is_root] = ROOT_IS_PARENT
    frames[elements] = np.arange(len(elements))
    ends_here = is_root | is_detached
    ends_here[elements] = True
    nearest_frames: Indices = frames[ends_from_pointers(
        np.where(ends_here, -1, tf_parents.parents))]
    parents: Indices = nearest_frames[tf_parents.parents[elements]]
    # Element 0 is the link "world" of a URDF.
    parents[elements == 0] = ROOT_IS_PARENT
    parents[is_detached[elements]] = NO_PARENT
    return nearest_frames, parents
