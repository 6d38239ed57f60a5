# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
A file or a text that was read, with its TF tree.

:mod:`~sdf_pose_bridge.export.scene_from_request` makes it, in another process than that of the
node. So nothing that parses a file is imported here.
"""

from __future__ import annotations

import enum
from pathlib import Path
from typing import NamedTuple

from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.limits import MissingInclude
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import TfOptions, TfTree


class DescriptionFormat(enum.Enum):
    """The text on the topic ``robot_description``."""

    AS_GIVEN = 'as_given'
    """The unchanged text, unless it is a world."""
    URDF = 'urdf'
    """URDF made of the published model; URDF is not changed."""


class LoadRequest(NamedTuple):
    """The settings of a load."""

    sdf_file: str
    """A path or a URI; empty for a text."""
    robot_description: str
    """A text, if there is no file."""
    resource_paths: tuple[Path, ...] = ()
    on_missing_include: MissingInclude = MissingInclude.ERROR
    tf_options: TfOptions = TfOptions()
    unreported_joints: UnreportedJoints = UnreportedJoints.NONE
    description_format: DescriptionFormat = DescriptionFormat.AS_GIVEN
    model_name: str = ''
    """Replaces the name of the model of a model file; empty for the name in the file."""

    @property
    def source(self) -> str:
        """The name of the file or of the parameter, for messages."""
        return self.sdf_file or 'robot_description'


class LoadedScene(NamedTuple):
    """A file, or a text, that was read."""

    request: LoadRequest
    path: Path
    """The path of the file; of a text, the name of its parameter."""
    text: str | bytes
    """The text that was read; bytes are in the encoding that they declare."""
    description: str
    """The text for the topic ``robot_description``; empty for a world, and if no URDF can be
    made."""
    scene: Scene
    tree: TfTree
    lookup: PoseLookup
    joint_positions: JointPositions | None
    """The positions of its joints; None if joints do not follow ``joint_states``."""
    warnings: tuple[SdfWarning, ...]
    """Without warnings that concern Gazebo only."""
    gazebo_warning_count: int
    """Number of warnings that concern Gazebo only."""
    files: tuple[str, ...]
    """All files that were read."""
    read_since_ns: int
    """Time at which reading began, in nanoseconds since 1970."""
    seconds: float
    """Duration of reading."""


def fingerprint_of_scene(scene: Scene) -> bytes:
    """Return bytes that are equal only for scenes with the same names and poses."""
    # Imported here because it is slow to import, and would delay the first message.
    import hashlib
    return hashlib.blake2b(b'\0'.join([
        scene.poses.tobytes(), *(name.encode() for name in scene.names)])).digest()
