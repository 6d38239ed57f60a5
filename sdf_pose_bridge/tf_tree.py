# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The tree of TF frames that stands for a scene: ids, parents and transforms, free of ROS."""

from __future__ import annotations

from collections.abc import Sequence
import dataclasses
import enum
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.elements import SensorFacts
from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import hint_from_names
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.errors import UnknownFrameError
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.poses import Pose
from sdf_pose_bridge.poses import pose_inverses
from sdf_pose_bridge.poses import pose_product
from sdf_pose_bridge.poses import pose_products
from sdf_pose_bridge.poses import PoseArray
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.rotation import canonical_quaternion
from sdf_pose_bridge.scene import Indices
from sdf_pose_bridge.scene import Joint
from sdf_pose_bridge.scene import Scene
from sdf_pose_bridge.tf_names import FrameNames
from sdf_pose_bridge.tf_names import FrameNaming
from sdf_pose_bridge.tf_names import OPTICAL_SUFFIX
from sdf_pose_bridge.tf_parents import tf_parents_from_scene

DEFAULT_KINDS = frozenset({Kind.MODEL, Kind.LINK, Kind.FRAME, Kind.SENSOR})
"""The kinds of element that become frames unless others are asked for."""

OPTICAL_POSE = Pose(0.0, 0.0, 0.0, -0.5, 0.5, -0.5, 0.5)
"""Pose of an optical frame (REP 103: z forward, x right, y down) in its camera (x forward)."""

_NO_PARENT = -1
_ROOT_PARENT = -2


class AnchorModels(enum.Enum):
    """Which top-level models get a transform from the root frame."""

    ALL = 'all'
    STATIC = 'static'
    """Static models, and what a joint holds to the world."""
    NONE = 'none'


@dataclasses.dataclass(frozen=True)
class TfOptions:
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


@dataclasses.dataclass(frozen=True, eq=False)
class TfTree:
    """
    Frames to publish; entry i of each sequence and array is about frame i.

    Frames stand in the order of the file; the root frame is not among them.
    """

    root_frame: str
    frame_ids: tuple[str, ...]
    """Unique, not empty, without leading slashes."""
    poses: PoseArray
    """Shape (n, 7): pose of each in the root frame."""
    parent_ids: tuple[str, ...]
    """The frame that each hangs on; empty for one that has no transform."""
    transforms: PoseArray
    """Shape (n, 7): pose of each in its parent; the identity where it has none."""
    elements: Indices
    """The element of the scene that each stands for; -1 for optical frames."""
    world: str
    """The name of the world that they belong to; empty for a model file."""
    warnings: tuple[SdfWarning, ...]


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


class _Frame(NamedTuple):
    """One row of the tree while it is being laid out."""

    frame_id: str
    element: int
    pose: Pose
    parent: int
    """Row of the frame that it hangs on, or one of the constants."""


