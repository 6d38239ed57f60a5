# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The tree of TF frames that stands for a scene: ids, parents and transforms, free of ROS."""

import enum
from functools import cached_property
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import Problems
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.errors import UnknownFrameError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import pose_product
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.geometry.poses import relative_poses
from sdf_pose_bridge.geometry.rotations import canonical_quaternion
from sdf_pose_bridge.names import hint_from_names
from sdf_pose_bridge.scene.scene import Joint
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.elements import SensorDetails
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.frame_ids import FrameNaming
from sdf_pose_bridge.tf.frame_ids import OPTICAL_SUFFIX
from sdf_pose_bridge.tf.parents import tf_parents_from_scene
from sdf_pose_bridge.tf.texts import Texts

if TYPE_CHECKING:
    import numpy.typing as npt

DEFAULT_KINDS = frozenset({Kind.MODEL, Kind.LINK, Kind.FRAME, Kind.SENSOR})
"""The kinds of element that become frames unless others are asked for."""

OPTICAL_POSE = Pose(0.0, 0.0, 0.0, -0.5, 0.5, -0.5, 0.5)
"""Pose of an optical frame (REP 103: z forward, x right, y down) in its camera (x forward)."""

ON_ROOT = -1
"""Parent of a frame that hangs on the root frame."""
NO_PARENT = -2
"""Parent of a frame that has no transform."""
_NOT_THERE = -3


class AnchorModels(enum.Enum):
    """Which top-level models get a transform from the root frame."""

    ALL = 'all'
    STATIC = 'static'
    """Static models, and what a joint holds to the world."""
    NONE = 'none'


class TfOptions(NamedTuple):
    """What becomes a frame, and what it is called."""

    root_frame: str = 'world'
    """The frame that stands for the world, or for a model file's implicit root."""
    anchor_models: AnchorModels = AnchorModels.ALL
    """Which top-level models get a transform from it."""
    model: str = ''
    """The scoped name of the one model to publish; empty for everything."""
    frame_names: FrameNames = FrameNames.AUTO
    frame_separator: str = '/'
    """What stands for ``::``."""
    frame_prefix: str = ''
    """What stands before every frame id but the root's."""
    kinds: frozenset[Kind] = DEFAULT_KINDS
    """The kinds of element that become frames."""
    optical_frames: bool = True
    """Whether cameras get an optical frame beside their own."""


class _Frames(NamedTuple):
    root_frame: str
    texts: Texts
    """The frame ids, and one more text: the root frame."""
    poses: PoseArray
    """Shape (n, 7): pose of each in the root frame."""
    parents: Indices
    """Which of the frames each hangs on; :data:`ON_ROOT` or :data:`NO_PARENT` if on none."""
    transforms: PoseArray
    """Shape (n, 7): pose of each in its parent; the identity where it has none."""
    elements: Indices
    """The element of the scene that each stands for; -1 for optical frames."""
    world: str
    """The name of the world that they belong to; empty for a model file."""
    warnings: tuple[SdfWarning, ...]


class TfTree(_Frames):
    """
    Frames to publish; entry i of each sequence and array is about frame i.

    Frames stand in the order of the file; the root frame is not among them.
    """

    @cached_property
    def frame_ids(self) -> tuple[str, ...]:
        """Unique, not empty, without leading slashes."""
        return self.texts.strings[:-1]

    @cached_property
    def parent_ids(self) -> tuple[str, ...]:
        """The frame that each hangs on; empty for one that has no transform."""
        # As NO_PARENT and ON_ROOT count from behind.
        ids = (*self.frame_ids, '', self.root_frame)
        return tuple(map(ids.__getitem__, self.parents.tolist()))


def tf_tree_from_scene(scene: Scene, options: TfOptions | None = None) -> TfTree:
    """
    Lay out a scene as TF frames.

    :param scene: the scene; of one that holds several worlds the first is taken.
    :param options: what becomes a frame, and how it is called.
    :return: the tree.
    :raises SdfError: if two frames would share an id, an id would be empty, or the model to
        publish does not exist; ``errors`` on it has all that was found.
    """
    return _Builder(scene, options or TfOptions()).tree()


