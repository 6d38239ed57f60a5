# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes that come from another process, and their fingerprints."""

import pickle

import numpy as np
import pytest
from sdf_texts import joint, model_file, world_file

from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.tf.tree import TfOptions

GOOD = '<model name="m"><link name="l"><pose>1 0 0 0 0 0</pose></link><frame name="f"/></model>'
TURNING = model_file(
    '<link name="a"/><link name="b"><sensor name="c" type="camera"/></link>'
    + joint('<parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>', 'turn', 'revolute'))


@pytest.fixture
def copied():
    """A loaded scene with joints that move, and a copy of it as other processes get it."""
    request = LoadRequest('', TURNING, tf_options=TfOptions(use_joint_states=True))
    loaded = loaded_scene_from_request(request)
    return loaded, pickle.loads(pickle.dumps(loaded, 5))


def test_a_copy_looks_poses_up_where_its_joints_are(copied):
    loaded, copy = copied
    assert copy._replace(**dict.fromkeys(('scene', 'tree', 'lookup', 'joint_positions'))) == (
        loaded._replace(**dict.fromkeys(('scene', 'tree', 'lookup', 'joint_positions'))))
    for each in copied:
        selection = each.joint_positions.selection(['turn'])
        each.joint_positions.update(selection, np.array([0.5]))
    for frame in ('b', 'b/c', 'b/c_optical', 'm::b'):
        assert copy.lookup.pose(frame) == loaded.lookup.pose(frame)
    assert copy.lookup.pose('b').pose.qz == pytest.approx(np.sin(0.25))


def test_a_copy_is_as_read_only_as_what_was_read(copied):
    for loaded in copied:
        for each in (loaded.scene, loaded.tree):
            arrays = [value for value in vars(each).values() if isinstance(value, np.ndarray)]
            assert len(arrays) > 5
            assert not any(array.flags.writeable for array in arrays)
        with pytest.raises(TypeError):
            loaded.scene.sensors[0] = None


def fingerprint(text):
    return fingerprint_of_scene(loaded_scene_from_request(LoadRequest('', text)).scene)


@pytest.mark.parametrize('other', [
    GOOD.replace('"l"', '"k"'), GOOD.replace('1 0 0', '1 0 1e-300'),
    GOOD.replace('<frame name="f"/>', ''),
])
def test_other_names_and_poses_have_another_fingerprint(other):
    assert fingerprint(world_file(GOOD)) == fingerprint(world_file(f'<!-- -->{GOOD}'))
    assert fingerprint(world_file(GOOD)) != fingerprint(world_file(other))
