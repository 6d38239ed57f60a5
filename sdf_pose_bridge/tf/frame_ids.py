# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make TF frame ids of scoped SDF names, and names of topics of frame ids.

``robot::arm::hand`` becomes ``robot/arm/hand``, as ros_gz_bridge writes Gazebo's frame ids. Kinds
that may share a name with elements of other kinds have the kind before their own name:
``robot/link/visual/name``.

Gazebo stamps a sensor's messages with the frame id that the file sets (``frame_id`` or
``gz_frame_id``, and Harmonic with ``gz_frame_id`` alone), or with one made of the sensor's name.
Where releases differ, the sensor has both frames. A camera's optical frame is
named by ``optical_frame_id``, or like the camera with ``_optical`` appended. Where the frame id of
a camera is that of a link in the place of the optical frame, it names this frame.

The topic of a frame is named by its id, which may contain any character that XML allows. A level
of a topic name consists of ASCII letters, digits and underscores and starts with a letter (if it
starts with an underscore, it is legal but hidden from ``ros2 topic list``). The rule for each
level between slashes:

* Letters, digits and single underscores stay: ``robot/arm_2/tool`` is its own topic name.
* A run of other characters becomes ``_x<hex>_``, where ``<hex>`` are the bytes of its UTF-8 text,
  two lower-case digits each: ``left camera`` becomes ``left_x20_camera``, ``link-1`` becomes
  ``link_x2d_1``. Underscores beside such a run, and runs of underscores, belong to it:
  ``a__b`` becomes ``a_x5f5f_b``.
* At the beginning of a level the escape has no first underscore, and a digit or an underscore
  there is escaped too: ``3d_map`` becomes ``x33_d_map``.
* An empty level becomes ``x_``.
* Text that looks like an escape is escaped at its first character: ``a_x20_b`` becomes
  ``a_x5f_x20_b``.
* A name longer than the limit is cut, and ends with ``_xh<hex>_``, 32 digits of the SHA-256 of
  the frame id.

So two frame ids never have the same name (as surely as SHA-256 for names that were cut), and a
name depends only on its frame id and the limit.
"""

from __future__ import annotations

from collections.abc import Mapping
import enum
import re
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.chains import ends_from_pointers, Indices
from sdf_pose_bridge.geometry.poses import distance_and_angle, OPTICAL_POSE, Pose, pose_product
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind

_LABELLED_KINDS = [
    kind for kind in Kind if kind.has_name and not kind.is_frame and kind is not Kind.SENSOR]
"""The kinds with name spaces of their own. Gazebo's frame ids of sensors have no kind."""

_SAME_PLACE_M, _SAME_PLACE_RAD = 1e-3, 2e-3
"""The data of a sensor may be that far from their frame, as files round right angles."""

LONGEST_NAME = 160
"""Default limit of a name; the rest is for the node's namespace, its name and ``poses``."""

SHORTEST_LIMIT = 48
"""With a lower limit, a cut name would have no readable part before its hash."""

_ESCAPED = re.compile(r"""
    \A[0-9_][^A-Za-z0-9]*                             # a digit or underscores at the beginning
    | _*[^A-Za-z0-9_][^A-Za-z0-9]*                    # others, with the underscores beside them
    | __+
    | (?=_?x(?:[0-9a-f]{2})+[^A-Za-z0-9])(?:\Ax|_)    # text that reads as an escape
    | \Ax_\Z                                          # text that reads as an empty level
    """, re.VERBOSE)
"""The runs of characters in a level that are escaped."""

_CUT = re.compile(r'_xh[0-9a-f]{32}_$')
_CUT_LENGTH = len('_xh_') + 32


class FrameNames(enum.Enum):
    """The part of a scoped name that the frame id contains."""

    AUTO = 'auto'
    """Relative for a model file, scoped for a world."""
    SCOPED = 'scoped'
    """The names of all models around the element: ``robot/arm/tool``."""
    RELATIVE = 'relative'
    """All but the name of the top-level model: ``arm/tool``."""