class _OpticalFrame(NamedTuple):
    """One that stands behind the frames of elements."""

    camera: int
    """The element of the camera."""
    pose: Pose
    parent: int
    """Row of the camera's frame, or that of the root."""


class _Builder:

    def __init__(self, scene: Scene, options: TfOptions) -> None:
        self._scene = scene
        self._options = options
        self._naming = FrameNaming(
            options.frame_names, options.frame_separator, options.frame_prefix)
        self._problems = Problems(scene.files)
        self._parents = tf_parents_from_scene(scene)
        self._texts = Texts(b'')
        self._elements: Indices = np.empty(0, np.int32)
        self._row_of_element = np.full(len(scene.kinds), _NOT_THERE, np.int32)
        self._optical: list[_OpticalFrame] = []

    def tree(self) -> TfTree:
        self._name(self._published())
        parents = self._parent_rows()
        if self._options.optical_frames:
            for index, facts in sorted(self._scene.sensors.items()):
                if facts.is_camera and self._row_of_element[index] != _NOT_THERE:
                    self._add_optical_frame(index, facts)
        for joint in self._parents.loop_joints:
            self._warn_loop(joint)
        self._problems.raise_errors()
        return self._laid_out(parents)

    # What is published

    def _published(self) -> Indices:
        options = self._options
        holders = self._scene.parents
        roots = np.flatnonzero(holders < 0)
        for index in roots[1:].tolist():
            name = self._scene.world_names.get(index)
            what = 'the model beside the worlds' if name is None else f'world "{name}"'
            msg = f'{what} is not published; only the first world or model of a file is'
            self._problems.warning(msg, self._scene.place(index))
        if options.model:
            is_inside = self._is_inside(self._model(options.model))
        else:
            is_inside = self._scene.roots == 0
        wanted = np.array([kind in options.kinds for kind in Kind])
        return np.flatnonzero(
            is_inside & wanted.take(self._scene.kinds) & (holders >= 0)).astype(np.int32)

    def _is_inside(self, model: int) -> 'npt.NDArray[np.bool_]':
        """Tell of each element whether it is a model or something in it."""
        around = self._scene.parents.copy()
        around[model] = model
        # What holds each, then what holds that: twice as far with every step.
        around = np.where(around < 0, np.arange(len(around), dtype=np.int32), around)
        while not np.array_equal(around, further := around[around]):
            around = further
        is_inside: npt.NDArray[np.bool_] = around == model
        return is_inside

    def _model(self, name: str) -> int:
        models: dict[str, int] = {}
        for index in np.flatnonzero(self._scene.kinds == Kind.MODEL).tolist():
            models.setdefault(self._scene.names[index], index)
        if name not in models:
            msg = f'there is no model "{name}" to publish{hint_from_names(name, models)}'
            raise UnknownFrameError(msg, Place(self._scene.path))
        return models[name]

    # What frames are called

    def _name(self, published: Indices) -> None:
        texts = self._naming.frame_ids_from_scene(self._scene, published)
        same: dict[int, int] = {}
        lent: dict[int, str] = {}
        if any(facts.frame_id for facts in self._scene.sensors.values()):
            ids = list(texts)
            same, lent = self._give_sensors_their_ids(published, ids)
            kept = [
                row for row, index in enumerate(published.tolist())
                if index not in same and index not in lent]
            published, texts = published[kept], Texts.from_strings([ids[row] for row in kept])
        texts = texts.with_one_more(self._options.root_frame)
        self._texts, self._elements = texts, published
        self._row_of_element[published] = np.arange(len(published))
        if texts.lengths.min() == 1 or texts.has_repeats() or texts.has_white_space():
            for row in range(len(published)):
                self._judge(row)
        for index, other in same.items():
            self._row_of_element[index] = self._row_of_element[other]
        for index, frame_id in lent.items():
            self._row_of_element[index] = self._row_of_id.get(frame_id, ON_ROOT)

    def _give_sensors_their_ids(
        self, published: Indices, ids: list[str],
    ) -> tuple[dict[int, int], dict[int, str]]:
        """
        Put the frame ids that the file sets in the place of those made of names.

        :return: the sensors that share the frame of another sensor, with that; and those that are
            stamped with the id of a frame that exists by itself, with that id.
        """
        is_sensor = self._scene.kinds[published] == int(Kind.SENSOR)
        existing = {ids[row] for row in np.flatnonzero(~is_sensor).tolist()}
        existing.add(self._options.root_frame)
        sensors: dict[str, int] = {}
        same: dict[int, int] = {}
        lent: dict[int, str] = {}
        for row in np.flatnonzero(is_sensor).tolist():
            index = int(published[row])
            if self._scene.sensors[index].frame_id:
                frame_id = self._naming.frame_id_from_name(self._scene.sensors[index].frame_id)
                other = sensors.get(frame_id)
                if frame_id in existing:
                    lent[index] = frame_id
                    continue
                if other is not None and self._is_same_place(other, index):
                    same[index] = other
                    continue
                ids[row] = frame_id
            sensors.setdefault(ids[row], index)
        return same, lent

    def _is_same_place(self, sensor: int, other: int) -> bool:
        """Tell whether a sensor can share the frame of another one that sets the same id."""
        scene = self._scene
        return bool(
            scene.parents[sensor] == scene.parents[other]
            and (scene.poses[sensor] == scene.poses[other]).all())

    @cached_property
    def _ids(self) -> list[str]:
        """The frame ids, those of optical frames too."""
        return list(self._texts.strings[:-1])

    @cached_property
    def _row_of_id(self) -> dict[str, int]:
        """The row of each id; of several with one id, the first."""
        return dict(zip(reversed(self._ids), range(len(self._ids) - 1, -1, -1), strict=True))

    def _judge(self, row: int) -> None:
        frame_id, element = self._ids[row], self._element(row)
        name = self._scene.names[element]
        place = self._scene.place(element)
        if not frame_id:
            msg = f'"{name}" leaves no frame id: TF takes no leading slash and no empty name'
            self._problems.error(ElementInvalidError(msg, place))
        elif frame_id == self._options.root_frame:
            msg = f'"{name}" would have the frame id "{frame_id}", which is that of the root frame'
            self._problems.error(DuplicateNameError(msg, place))
        elif self._row_of_id[frame_id] != row:
            other = self._element(self._row_of_id[frame_id])
            msg = (f'{self._described(element)} and {self._described(other)} (line '
                   f'{self._scene.lines[other]}) would share the frame id "{frame_id}"; '
                   'frame_names "scoped", or another frame_separator, can tell them apart')
            self._problems.error(DuplicateNameError(msg, place))
        elif any(character.isspace() for character in frame_id):
            msg = f'the frame id "{frame_id}" holds white space, which some tools cannot take'
            self._problems.warning(msg, place)

    def _described(self, element: int) -> str:
        return f'{Kind(self._scene.kinds[element]).label} "{self._scene.names[element]}"'

    def _element(self, row: int) -> int:
        """Return the element of a row; of an optical frame, its camera."""
        count = len(self._elements)
        return int(self._elements[row]) if row < count else self._optical[row - count].camera

    def _add_optical_frame(self, index: int, facts: SensorDetails) -> None:
        camera = int(self._row_of_element[index])
        if facts.optical_frame_id:
            frame_id = self._naming.frame_id_from_name(facts.optical_frame_id)
        elif camera == ON_ROOT:
            frame_id = self._options.root_frame + OPTICAL_SUFFIX
        else:
            frame_id = self._ids[camera] + OPTICAL_SUFFIX
        pose = pose_product(self._scene.pose_of(index), OPTICAL_POSE)
        row = self._row_of_id.get(frame_id)
        if row is not None and self._serves_as_optical_frame(row, pose, facts):
            return
        self._ids.append(frame_id)
        self._optical.append(_OpticalFrame(index, pose, camera))
        self._row_of_id.setdefault(frame_id, len(self._ids) - 1)
        self._judge(len(self._ids) - 1)

    def _serves_as_optical_frame(self, row: int, pose: Pose, facts: SensorDetails) -> bool:
        """Tell whether a frame is there already that a camera's optical frame id means."""
        element = self._element(row)
        is_of_sensor = self._scene.kinds[element] == Kind.SENSOR
        count = len(self._elements)
        other = (
            self._scene.pose_of(element) if row < count else self._optical[row - count].pose)
        return other == pose or (bool(facts.optical_frame_id) and not is_of_sensor)

    # What hangs on what

    def _parent_rows(self) -> Indices:
        """Climb to the next element that is published; what is not stands in no one's way."""
        holders, parents = self._scene.parents, self._parents.parents
        self._row_of_element[holders < 0] = ON_ROOT
        lasts = self._elements.copy()
        above = parents.take(lasts)
        rows: Indices = self._row_of_element.take(above)
        while len(climbing := np.flatnonzero(rows == _NOT_THERE)):
            lasts[climbing] = above[climbing]
            above[climbing] = parents[above[climbing]]
            rows[climbing] = self._row_of_element[above[climbing]]
        if self._options.anchor_models is AnchorModels.ALL:
            return rows
        is_on_root = holders[above] < 0
        is_adrift = np.zeros(len(holders), np.bool_)
        for last in set(lasts[is_on_root].tolist()):
            is_adrift[last] = not self._is_anchored(last)
        rows[is_on_root & is_adrift[lasts]] = NO_PARENT
        return rows

    def _is_anchored(self, element: int) -> bool:
        """Tell whether what hangs on the root directly gets a transform from it."""
        scene = self._scene
        if scene.kinds[element] not in (Kind.LINK, Kind.MODEL):
            return True
        if self._options.anchor_models is AnchorModels.NONE:
            return False
        if element not in self._parents.anchored:
            return True
        while scene.parents[element] != scene.roots[element]:
            element = int(scene.parents[element])
        return element in scene.static_models

    def _warn_loop(self, joint: Joint) -> None:
        names = self._scene.names
        msg = (f'joint "{names[joint.element]}" closes a loop between "{names[joint.parent]}" and '
               f'"{names[joint.child]}"; TF is a tree, so it moves nothing there')
        self._problems.warning(msg, self._scene.place(joint.element))

    def _laid_out(self, parents: Indices) -> TfTree:
        optical = self._optical
        # The last two rows serve the constants for no parent and for the root.
        places = np.array([*(frame.pose for frame in optical), Pose(), Pose()])
        places = np.concatenate([self._scene.poses.take(self._elements, axis=0), places])
        poses = places[:-2]
        parents = np.concatenate(
            [parents, np.array([frame.parent for frame in optical], np.int32)])
        transforms = relative_poses(places.take(parents, axis=0), poses)
        transforms[parents == NO_PARENT] = Pose()
        transforms[:, 3:] = canonical_quaternion(transforms[:, 3:])
        transforms += 0.0  # no negative zeros
        elements = np.concatenate([self._elements, np.full(len(optical), -1, np.int32)])
        for array in (elements, poses, parents, transforms):
            array.setflags(write=False)
        if optical:
            self._texts = Texts.from_strings([*self._ids, self._options.root_frame])
        return TfTree(
            root_frame=self._options.root_frame,
            texts=self._texts,
            poses=poses,
            parents=parents,
            transforms=transforms,
            elements=elements,
            world=self._scene.world_names.get(0, ''),
            warnings=self._problems.warnings,
        )
