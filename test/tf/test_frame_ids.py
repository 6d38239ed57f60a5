# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frame ids made of scoped names."""

from matrices import assert_same_pose, matrix_from_pose, matrix_from_rpy
import numpy as np
import pytest
from sdf_texts import element, fixed_joint, model_file, posed, TWO_LINKS, world_file
from tf_checks import model, only_tree_error, parents_of, pose_of, tree_of

import sdf_pose_bridge
from sdf_pose_bridge.tf.frame_ids import FrameNames, FrameNaming

NESTED = '<link name="l"/><model name="n"><link name="k"/></model>'
CHILDREN = ['visual', 'collision', 'light', 'particle_emitter', 'projector']


def ids_of(text, *arguments):
    """Return the frame ids of all elements but roots."""
    scene = sdf_pose_bridge.load_text(text)
    return FrameNaming(*arguments).frame_ids_from_scene(scene, np.flatnonzero(scene.parents >= 0))


def in_world(children):
    return world_file(f'<model name="m">{children}</model>')


@pytest.mark.parametrize(('text', 'names', 'ids'), [
    (model_file(NESTED), FrameNames.AUTO, ['m', 'l', 'n', 'n/k']),
    (model_file(NESTED), FrameNames.RELATIVE, ['m', 'l', 'n', 'n/k']),
    (model_file(NESTED), FrameNames.SCOPED, ['m', 'm/l', 'm/n', 'm/n/k']),
    (in_world(NESTED), FrameNames.AUTO, ['m', 'm/l', 'm/n', 'm/n/k']),
    (in_world(NESTED), FrameNames.SCOPED, ['m', 'm/l', 'm/n', 'm/n/k']),
    (in_world(NESTED), FrameNames.RELATIVE, ['m', 'l', 'n', 'n/k']),
])
def test_scoped_and_relative(text, names, ids):
    assert ids_of(text, names) == ids


def test_names_in_the_world_stay():
    text = world_file(
        '<model name="m"><link name="l"/></model><frame name="f"/>'
        + fixed_joint('j', 'world', 'm'))
    assert ids_of(text, FrameNames.RELATIVE) == ['m', 'l', 'f', 'j']


@pytest.mark.parametrize(('separator', 'frame_id'), [
    ('/', 'm/n/k'), ('::', 'm::n::k'), ('_', 'm_n_k'), ('', 'mnk')])
def test_the_separator(separator, frame_id):
    assert ids_of(in_world(NESTED), FrameNames.AUTO, separator)[-1] == frame_id


@pytest.mark.parametrize('prefix', ['r1/', 'r1_', 'r1::'])
def test_the_prefix_is_put_in_front_as_it_is(prefix):
    assert ids_of(in_world(NESTED), FrameNames.AUTO, '/', prefix) == [
        f'{prefix}m', f'{prefix}m/l', f'{prefix}m/n', f'{prefix}m/n/k']


def test_a_sensor_is_named_as_gazebo_names_it():
    text = in_world(f'<link name="l">{element("sensor", "s")}</link>')
    assert ids_of(text)[-1] == 'm/l/s'


def test_a_sensor_of_a_joint():
    text = in_world(TWO_LINKS + fixed_joint('j', 'a', 'b', element('sensor', 's')))
    assert ids_of(text)[-1] == 'm/j/s'


@pytest.mark.parametrize('tag', CHILDREN)
def test_kinds_that_share_names_have_the_kind_in_the_id(tag):
    text = in_world(f'<link name="l">{element(tag, "x")}</link>')
    assert ids_of(text)[-1] == f'm/l/{tag}/x'


def test_the_kind_in_a_relative_id():
    text = model_file('<link name="l"><visual name="x"/></link>')
    assert ids_of(text)[-1] == 'l/visual/x'


def test_an_inertial():
    assert ids_of(in_world('<link name="l"><inertial/></link>'))[-1] == 'm/l/inertial'


def test_a_light_and_an_actor_of_a_world():
    text = world_file(element('light', 'sun') + element('actor', 'man'))
    assert ids_of(text) == ['light/sun', 'actor/man']


def test_the_separator_stands_before_and_after_the_kind():
    text = in_world('<link name="l"><visual name="x"/></link>')
    assert ids_of(text, FrameNames.AUTO, '.')[-1] == 'm.l.visual.x'


