# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of cameras and at joints; test_urdf_robot.py compares the poses of the latter."""

import pytest
from sdf_texts import joint, model_file, posed, TWO_LINKS, world_file
from tf_checks import only_tree_error, parents_of, pose_of, tree_of

from sdf_pose_bridge import load_text
from sdf_pose_bridge.tf.frame_ids import FrameNames, FrameNaming
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

# Cameras

def camera(name='cam', children='', inside='', pose='1 0 0 0 0 0'):
    return (f'<sensor name="{name}" type="camera"><pose>{pose}</pose>{children}'
            f'<camera>{inside}</camera></sensor>')


LIDAR = '<sensor name="s" type="gpu_lidar"/>'
NAMES_EYE = '<optical_frame_id>eye</optical_frame_id>'


@pytest.mark.parametrize(('sensor', 'options', 'parents'), [
    (camera(), {'optical_frames': False}, {'l/cam': 'l'}),
    (camera(pose='0 0 0 0 0 -2.5'), {}, {'l/cam': 'l', 'l/cam_optical': 'l/cam'}),
    (camera(inside=NAMES_EYE), {}, {'l/cam': 'l', 'eye': 'l/cam'}),
    (camera(children='<gz_frame_id>eye</gz_frame_id>'), {}, {'eye': 'l', 'eye_optical': 'eye'}),
    (camera(children='<gz_frame_id>l</gz_frame_id>'), {}, {'l_optical': 'l'}),
    (camera(children='<gz_frame_id>world</gz_frame_id>'), {}, {'world_optical': 'world'}),
], ids=['not wanted', 'a camera', 'a name', 'a frame id', 'of a link', 'of the root'])
def test_optical_frames(sensor, options, parents):
    text = model_file(f'<link name="l">{sensor}</link>')
    assert parents_of(text, **options) == {'m': 'l', 'l': '', **parents}


def test_an_optical_frame_that_the_file_has_is_left_alone():
    tree = tree_of(model_file(f'<link name="l">{camera(inside=NAMES_EYE)}</link>'
                              '<frame name="eye"><pose>0 0 5 0 0 0</pose></frame>'))
    assert sorted(tree.frame_ids) == ['eye', 'l', 'l/cam', 'm']
    assert pose_of(tree, 'eye')[:3] == [0, 0, 5]


def test_two_cameras_elsewhere_name_one_optical_frame():
    poses = {'c': '1 0 0 0 0 0', 'd': '2 0 0 0 0 0', 'e': '1 0 0 0 0 0'}
    cameras = (camera(name, '', NAMES_EYE, pose) for name, pose in poses.items())
    error = only_tree_error(model_file(f'<link name="l">{"".join(cameras)}</link>'))
    assert error.code == 'DUPLICATE_NAME'
    assert error.message.startswith(
        'sensor "m::l::d" and sensor "m::l::c" (line 1) would share the frame id "eye"; the '
        'file sets it, ')


@pytest.mark.parametrize(('inside', 'other'), [
    ('', '<link name="l/cam_optical">{}</link>'),
    (NAMES_EYE, f'<link name="b">{LIDAR}</link>'.replace(
        '/>', '>{}<gz_frame_id>eye</gz_frame_id></sensor>'))])
def test_an_optical_frame_would_take_the_id_of_another_frame(inside, other):
    text = model_file(f'<link name="l">{camera(inside=inside)}</link>{other}')
    assert only_tree_error(text.format('')).code == 'DUPLICATE_NAME'
    place = '<pose rotation_format="quat_xyzw">1 0 0 -0.5 0.5 -0.5 0.5</pose>'
    assert tree_of(text.format(place)).warnings == ()


LENS = '0.1 0 0.05 -90 0 -90'
BODY_AND_LENS = ('<link name="l">{}</link><link name="lens"><pose degrees="true">'
                 f'{LENS}</pose></link>')


@pytest.mark.parametrize(('frame_id', 'prefix', 'other_frame'), [
    ('lens', '', ''), ('lens', 'r/', ''), ('r/lens', 'r/', ''), ('m/lens', '', 'm/lens'),
    ('other/lens', 'r/', 'r/other/lens'),
])
@pytest.mark.parametrize('lens', [LENS, '0.1001 0 0.05 -89.95 0 -90'])
def test_a_camera_names_the_link_in_the_place_of_its_optical_frame(
        frame_id, prefix, other_frame, lens):
    sensor = camera(
        children=f'<gz_frame_id>{frame_id}</gz_frame_id>', pose='0.1 0 0.05 0 0 0')
    text = model_file(BODY_AND_LENS.format(sensor).replace(LENS, lens))
    tree = tree_of(text, frame_prefix=prefix)
    frames = [f'{prefix}m', f'{prefix}l', f'{prefix}lens']
    assert sorted(tree.frame_ids) == sorted([*frames, *filter(None, [other_frame])])
    assert tree.warnings == ()
    if other_frame:
        assert tree.parent_ids[tree.frame_ids.index(other_frame)] == f'{prefix}lens'
        assert pose_of(tree, other_frame) == pytest.approx(
            pose_of(tree, f'{prefix}lens'), abs=1e-3)


@pytest.mark.parametrize(('sensor_type', 'x', 'frames'), [
    ('gpu_lidar', 1, ['m/lens']), ('camera', 2, ['m/lens', 'm/lens_optical'])])
def test_a_sensor_that_is_no_camera_there_keeps_its_own_frame(sensor_type, x, frames):
    sensor = (f'<sensor name="s" type="{sensor_type}"><pose>{x} 0 0 0 0 0</pose>'
              '<gz_frame_id>m/lens</gz_frame_id></sensor>')
    tree = tree_of(model_file(BODY_AND_LENS.format(sensor)))
    assert [each for each in tree.frame_ids if '/' in each] == frames
    assert pose_of(tree, 'm/lens') == [x, 0, 0, 0, 0, 0, 1]