class _Builder:

    def __init__(self, scene: Scene, options: TfOptions) -> None:
        self._scene = scene
        self._options = options
        self._naming = FrameNaming(
            options.frame_names, options.frame_separator, options.frame_prefix)
        self._problems = Problems(scene.files)
        self._kinds: list[int] = scene.kinds.tolist()
        self._holders: list[int] = scene.parents.tolist()
        self._roots: list[int] = scene.roots.tolist()
        self._parents = tf_parents_from_scene(scene)
        self._rows: list[_Frame] = []
        self._row_of_id: dict[str, int] = {}
        self._row_of_element: dict[int, int] = {}
        self._optical_rows: set[int] = set()

    def tree(self) -> TfTree:
        published = self._published()
        self._name(published)
        for row, frame in enumerate(self._rows):
            self._rows[row] = frame._replace(parent=self._parent_row(frame.element))
        if self._options.optical_frames:
            for index in published:
                self._add_optical_frame(index)
        for joint in self._parents.loop_joints:
            self._warn_loop(joint)
        self._problems.raise_any()
        return self._laid_out()

    # What is published

    def _published(self) -> list[int]:
        options = self._options
        roots = [index for index, holder in enumerate(self._holders) if holder < 0]
        for index in roots[1:]:
            name = self._scene.world_names.get(index)
            what = 'the model beside the worlds' if name is None else f'world "{name}"'
            msg = f'{what} is not published; only the first world or model of a file is'
            self._problems.warning('WARNING', msg, self._scene.place(index))
        wanted = [kind in options.kinds for kind in Kind]
        inside = set(roots[:1])
        if options.model:
            inside = {self._model(options.model)}
        for index, holder in enumerate(self._holders):
            if holder in inside:
                inside.add(index)
        return [
            index for index in sorted(inside)
            if wanted[self._kinds[index]] and self._holders[index] >= 0]

    def _model(self, name: str) -> int:
        models = {
            self._scene.names[index]: index
            for index, kind in reversed(list(enumerate(self._kinds))) if kind == Kind.MODEL}
        if name not in models:
            msg = f'there is no model "{name}" to publish{hint_from_names(name, models)}'
            raise UnknownFrameError(msg, Place(self._scene.path))
        return models[name]

    # What frames are called

    def _name(self, published: Sequence[int]) -> None:
        ids = self._naming.frame_ids_from_scene(self._scene)
        existing = {
            ids[index]: index for index in published if self._kinds[index] != Kind.SENSOR}
        for index in published:
            frame_id = ids[index]
            if self._kinds[index] == Kind.SENSOR and self._scene.sensors[index].frame_id:
                frame_id = self._naming.frame_id_from_name(self._scene.sensors[index].frame_id)
                if frame_id in existing or frame_id == self._options.root_frame:
                    continue
                row = self._row_of_id.get(frame_id)
                if row is not None and self._is_same_place(self._rows[row], index):
                    self._row_of_element[index] = row
                    continue
            pose = Pose(*self._scene.poses[index].tolist())
            self._row_of_element[index] = self._add(frame_id, index, pose)
        for index in published:
            if index not in self._row_of_element:
                # The frame that the sensor's messages are stamped with exists by itself.
                frame_id = self._naming.frame_id_from_name(self._scene.sensors[index].frame_id)
                self._row_of_element[index] = self._row_of_id.get(frame_id, _ROOT_PARENT)

    def _is_same_place(self, frame: _Frame, index: int) -> bool:
        """Tell whether a sensor can share the frame of another one that sets the same id."""
        return (self._kinds[frame.element] == Kind.SENSOR
                and self._holders[frame.element] == self._holders[index]
                and frame.pose == Pose(*self._scene.poses[index].tolist()))

    def _add(self, frame_id: str, element: int, pose: Pose) -> int:
        row = len(self._rows)
        name = self._scene.names[element]
        place = self._scene.place(element)
        if not frame_id:
            msg = f'"{name}" leaves no frame id: TF takes no leading slash and no empty name'
            self._problems.error(ElementInvalidError(msg, place))
        elif frame_id == self._options.root_frame:
            msg = f'"{name}" would have the frame id "{frame_id}", which is that of the root frame'
            self._problems.error(DuplicateNameError(msg, place))
        elif frame_id in self._row_of_id:
            other = self._rows[self._row_of_id[frame_id]].element
            msg = (f'{self._described(element)} and {self._described(other)} (line '
                   f'{self._scene.lines[other]}) would share the frame id "{frame_id}"; '
                   'frame_names "scoped", or another frame_separator, can tell them apart')
            self._problems.error(DuplicateNameError(msg, place))
        elif any(character.isspace() for character in frame_id):
            msg = f'the frame id "{frame_id}" holds white space, which some tools cannot take'
            self._problems.warning('WARNING', msg, place)
        self._row_of_id.setdefault(frame_id, row)
        self._rows.append(_Frame(frame_id, element, pose, _NO_PARENT))
        return row

    def _described(self, element: int) -> str:
        return f'{Kind(self._kinds[element]).label} "{self._scene.names[element]}"'

    def _add_optical_frame(self, index: int) -> None:
        facts = self._scene.sensors.get(index)
        if facts is None or not facts.is_camera:
            return
        camera = self._row_of_element[index]
        if facts.optical_frame_id:
            frame_id = self._naming.frame_id_from_name(facts.optical_frame_id)
        elif camera == _ROOT_PARENT:
            frame_id = self._options.root_frame + OPTICAL_SUFFIX
        else:
            frame_id = self._rows[camera].frame_id + OPTICAL_SUFFIX
        pose = pose_product(Pose(*self._scene.poses[index].tolist()), OPTICAL_POSE)
        row = self._row_of_id.get(frame_id)
        if row is not None and self._serves_as_optical_frame(row, pose, facts):
            return
        row = self._add(frame_id, index, pose)
        self._rows[row] = self._rows[row]._replace(parent=camera)
        self._optical_rows.add(row)

    def _serves_as_optical_frame(self, row: int, pose: Pose, facts: SensorFacts) -> bool:
        """Tell whether a frame is there already that a camera's optical frame id means."""
        frame = self._rows[row]
        is_of_sensor = self._kinds[frame.element] == Kind.SENSOR
        return frame.pose == pose or (bool(facts.optical_frame_id) and not is_of_sensor)

    # What hangs on what

    def _parent_row(self, element: int) -> int:
        """Climb to the next element that is published; what is not stands in no one's way."""
        last = element
        parent = self._parents.parents[element]
        while parent not in self._row_of_element and self._holders[parent] >= 0:
            last = parent
            parent = self._parents.parents[parent]
        if self._holders[parent] >= 0:
            return self._row_of_element[parent]
        return _ROOT_PARENT if self._is_anchored(last) else _NO_PARENT

    def _is_anchored(self, element: int) -> bool:
        """Tell whether what hangs on the root directly gets a transform from it."""
        if self._kinds[element] not in (Kind.LINK, Kind.MODEL):
            return True
        if self._options.anchor_models is not AnchorModels.STATIC:
            return self._options.anchor_models is AnchorModels.ALL
        if element not in self._parents.anchored:
            return True
        while self._holders[element] != self._roots[element]:
            element = self._holders[element]
        return element in self._scene.static_models

    def _is_world(self) -> bool:
        return bool(self._kinds) and self._kinds[0] == Kind.WORLD

    def _warn_loop(self, joint: Joint) -> None:
        names = self._scene.names
        msg = (f'joint "{names[joint.element]}" closes a loop between "{names[joint.parent]}" and '
               f'"{names[joint.child]}"; TF is a tree, so it moves nothing there')
        self._problems.warning('WARNING', msg, self._scene.place(joint.element))

    def _laid_out(self) -> TfTree:
        poses = np.array([frame.pose for frame in self._rows], dtype=np.float64).reshape(-1, 7)
        parents = np.array([frame.parent for frame in self._rows], dtype=np.intp)
        # The last two rows serve the constants for no parent and for the root.
        origins = np.concatenate([poses, [Pose(), Pose()]])[parents]
        transforms = pose_products(pose_inverses(origins), poses)
        transforms[parents == _NO_PARENT] = Pose()
        transforms[:, 3:] = canonical_quaternion(transforms[:, 3:])
        transforms[:, :3] += 0.0  # no negative zeros
        elements = np.array(
            [-1 if row in self._optical_rows else frame.element
             for row, frame in enumerate(self._rows)], dtype=np.int32)
        elements.setflags(write=False)
        ids = (*(frame.frame_id for frame in self._rows), self._options.root_frame, '')
        poses.setflags(write=False)
        transforms.setflags(write=False)
        return TfTree(
            root_frame=self._options.root_frame,
            frame_ids=ids[:-2],
            poses=poses,
            parent_ids=tuple(ids[parent] for parent in parents.tolist()),
            transforms=transforms,
            elements=elements,
            world=next(iter(self._scene.world_names.values()), '') if self._is_world() else '',
            warnings=self._problems.warnings,
        )
