# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Measured poses in the file of a scene whose joints move."""

from matrices import assert_close
import numpy as np
import pytest
from sdf_texts import model_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.tf.frame_change import write_frame_change
from sdf_pose_bridge.tf.loaded_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.tf.loading import loaded_scene_from_request
from sdf_pose_bridge.tf.tree import TfOptions

ARM = model_file("""
    <link name="base"/>
    <link name="tool"><pose>1 0 0 0 0 0</pose></link>
    <frame name="mark"><pose>2 0 0 0 0 0</pose></frame>
    <frame name="on_mark"><pose relative_to="mark">0 0 1 0 0 0</pose></frame>
    <joint name="turn" type="revolute"><pose relative_to="base"/>
      <parent>base</parent>
      <child>tool</child>
      <axis><xyz>0 0 1</xyz></axis>
    </joint>""")


@pytest.fixture(name='change')
def make_change(tmp_path):
    """Finds a change of the arm; ``change(frame, pose, reference, *positions)``."""
    path = tmp_path / 'arm.sdf'
    path.write_text(ARM, encoding='utf-8')
    request = LoadRequest(str(path), '', tf_options=TfOptions(use_joint_states=True))
    loaded = loaded_scene_from_request(request)
    fingerprint = fingerprint_of_scene(loaded.scene)

    def change(frame, pose, reference='', position=0.0, published=fingerprint):
        positions = loaded.joint_positions
        positions.update(positions.selection(['turn']), np.array([position]))
        write_frame_change(
            request, published, frame, pose, reference, positions, dry_run=False)
        return path.read_text(encoding='utf-8')

    return change


def test_a_pose_is_taken_where_its_reference_has_moved_to(change):
    text = change('mark', Pose(0.5), 'tool', np.pi / 2)
    assert_close(load_text(text).pose('m::mark')[:3], (0.0, 1.5, 0.0))


def test_a_file_that_is_not_what_is_published(change):
    with pytest.raises(SdfError, match='the file has changed since it was read'):
        change('mark', Pose(), published=b'other')