# Sensors with the frame id of another element

@pytest.mark.parametrize(('sensor', 'frame_id', 'optical_frame_id', 'away'), [
    ('gpu_lidar', 'l', '', '1 m and 0 degrees'), ('gpu_lidar', 'm', '', '1 m and 0 degrees'),
    ('gpu_lidar', 'world', '', '1 m and 0 degrees'), ('camera', 'f', 'f', '0 m and 120 degrees'),
    ('gpu_lidar', 'eye', '', '0 m and 119.95 degrees'), ('gpu_lidar', 'f', '', ''),
    ('gpu_lidar', 'laser', '', ''), ('gpu_lidar', '', '', ''), ('camera', 'f', 'eye', ''),
    ('camera', 'eye', 'lens', ''), ('camera', 'eye', '', ''),
    ('camera', '', 'f', '0 m and 120 degrees')])
def test_a_frame_elsewhere_is_told(sensor, frame_id, optical_frame_id, away):
    tree = tree_of(model_file(
        f'<link name="l"><sensor name="s" type="{sensor}"><pose>1 0 0 0 0 0</pose>'
        f'<gz_frame_id>{frame_id}</gz_frame_id>' + (
            f'<camera><optical_frame_id>{optical_frame_id}</optical_frame_id></camera>'
            if sensor == 'camera' else '') + '</sensor></link>'
        + posed('frame', 'f', '1 0 0 0 0 0') + posed('frame', 'eye', '1 0 0 -1.57 0 -1.57')))
    assert optical_frame_id in ('', *tree.frame_ids)
    messages = [each.message for each in tree.warnings]
    assert len(messages) == bool(away)
    assert f' "m::l::s" is that of a frame {away} away' in ''.join(messages) or not away


# Joints

ENDS = '<parent>a</parent><child>b</child>'
AWAY = f'<pose>0 1 0 0 0 0</pose>{ENDS}'
AXES = '<axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>'


def parents_of_links(content, joint_type, **options):
    """Return the parents of all frames but those of the file."""
    text = model_file(
        '<link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>'
        + joint(content, 'j', joint_type))
    tree = tf_tree_from_scene(load_text(text), TfOptions(has_joint_links=True, **options))
    parents = dict(zip(tree.frame_ids, tree.parent_ids, strict=True))
    return {name: parent for name, parent in parents.items() if name.endswith('frame')}


@pytest.mark.parametrize(('content', 'joint_type', 'parents'), [
    (ENDS, 'revolute', {}),
    (AWAY, 'fixed', {}),
    (AWAY, 'revolute', {'j_frame': 'a'}),
    (f'<pose>0 0 0 0 0 1</pose>{ENDS}', 'revolute', {'j_frame': 'a'}),
    (AWAY.replace('>a<', '>world<'), 'revolute', {'j_frame': 'world'}),
    (ENDS + AXES, 'universal', {'j_frame': 'a'}),
    (AWAY + AXES, 'universal', {'j_frame': 'a', 'j_axis2_frame': 'a'}),
    (ENDS, 'ball', {'j_yaw_frame': 'a', 'j_pitch_frame': 'a'}),
    (AWAY, 'screw', {'j_slide_frame': 'a'}),
])
def test_frames_at_joints(content, joint_type, parents):
    for follows_models in (False, True):
        assert parents_of_links(content, joint_type, follows_models=follows_models) == parents
    if 'j_frame' in parents:
        assert 'j_frame' not in parents_of_links(content, joint_type, root_frame='j_frame')


def test_frames_at_joints_have_names_like_others():
    assert parents_of_links(
        AWAY, 'revolute', frame_prefix='r/', frame_names=FrameNames.SCOPED) == {
            'r/m/j_frame': 'r/m/a'}


@pytest.mark.parametrize(('text', 'ids'), [
    ('<robot name="m"><link name="world"/></robot>', ['world']),
    (model_file("""
        <link name="a">
          <sensor name="cam" type="camera"><pose>1 0 0 0 0 0</pose><camera/></sensor>
        </link>
        <link name="b"/>
        <joint name="j" type="screw"><pose>0 1 0 0 0 0</pose>
          <parent>a</parent>
          <child>b</child>
        </joint>"""),
     ['m', 'a', 'a/cam', 'b', 'a/cam_optical', 'j_slide_frame'])])
def test_all_frame_ids_are_made_in_one_place(monkeypatch, text, ids):
    make = FrameNaming.frame_id_from_name
    monkeypatch.setattr(FrameNaming, 'frame_id_from_name', lambda naming, name: (
        make(naming, name) + ('_sim' if naming.prefix else '')))
    options = TfOptions(frame_prefix='r/', has_joint_links=True)
    tree = tf_tree_from_scene(load_text(text), options)
    assert list(tree.frame_ids) == [f'r/{each}_sim' for each in ids]


def test_a_joint_has_no_frame_if_another_one_has_its_name_or_none_is_wanted():
    text = world_file(
        '<model name="base"><link name="l"/></model><model name="arm"><link name="k"/></model>'
        + joint(AWAY.replace('>a<', '>base<').replace('>b<', '>arm<'), 'j', 'revolute')
        + f'<model name="m">{TWO_LINKS}{joint(AWAY, "j", "revolute")}</model>')
    options = TfOptions(has_joint_links=True, frame_names=FrameNames.RELATIVE)
    for changes, count in (({}, 1), ({'model': 'arm'}, 0), ({'has_joint_links': False}, 0)):
        tree = tf_tree_from_scene(load_text(text), options._replace(**changes))
        assert tree.frame_ids.count('j_frame') == count
