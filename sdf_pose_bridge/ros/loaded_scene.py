# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read the file or the text that the settings name, and make its TF tree."""

from __future__ import annotations

from collections.abc import Mapping
import os
from pathlib import Path
import time
from typing import NamedTuple

from lxml import etree
import numpy as np

from sdf_pose_bridge.errors import PassingReadError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.errors import UriLookupError
from sdf_pose_bridge.ros.parameters import Settings
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.include.uris import AddressError
from sdf_pose_bridge.sdformat.include.uris import model_file_from_directory
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge.tf.tree import TfTree


class LoadedScene(NamedTuple):
    """A file, or a text, that was read."""

    settings: Settings
    """The settings that it was read with; later ones may differ where that needs no load."""
    path: Path
    """The path of the file; of a text, the name of its parameter."""
    text: str | bytes
    """What was read; bytes are in the encoding that they declare."""
    description: str
    """The text for the topic ``robot_description``; empty for a world."""
    scene: Scene
    tree: TfTree
    lookup: PoseLookup
    joint_positions: JointPositions | None
    """The positions of its joints; None if joints do not follow ``joint_states``."""
    warnings: tuple[SdfWarning, ...]
    files: tuple[str, ...]
    """All files that were read."""
    read_since_ns: int
    """When reading began, in nanoseconds since 1970."""
    seconds: float
    """How long reading took."""


def loaded_scene_from_settings(
    settings: Settings, texts: Mapping[str, bytes] | None = None,
) -> LoadedScene:
    """
    Read the file or the text that the settings name.

    :param texts: what to read instead of some files, by their paths.
    :raises AddressError: if ``sdf_file`` is a URI of a file that is not found.
    :raises SdfError: if it is not valid, or cannot be published with these settings.
    """
    read_since_ns = time.time_ns()
    begin = time.perf_counter()
    path, manifests, warnings = _file_from_settings(settings)
    text = bytes_from_file(str(path), Usage()) if settings.sdf_file else settings.robot_description
    scene = _scene_from_text(text, path, settings, texts=texts)
    tree = tf_tree_from_scene(scene, settings.tf_options)
    joint_positions = None if tree.moving is None else JointPositions(
        scene, tree.moving.dofs, settings.frame_names, settings.model, settings.unreported_joints)
    return LoadedScene(
        settings=settings,
        path=path,
        text=text,
        description='' if tree.world else unicode_text(text),
        scene=scene,
        tree=tree,
        lookup=PoseLookup(scene, tree, joint_positions),
        joint_positions=joint_positions,
        warnings=(*warnings, *scene.warnings, *tree.warnings),
        files=(*manifests, *(scene.files if settings.sdf_file else scene.files[1:])),
        read_since_ns=read_since_ns,
        seconds=time.perf_counter() - begin,
    )


def scene_with_shapes(loaded: LoadedScene) -> Scene | None:
    """
    Resolve the text of a loaded scene again, with its shapes.

    Shapes are not read with the rest because that would make each load a quarter longer, or more,
    and few nodes need them.

    :return: the scene with shapes; None if a file that it includes has changed, so that it is not
        valid or has other elements or poses.
    """
    try:
        scene = _scene_from_text(loaded.text, loaded.path, loaded.settings, shapes=True)
    except SdfError:
        return None
    is_same = scene.names == loaded.scene.names and np.array_equal(
        scene.poses, loaded.scene.poses)
    return scene if is_same else None


def unicode_text(text: str | bytes) -> str:
    """
    Return XML as text.

    :param text: XML; bytes are in the encoding that they declare.
    :return: the text; of bytes that are not UTF-8 without the declaration, which is wrong for it.
    """
    if isinstance(text, str):
        return text
    try:
        return text.decode('utf-8-sig')
    except UnicodeDecodeError:
        return str(etree.tostring(xml_from_bytes(text, '').root, encoding='unicode'))


def _scene_from_text(
    text: str | bytes, path: Path, settings: Settings, *, shapes: bool = False,
    texts: Mapping[str, bytes] | None = None,
) -> Scene:
    return load_text(
        text, str(path), resource_paths=settings.resource_paths,
        on_missing_include=settings.on_missing_include, shapes=shapes, texts=texts)


def files_behind_error(error: Exception, settings: Settings) -> list[str]:
    """
    Return the files that have to change before loading can succeed.

    :param error: what :func:`loaded_scene_from_settings` raised.
    :return: the files with errors; if something was not found, also the directories in which it
        was looked for.
    """
    errors = error.errors if isinstance(error, SdfError) else ()
    files = [each.place.file for each in errors]
    missing = [each for each in errors if isinstance(each, UriLookupError)]
    if missing or isinstance(error, AddressError):
        finder = resource_finder(settings.resource_paths, os.environ)
        files += [
            *(str(Path(each.place.file).parent) for each in missing),
            *finder.search_paths, *finder.environment_paths]
    return list(dict.fromkeys(files))


def may_pass(error: Exception) -> bool:
    """
    Return whether reading the same files again may succeed.

    :param error: what :func:`loaded_scene_from_settings` raised.
    """
    errors = error.errors if isinstance(error, SdfError) else (error,)
    return any(isinstance(each, MemoryError | PassingReadError) for each in errors)


def _file_from_settings(
    settings: Settings,
) -> tuple[Path, tuple[str, ...], tuple[SdfWarning, ...]]:
    """
    Return the path of the file, and the manifests and warnings met on the way to it.

    A text has the name of its parameter for a path.
    """
    if not settings.sdf_file:
        return Path(settings.source), (), ()
    finder = resource_finder(settings.resource_paths, os.environ)
    path = finder.path_from_address(settings.sdf_file)
    # Path.is_dir raises for a path that is too long; reading the file gives a better message.
    if not os.path.isdir(path):  # noqa: PTH112
        return path, (), ()
    chosen = model_file_from_directory(str(path), Usage())
    return Path(chosen.path), (chosen.manifest,), chosen.warnings
