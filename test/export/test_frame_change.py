# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Measured poses in the file of a scene whose joints move."""

from matrices import assert_close
import numpy as np
import pytest
from sdf_texts import model_file
import urdf_texts

from sdf_pose_bridge import load_text
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.export.frame_change import write_frame_change
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.tf.tree import TfOptions

ARM = model_file("""
    <link name="base"/>
    <link name="tool"><pose>1 0 0 0 0 0</pose><sensor name="eye" type="camera"/></link>
    <joint name="turn" type="revolute"><pose relative_to="base"/>
      <parent>base</parent>
      <child>tool</child>
      <axis><xyz>0 0 1</xyz></axis>
    </joint>
    <frame name="mark"><pose>2 0 0 0 0 0</pose></frame>
    <frame name="on_mark"><pose relative_to="mark">0 0 1 0 0 0</pose></frame>""")


@pytest.fixture(name='change')
def make_change(tmp_path):
    """Changes a pose of the arm; returns the frames that moved, and the text of the file then."""
    path = tmp_path / 'arm.sdf'
    path.write_text(ARM, encoding='utf-8')
    request = LoadRequest(
        str(path), '', tf_options=TfOptions(use_joint_states=True, frame_prefix='r/'))
    loaded = loaded_scene_from_request(request)
    fingerprint = fingerprint_of_scene(loaded.scene)

    def change(
            frame, pose, reference='', position=0.0, published=fingerprint, *, dry_run=False):
        positions = loaded.joint_positions
        positions.update(positions.selection(['turn']), np.array([position]))
        found = write_frame_change(
            request, published, frame, pose, reference, positions, dry_run=dry_run)
        return found.moved_frames, path.read_text(encoding='utf-8')

    return change


def test_a_pose_is_taken_where_its_reference_has_moved_to(change):
    arguments = 'r/mark', Pose(0.5), 'r/tool', np.pi / 2
    assert change(*arguments, dry_run=True) == (['r/on_mark'], ARM)
    moved, text = change(*arguments)
    assert moved == ['r/on_mark']
    assert_close(load_text(text).pose('m::mark')[:3], (0.0, 1.5, 0.0))


def test_the_camera_of_an_optical_frame_is_moved(change):
    moved, text = change('r/tool/eye_optical', Pose(0.5))
    assert moved == []
    assert_close(load_text(text).pose('m::tool::eye')[:3], (0.5, 0.0, 0.0))


def test_a_frame_does_not_move_in_one_that_moves_with_it(change):
    with pytest.raises(SdfError, match='m::tool'):
        change('tool', Pose(0.5), 'r/tool/eye_optical')


def test_a_file_that_is_not_what_is_published(change):
    with pytest.raises(SdfError, match='the file has changed since it was read'):
        change('mark', Pose(), published=b'other')


ROBOT = urdf_texts.robot(
    ''.join(map(urdf_texts.link, ('base', 'arm', 'tool')))
    + urdf_texts.joint('turn', 'base', 'arm', 'continuous', '<axis xyz="0 0 1"/>')
    + urdf_texts.joint('mount', 'arm', 'tool', 'fixed', urdf_texts.origin('1 0 0')))


@pytest.mark.parametrize(('frame', 'asked', 'origin', 'moved'), [
    ('tool', Pose(0.0, 2.0, 0.0, 0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5), '2 0 0', []),
    # The joint itself has turned.
    ('arm', Pose(0.5, 0.0, 0.0, 0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5), '0.5 0 0', ['tool'])])
def test_the_origin_of_a_urdf_whose_joint_has_turned(tmp_path, frame, asked, origin, moved):
    path = tmp_path / 'robot.urdf'
    path.write_text(ROBOT)
    request = LoadRequest(str(path), '', tf_options=TfOptions(use_joint_states=True, kinds=None))
    loaded = loaded_scene_from_request(request)
    positions = loaded.joint_positions
    positions.update(positions.selection(['turn']), np.array([np.pi / 2]))
    found = write_frame_change(
        request, fingerprint_of_scene(loaded.scene), frame, asked, 'base', positions,
        dry_run=False)
    assert found.moved_frames == moved
    written = f'<origin xyz="{origin}" rpy="0 0 0"/>'
    assert path.read_text() == (
        ROBOT.replace('<origin xyz="1 0 0" rpy="0 0 0"/>', written) if frame == 'tool' else
        ROBOT.replace('"continuous">', f'"continuous">{written}'))