class FrameNaming(NamedTuple):
    """Rules to make frame ids of scoped names."""

    names: FrameNames = FrameNames.AUTO
    separator: str = '/'
    """Replaces ``::``."""
    prefix: str = ''
    """Precedes every frame id."""

    def frame_id_from_name(self, name: str) -> str:
        """Make a frame id of a name as in SDF; an empty one if it consists of slashes only."""
        rest = name.replace(SEPARATOR, self.separator).lstrip('/')
        return self.prefix + rest if rest else ''

    def name_from_frame_id(self, frame_id: str) -> str:
        """Return the name of a frame id in the file, which may begin with the prefix already."""
        return frame_id.removeprefix(self.prefix)

    def names_from_scene(self, scene: Scene, elements: Indices) -> list[str]:
        """
        Make the names of which frame ids are made; those that the file sets for sensors are not.

        :param elements: indices of elements, all of the same world or model file; not the index
            of a world or an implicit root.
        :return: a name for each element, as in SDF, with the kind where that is needed.
        """
        is_in_model_file = (scene.kinds[scene.roots[elements[:1]]] == Kind.ROOT).any()
        is_relative = self.names is FrameNames.RELATIVE or (
            self.names is FrameNames.AUTO and is_in_model_file)
        is_top_level = scene.parents[scene.parents] < 0
        models = ends_from_pointers(np.where(is_top_level, -1, scene.parents))[elements]
        names = []
        for element, model in zip(elements.tolist(), models.tolist(), strict=True):
            name, kind = scene.names[element], Kind(scene.kinds[element])
            if kind in _LABELLED_KINDS:
                own_name = scene.own_name(element)
                name = f'{name.removesuffix(own_name)}{kind.label}{SEPARATOR}{own_name}'
            if is_relative and model != element:
                name = name.removeprefix(scene.names[model] + SEPARATOR)
            names.append(name)
        return names

    def frame_ids_from_scene(self, scene: Scene, elements: Indices) -> list[str]:
        """Make the frame ids of elements, as :meth:`names_from_scene` makes names."""
        return list(map(self.frame_id_from_name, self.names_from_scene(scene, elements)))


def frame_ids_with_sensors(
    names: Mapping[int, str], scene: Scene, naming: FrameNaming, root_frame: str,
) -> tuple[dict[int, str], dict[int, str], dict[int, str], dict[int, str]]:
    """
    Make frame ids, and use those that the file sets for sensors.

    A camera's may have a name before that of the link at its optical frame, such as
    ``robot/eye`` for ``eye``.

    :param names: the name of each published element, as :meth:`FrameNaming.names_from_scene`
        makes it.
    :return: the frame ids without those of sensors whose id belongs to another kind of element, or
        of a sensor in the same place; the name of the frame of each published sensor; those
        that mean the optical frame of a camera, whose own name then is that of the link there; and
        the frame ids that only Gazebo Harmonic sends.
    """
    frame_ids = {each: naming.frame_id_from_name(name) for each, name in names.items()}
    sensor_names = {each: names[each] for each in names if each in scene.sensors}
    others = {
        frame_id: element for element, frame_id in frame_ids.items()
        if element not in sensor_names}
    first_sensors: dict[str, int] = {}
    optical_names: dict[int, str] = {}
    for sensor in sensor_names:
        if name := naming.name_from_frame_id(scene.sensors[sensor].frame_id):
            sensor_names[sensor] = name
            frame_ids[sensor] = frame_id = naming.frame_id_from_name(name)
            first = first_sensors.get(frame_id)
            other = others.get(
                frame_id, others.get(naming.frame_id_from_name(name.partition('/')[2])))
            if other is not None and scene.sensors[sensor].is_camera and misplacement(
                    pose_product(scene.pose_of(sensor), OPTICAL_POSE), scene.pose_of(other)) <= 1:
                sensor_names[sensor], optical_names[sensor] = names[other], name
            if sensor in optical_names or frame_id == root_frame or frame_id in others or (
                    first is not None and scene.parents[first] == scene.parents[sensor]
                    and scene.pose_of(first) == scene.pose_of(sensor)):
                del frame_ids[sensor]
                continue
        first_sensors.setdefault(frame_ids[sensor], sensor)
    older_ids = {
        sensor: naming.frame_id_from_name(
            naming.name_from_frame_id(each.older_frame_id) or names[sensor])
        for sensor, each in scene.sensors.items()
        if sensor in names and each.older_frame_id != each.frame_id}
    return frame_ids, sensor_names, optical_names, older_ids


def misplacement(pose: Pose, other: Pose) -> float:
    """Return the distance or the angle of two poses; more than 1 is too far for a sensor."""
    distance_m, angle_rad = distance_and_angle(pose, other)
    return max(distance_m / _SAME_PLACE_M, angle_rad / _SAME_PLACE_RAD)


def topic_name_from_frame_id(frame_id: str, limit: int = LONGEST_NAME) -> str:
    """
    Return the name of a frame's topic by the rule above.

    :param frame_id: any text.
    :param limit: largest length of the name; at least ``SHORTEST_LIMIT``.
    :return: a legal relative topic name without hidden levels.
    """
    name = '/'.join(_level_from_text(level) for level in frame_id.split('/'))
    if len(name) <= limit and not _CUT.search(name):
        return name
    # Imported here because it is slow to import and rarely needed.
    import hashlib
    digest = hashlib.sha256(_bytes_from_text(frame_id)).hexdigest()[:32]
    return f'{name[:limit - _CUT_LENGTH].rstrip("_/")}_xh{digest}_'


def _level_from_text(text: str) -> str:
    if not text:
        return 'x_'
    level = _ESCAPED.sub(lambda run: f'_x{_bytes_from_text(run[0]).hex()}_', text)
    return level.removeprefix('_')


def _bytes_from_text(text: str) -> bytes:
    return text.encode('utf-8', 'surrogatepass')
