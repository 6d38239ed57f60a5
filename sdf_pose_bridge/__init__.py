# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Resolve every pose of an SDFormat file as libsdformat does.

Usage, with numpy and lxml installed and without ROS::

    import sdf_pose_bridge
    scene = sdf_pose_bridge.load('cell.sdf')
    scene.pose('robot::arm::tool', relative_to='table')
"""

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.errors import UnknownFrameError
from sdf_pose_bridge.loading import load
from sdf_pose_bridge.loading import load_text
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.poses import Pose
from sdf_pose_bridge.scene import Scene

__all__ = [
    'Kind',
    'Place',
    'Pose',
    'Scene',
    'SdfError',
    'SdfWarning',
    'UnknownFrameError',
    'load',
    'load_text',
]
