# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Resolve every pose of an SDFormat file as libsdformat does.

Usage, with numpy and lxml installed and without ROS::

    import sdf_pose_bridge
    scene = sdf_pose_bridge.load('cell.sdf')
    scene.pose('robot::arm::tool', relative_to='table')
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    __version__: str
    from sdf_pose_bridge.errors import Place as Place
    from sdf_pose_bridge.errors import SdfError as SdfError
    from sdf_pose_bridge.errors import SdfWarning as SdfWarning
    from sdf_pose_bridge.errors import UnknownFrameError as UnknownFrameError
    from sdf_pose_bridge.export.urdf_text import urdf_from_scene as urdf_from_scene
    from sdf_pose_bridge.geometry.poses import Pose as Pose
    from sdf_pose_bridge.scene.loading import load as load
    from sdf_pose_bridge.scene.loading import load_text as load_text
    from sdf_pose_bridge.scene.scene import Scene as Scene
    from sdf_pose_bridge.sdformat.grammar import Kind as Kind
    from sdf_pose_bridge.sdformat.limits import Limits as Limits
    from sdf_pose_bridge.tf.joint_positions import scene_at_positions as scene_at_positions

_HOMES = {
    'Kind': 'sdformat.grammar',
    'Limits': 'sdformat.limits',
    'Place': 'errors',
    'Pose': 'geometry.poses',
    'Scene': 'scene.scene',
    'SdfError': 'errors',
    'SdfWarning': 'errors',
    'UnknownFrameError': 'errors',
    'load': 'scene.loading',
    'load_text': 'scene.loading',
    'scene_at_positions': 'tf.joint_positions',
    'urdf_from_scene': 'export.urdf_text',
}

__all__ = list(_HOMES)


def __getattr__(name: str) -> object:
    # Imported on first use: the executable of the node handles signals before anything slow, such
    # as numpy, is imported.
    if name == '__version__':
        value: object = _version()
    elif name in _HOMES:
        value = getattr(importlib.import_module(f'{__name__}.{_HOMES[name]}'), name)
    else:
        msg = f'module {__name__!r} has no attribute {name!r}'
        raise AttributeError(msg)
    globals()[name] = value
    return value


def _version() -> str:
    from importlib.metadata import version
    from pathlib import Path
    from xml.etree import ElementTree as ET
    manifest = Path(__file__).resolve().parents[1] / 'package.xml'
    if manifest.exists():  # beside the source; an installed package may have another version
        return ET.parse(manifest).getroot().findtext('version') or ''
    return version(__name__)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
