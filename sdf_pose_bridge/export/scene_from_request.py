# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read a file or a text, and make its TF tree."""

from __future__ import annotations

from collections.abc import Mapping
import os
from pathlib import Path
import time

from lxml import etree

from sdf_pose_bridge.errors import AddressError, Place, SdfError, SdfWarning, UriLookupError
from sdf_pose_bridge.export.published_scene import DescriptionFormat, LoadedScene, LoadRequest
from sdf_pose_bridge.export.urdf_robot import robot_from_scene
from sdf_pose_bridge.export.urdf_text import UrdfWriter
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.include.manifests import model_file_from_directory, ModelFile
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file, xml_from_bytes
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene


def loaded_scene_from_request(
    request: LoadRequest, texts: Mapping[str, bytes] | None = None,
) -> LoadedScene:
    """
    Read a file or a text.

    :param texts: texts to read instead of some files, by their paths.
    :raises AddressError: if ``sdf_file`` is a URI of a file that is not found.
    :raises SdfError: if it is not valid, or cannot be published with these options.
    """
    read_since_ns = time.time_ns()
    begin = time.perf_counter()
    path, manifest, warnings = _file_from_request(request)
    text = bytes_from_file(path, Usage()) if request.sdf_file else request.robot_description
    makes_urdf = request.description_format is DescriptionFormat.URDF
    options = request.tf_options
    scene = load_text(
        text, path, resource_paths=request.resource_paths,
        on_missing_include=request.on_missing_include, shapes=makes_urdf,
        plugins=options.follows_models or options.use_joint_states, texts=texts)
    if request.model_name and scene.world_names:
        msg = 'model_name has no effect, because this is a world and not a file of one model'
        warnings += (SdfWarning('WARNING', msg, Place(path)),)
    scene = scene.with_model_name(request.model_name)
    tree = tf_tree_from_scene(scene, options, finds_at_rest=True)
    joint_positions = None if tree.moving is None else JointPositions(
        scene, tree.moving.motion, options.model, request.unreported_joints,
        is_spawned=bool(request.model_name))
    match scene.source_format:
        case SourceFormat.SDFORMAT | SourceFormat.URDF:  # readers of the topic know both
            description = '' if tree.world else unicode_text(text)
    if makes_urdf and not scene.is_urdf:
        description, warnings_of_urdf = _urdf(scene, request)
        warnings += warnings_of_urdf
    # The tree and the URDF may have the same warnings.
    found = dict.fromkeys((*warnings, *scene.warnings, *tree.warnings))
    return LoadedScene(
        request=request,
        path=Path(path),
        text=text,
        description=description,
        scene=scene,
        tree=tree,
        lookup=PoseLookup(scene, tree, joint_positions),
        joint_positions=joint_positions,
        warnings=tuple(warning for warning in found if not warning.is_for_gazebo),
        gazebo_warning_count=sum(warning.is_for_gazebo for warning in found),
        files=(*filter(None, [manifest]), *(scene.files if request.sdf_file else scene.files[1:])),
        read_since_ns=read_since_ns,
        seconds=time.perf_counter() - begin,
    )


def _urdf(scene: Scene, request: LoadRequest) -> tuple[str, tuple[SdfWarning, ...]]:
    """Return URDF with warnings, or an empty text with a warning that says why there is none."""
    try:
        robot = robot_from_scene(scene, request.tf_options)
        return UrdfWriter(scene, robot, request.resource_paths).urdf()
    except SdfError as error:
        first = error.errors[0]
        msg = f'there is no robot_description, because no URDF can be made: {first.message}'
        return '', (SdfWarning(first.code, msg, first.place),)


def unicode_text(text: str | bytes) -> str:
    """Return XML as text, without its declaration if that names another encoding than UTF-8."""
    if isinstance(text, str):
        return text
    try:
        return text.decode('utf-8-sig')
    except UnicodeDecodeError:
        return str(etree.tostring(xml_from_bytes(text, '').root, encoding='unicode'))


def files_behind_error(error: Exception, request: LoadRequest) -> list[str]:
    """
    Return the files that have to change before loading can succeed.

    :param error: the exception of :func:`loaded_scene_from_request`.
    :return: the files with errors; if something was not found, also the searched directories.
    """
    errors = error.errors if isinstance(error, SdfError) else ()
    files = [each.place.file for each in errors]
    missing = [each for each in errors if isinstance(each, UriLookupError)]
    if missing or isinstance(error, AddressError):
        finder = resource_finder(request.resource_paths)
        files += [
            *(str(Path(each.place.file).parent) for each in missing),
            *finder.search_paths, *finder.environment_paths]
    return list(dict.fromkeys(files))


def _file_from_request(request: LoadRequest) -> ModelFile:
    """Return the path as in :class:`LoadedScene`, and the manifest that leads to it, or ''."""
    if not request.sdf_file:
        return ModelFile(request.source, '', ())
    finder = resource_finder(request.resource_paths)
    path = finder.path_from_address(request.sdf_file)
    # Path.is_dir raises for a path that is too long; reading the file gives a better message.
    if not os.path.isdir(path):  # noqa: PTH112
        return ModelFile(str(path), '', ())
    return model_file_from_directory(str(path), Usage())