@pytest.mark.parametrize(('name', 'frame_id'), [
    ('a', 'a'), ('a::b', 'a/b'), ('/a', 'a'), ('//a/b/', 'a/b/'), ('a b', 'a b'),
    ('größe', 'größe'), ('::a', 'a'), ('/', ''), ('', ''), ('a:::b', 'a/:b'),
])
def test_an_id_of_a_name(name, frame_id):
    assert FrameNaming().frame_id_from_name(name) == frame_id


def test_what_leaves_nothing_has_no_id_with_a_prefix_either():
    assert FrameNaming(prefix='r/').frame_id_from_name('/') == ''


def test_a_leading_slash_goes_before_a_prefix_comes():
    assert FrameNaming(prefix='r/').frame_id_from_name('/a') == 'r/a'


OPTICAL = matrix_from_rpy(0, 0, 0, -np.pi / 2, 0, -np.pi / 2)


def camera(name='cam', children='', inside='', pose='1 0 0 0 0 0'):
    return (f'<sensor name="{name}" type="camera"><pose>{pose}</pose>{children}'
            f'<camera>{inside}</camera></sensor>')


def lidar(name, frame_id='', pose='1 0 0 0 0 0'):
    frame_id = f'<gz_frame_id>{frame_id}</gz_frame_id>' if frame_id else ''
    return f'<sensor name="{name}" type="gpu_lidar"><pose>{pose}</pose>{frame_id}</sensor>'


# Sensors with a frame id of their own

def test_a_frame_id_that_nothing_has_becomes_a_frame_at_the_sensor():
    text = model_file(f'<link name="l">{lidar("s", "laser")}</link>')
    tree = tree_of(text)
    assert dict(zip(tree.frame_ids, tree.parent_ids, strict=True)) == {
        'm': 'l', 'l': '', 'laser': 'l'}
    assert pose_of(tree, 'laser')[:3] == [1, 0, 0]


@pytest.mark.parametrize('children', [
    '<link name="l">{}</link><link name="laser"/>', '<link name="laser"/><link name="l">{}</link>',
    '<link name="l">{}</link><frame name="laser"/>'])
def test_a_frame_id_of_another_frame_makes_no_frame(children):
    tree = tree_of(model_file(children.format(lidar('s', 'laser'))))
    assert sorted(tree.frame_ids) == ['l', 'laser', 'm']
    assert pose_of(tree, 'laser')[:3] == [0, 0, 0]


def test_the_frame_id_of_the_root_makes_no_frame():
    tree = tree_of(world_file(model('m', f'<link name="l">{lidar("s", "world")}</link>')))
    assert sorted(tree.frame_ids) == ['m', 'm/l']


def test_a_frame_id_may_be_spelled_as_in_sdf():
    text = world_file(model('m', f'<link name="l">{lidar("s", "m::laser")}</link>'))
    assert 'm/laser' in tree_of(text).frame_ids


def test_a_frame_id_gets_the_prefix():
    text = model_file(f'<link name="l">{lidar("s", "laser")}</link>')
    assert parents_of(text, frame_prefix='r1/')['r1/laser'] == 'r1/l'


def test_the_old_spelling():
    text = model_file(f'<link name="l">{lidar("s", "laser")}</link>')
    assert 'laser' in tree_of(text.replace('gz_frame_id', 'ignition_frame_id')).frame_ids


def test_two_sensors_elsewhere_share_a_frame_id():
    text = model_file(
        f'<link name="l">{lidar("s", "laser")}{lidar("t", "laser", "2 0 0 0 0 0")}</link>')
    error = only_tree_error(text)
    assert error.code == 'DUPLICATE_NAME'
    assert '"m::l::s"' in error.message
    assert '"m::l::t"' in error.message


def test_sensors_of_many_robots_share_a_frame_id():
    text = world_file(''.join(
        model(name, f'<link name="l">{lidar("s", "laser")}</link>') for name in 'abc'))
    error = only_tree_error(text)
    assert error.message == (
        'sensor "b::l::s" and sensor "a::l::s" (line 1) would share the frame id "laser", like 1 '
        'more; the file sets it, for example by <gz_frame_id>; sensors without one have the names '
        'of their models in their ids, and "kinds" can leave sensors out')


