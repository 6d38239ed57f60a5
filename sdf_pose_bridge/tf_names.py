# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Name the frames in TF: from scoped SDF names to frame ids.

``robot::arm::hand`` becomes ``robot/arm/hand``, which is how ros_gz_bridge passes on Gazebo's
frame ids; so does a sensor, ``robot/link/sensor``, unless the file sets its ``gz_frame_id``. Kinds
that may share a name with others have the kind before their name: ``robot/link/visual/name``.
"""

from __future__ import annotations

import dataclasses
import enum

from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.scene import Scene

OPTICAL_SUFFIX = '_optical'
"""Follows a camera's frame id in that of its optical frame, where the file names none."""

_KINDS_IN_NAMES = frozenset({
    Kind.VISUAL, Kind.COLLISION, Kind.LIGHT, Kind.PARTICLE_EMITTER, Kind.PROJECTOR, Kind.ACTOR})


class FrameNames(enum.Enum):
    """How frame ids are made of scoped names."""

    AUTO = 'auto'
    """Relative for a model file, scoped for a world."""
    SCOPED = 'scoped'
    """With the names of all models around: ``robot/arm/tool``."""
    RELATIVE = 'relative'
    """Without the name of the top-level model: ``arm/tool``."""


@dataclasses.dataclass(frozen=True)
class FrameNaming:
    """
    The rule by which frame ids are made.

    :param names: how they are made of scoped names.
    :param separator: what stands for ``::``.
    :param prefix: what stands before every id.
    """

    names: FrameNames = FrameNames.AUTO
    separator: str = '/'
    prefix: str = ''

    def frame_ids_from_scene(self, scene: Scene) -> list[str]:
        """
        Name the frames of all elements, as if no file gave any a frame id of its own.

        :param scene: the scene.
        :return: a frame id for each element; empty for worlds, implicit roots, and names that are
            nothing but slashes.
        """
        names = scene.names
        holders: list[int] = scene.parents.tolist()
        kinds: list[int] = scene.kinds.tolist()
        left_out = [0] * len(names)
        ids = []
        for index, (name, kind, holder) in enumerate(zip(names, kinds, holders, strict=True)):
            if holder < 0:
                ids.append('')
                continue
            skipped = left_out[holder]
            is_at_top = holders[holder] < 0
            if is_at_top and self._is_relative(kinds[holder]):
                left_out[index] = len(name) + len(SEPARATOR)
            else:
                left_out[index] = skipped
            if kind in _KINDS_IN_NAMES:
                start = 0 if is_at_top else len(names[holder]) + len(SEPARATOR)
                name = f'{name[:start]}{Kind(kind).label}{SEPARATOR}{name[start:]}'
            ids.append(self.frame_id_from_name(name[skipped:]))
        return ids

    def frame_id_from_name(self, name: str) -> str:
        """
        Make a frame id of a name.

        :param name: as in SDF, scopes set apart by ``::``.
        :return: the frame id; empty if the name is nothing but slashes.
        """
        rest = name.replace(SEPARATOR, self.separator).lstrip('/')
        return self.prefix + rest if rest else ''

    def _is_relative(self, root_kind: int) -> bool:
        if self.names is FrameNames.AUTO:
            return root_kind == Kind.ROOT
        return self.names is FrameNames.RELATIVE
