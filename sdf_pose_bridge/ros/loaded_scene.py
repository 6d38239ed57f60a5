# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From settings to what the node serves: find the file, read it, lay out its frames."""

import os
from pathlib import Path
import time
from typing import NamedTuple

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.errors import UriLookupError
from sdf_pose_bridge.ros.settings import Settings
from sdf_pose_bridge.scene.loading import load
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.include.uris import AddressError
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge.tf.tree import TfTree


class Content(NamedTuple):
    """What a file holds, as far as it is to be published."""

    path: Path
    scene: Scene
    tree: TfTree
    lookup: PoseLookup
    """Answers queries about the two."""
    warnings: tuple[SdfWarning, ...]
    files: tuple[str, ...]
    """All files that were read, which tell when to read again."""
    read_since_ns: int
    """When the first of them began to be read, in nanoseconds since 1970."""
    seconds: float
    """How long it took to get here from there."""


def content_from_settings(settings: Settings) -> Content:
    """
    Read the file and lay out its frames.

    :param settings: what the node is set to do.
    :return: what to serve.
    :raises AddressError: if ``sdf_file`` is a URI that leads nowhere.
    :raises SdfError: if the file is not valid, or cannot be published as the settings say.
    """
    read_since_ns = time.time_ns()
    begin = time.perf_counter()
    path, manifests, warnings = _file_from_settings(settings)
    scene = load(
        path, resource_paths=settings.resource_paths,
        on_missing_include=settings.on_missing_include)
    tree = tf_tree_from_scene(scene, settings.tf_options)
    lookup = PoseLookup(scene, tree)
    return Content(
        path, scene, tree, lookup,
        (*warnings, *scene.warnings, *tree.warnings), (*manifests, *scene.files), read_since_ns,
        time.perf_counter() - begin)


def files_behind_error(error: SdfError | AddressError, settings: Settings) -> list[str]:
    """
    Tell where to look in order to notice that the cause of an error is mended.

    :param error: what :func:`content_from_settings` raised.
    :param settings: what it was called with.
    :return: paths of the files that are wrong; where something is missing, also of the directories
        in which it may appear.
    """
    errors = error.errors if isinstance(error, SdfError) else ()
    files = dict.fromkeys(each.place.file for each in errors)
    missing = [each for each in errors if isinstance(each, UriLookupError)]
    if missing or isinstance(error, AddressError):
        finder = resource_finder(settings.resource_paths, os.environ)
        files |= dict.fromkeys([
            *(str(Path(each.place.file).parent) for each in missing),
            *finder.search_paths, *finder.environment_paths])
    return list(files)


def _file_from_settings(
    settings: Settings,
) -> tuple[Path, tuple[str, ...], tuple[SdfWarning, ...]]:
    finder = resource_finder(settings.resource_paths, os.environ)
    path = finder.path_from_address(settings.sdf_file)
    # Unlike Path's, it says no of a path that is too long; reading the file says why.
    if not os.path.isdir(path):  # noqa: PTH112
        return path, (), ()
    # Mostly it is a file.
    from sdf_pose_bridge.sdformat.include.manifest import model_file_from_directory
    chosen = model_file_from_directory(str(path))
    return Path(chosen.path), (chosen.manifest,), chosen.warnings