def test_two_sensors_in_one_place_share_a_frame_id():
    text = model_file(f'<link name="l">{lidar("s", "laser")}{lidar("t", "laser")}</link>')
    assert tree_of(text).frame_ids == ('m', 'l', 'laser')


# Cameras

def test_a_camera_has_an_optical_frame():
    tree = tree_of(model_file(f'<link name="l">{camera()}</link>'))
    parents = dict(zip(tree.frame_ids, tree.parent_ids, strict=True))
    assert parents['l/cam_optical'] == 'l/cam'
    assert_same_pose(
        tree.transforms[tree.frame_ids.index('l/cam_optical')].tolist(), OPTICAL, 1e-12)


def test_z_of_an_optical_frame_is_ahead_and_y_down():
    tree = tree_of(model_file(f'<link name="l">{camera()}</link>'))
    matrix = matrix_from_pose(pose_of(tree, 'l/cam_optical'))
    np.testing.assert_allclose(matrix[:3, 2], (1, 0, 0), atol=1e-15)
    np.testing.assert_allclose(matrix[:3, 1], (0, 0, -1), atol=1e-15)


@pytest.mark.parametrize('kind', [
    'camera', 'depth_camera', 'rgbd_camera', 'thermal_camera', 'segmentation_camera',
    'boundingbox_camera', 'wide_angle_camera', 'wideanglecamera', 'multicamera', 'thermal'])
def test_every_type_of_camera(kind):
    text = model_file(f'<link name="l"><sensor name="cam" type="{kind}"/></link>')
    assert 'l/cam_optical' in tree_of(text).frame_ids


def test_what_is_no_camera_has_no_optical_frame():
    assert tree_of(model_file(f'<link name="l">{lidar("s")}</link>')).frame_ids == (
        'm', 'l', 'l/s')


def test_optical_frames_can_be_left_out():
    text = model_file(f'<link name="l">{camera()}</link>')
    assert tree_of(text, optical_frames=False).frame_ids == ('m', 'l', 'l/cam')


def test_a_camera_names_its_optical_frame():
    text = model_file('<link name="l">' + camera(
        inside='<optical_frame_id>eye</optical_frame_id>') + '</link>')
    assert parents_of(text) == {'m': 'l', 'l': '', 'l/cam': 'l', 'eye': 'l/cam'}


def test_the_optical_frame_of_a_camera_with_a_frame_id():
    text = model_file(f'<link name="l">{camera(children="<gz_frame_id>eye</gz_frame_id>")}</link>')
    assert parents_of(text) == {'m': 'l', 'l': '', 'eye': 'l', 'eye_optical': 'eye'}


def test_the_optical_frame_of_a_camera_with_the_frame_id_of_a_link():
    tree = tree_of(model_file(
        f'<link name="l">{camera(children="<gz_frame_id>l</gz_frame_id>")}</link>'))
    assert tree.frame_ids == ('m', 'l', 'l_optical')
    assert pose_of(tree, 'l_optical')[:3] == [1, 0, 0]


def test_an_optical_frame_that_the_file_has_is_left_alone():
    text = model_file(
        '<link name="l">' + camera(inside='<optical_frame_id>eye</optical_frame_id>')
        + '</link>' + posed('frame', 'eye', '0 0 5 0 0 0'))
    tree = tree_of(text)
    assert sorted(tree.frame_ids) == ['eye', 'l', 'l/cam', 'm']
    assert pose_of(tree, 'eye')[:3] == [0, 0, 5]


def test_two_cameras_elsewhere_name_one_optical_frame():
    inside = '<optical_frame_id>eye</optical_frame_id>'
    text = model_file(
        f'<link name="l">{camera("c", "", inside)}{camera("d", "", inside, "2 0 0 0 0 0")}</link>')
    error = only_tree_error(text)
    assert error.code == 'DUPLICATE_NAME'
    assert '"eye"' in error.message


def test_an_optical_frame_would_take_the_id_of_a_link():
    text = model_file(f'<link name="l">{camera()}</link><link name="l/cam_optical"/>')
    assert only_tree_error(text).code == 'DUPLICATE_NAME'
