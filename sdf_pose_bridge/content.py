# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From settings to what the node serves: find the file, read it, lay out its frames."""

from __future__ import annotations

import os
from pathlib import Path
import time
from typing import NamedTuple

from ament_index_python.packages import get_package_share_directory

from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.file_address import path_from_address
from sdf_pose_bridge.loading import load
from sdf_pose_bridge.manifest import model_file_from_directory
from sdf_pose_bridge.resources import resource_finder
from sdf_pose_bridge.scene import Scene
from sdf_pose_bridge.settings import Settings
from sdf_pose_bridge.tf_tree import tf_tree_from_scene
from sdf_pose_bridge.tf_tree import TfTree


class Content(NamedTuple):
    """What a file holds, as far as it is to be published."""

    path: Path
    scene: Scene
    tree: TfTree
    warnings: tuple[SdfWarning, ...]
    seconds: float
    """How long it took to get here from the file."""

    @property
    def files(self) -> tuple[str, ...]:
        """All files that were read, which tell when to read again."""
        return self.scene.files


def content_from_settings(settings: Settings) -> Content:
    """
    Read the file and lay out its frames.

    :param settings: what the node is set to do.
    :return: what to serve.
    :raises AddressError: if ``sdf_file`` is a URI that leads nowhere.
    :raises SdfError: if the file is not valid, or cannot be published as the settings say.
    """
    begin = time.perf_counter()
    path, warnings = _file_from_settings(settings)
    scene = load(
        path, resource_paths=settings.resource_paths,
        on_missing_include=settings.on_missing_include)
    tree = tf_tree_from_scene(scene, settings.tf_options)
    return Content(
        path, scene, tree, (*warnings, *scene.warnings, *tree.warnings),
        time.perf_counter() - begin)


def _file_from_settings(settings: Settings) -> tuple[Path, tuple[SdfWarning, ...]]:
    finder = resource_finder(settings.resource_paths, os.environ)
    path = path_from_address(
        settings.sdf_file, get_package_share_directory,
        lambda uri: finder.path_from_uri(uri, including_file=''))
    if not path.is_dir():
        return path, ()
    chosen = model_file_from_directory(str(path))
    return Path(chosen.path), chosen.warnings
