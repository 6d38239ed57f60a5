# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Set a pose in a random scene, so that libsdformat can resolve the file that was written."""

from __future__ import annotations

from functools import partial
from pathlib import Path
import tempfile

from differential.scene_builder import SCENE, SceneFiles
import sdf_pose_bridge
from sdf_pose_bridge.export.pose_setting import pose_change
from sdf_pose_bridge.tf.lookup import lookup_from_scene


def with_pose_set(scene, dice):
    """
    Set the pose of one element, in the root.

    :param scene: a scene.
    :param dice: what is drawn.
    :return: the scene with the changed file; the same scene if it is not valid, or no pose in it
        can be set so.
    """
    with tempfile.TemporaryDirectory(prefix='differential-') as name:
        folder = Path(name).resolve()
        file = scene.write(folder, 'scene')

        load = partial(sdf_pose_bridge.load, file, resource_paths=[folder])
        pose = sdf_pose_bridge.Pose(
            *(dice.randint(-90, 90) / 10 for _ in range(3)), 0.0, 0.6, 0.0, 0.8)
        try:
            before = load()
            if not before.names:
                return scene
            element = dice.randrange(len(before.names))
            change = pose_change(before, element, pose, lookup_from_scene, load)
        except sdf_pose_bridge.SdfError:
            return scene
        path = str(Path(change.file.path).resolve().relative_to(folder / 'scene'))
        text = change.file.new_text.decode(errors='surrogateescape').replace('scene/', f'{SCENE}/')
    return SceneFiles({**scene.files, path: text}, scene.traits | {'pose set'})
