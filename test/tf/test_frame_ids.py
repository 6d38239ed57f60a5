# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frame ids made of scoped names."""

import numpy as np
import pytest
from sdf_texts import element, fixed_joint, joint, link_with, model_file, TWO_LINKS, world_file
from tf_checks import model, only_tree_error, parents_of, pose_of, tree_of

from sdf_pose_bridge import load_text
from sdf_pose_bridge.tf.frame_ids import FrameNames, FrameNaming
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

NESTED = '<link name="l"/><model name="n"><link name="k"/></model>'
CHILDREN = ['visual', 'collision', 'light', 'particle_emitter', 'projector']


def ids_of(text, *arguments):
    """Return the frame ids of all elements but roots."""
    scene = load_text(text)
    return FrameNaming(*arguments).frame_ids_from_scene(scene, np.flatnonzero(scene.parents >= 0))


def in_world(children):
    return world_file(f'<model name="m">{children}</model>')


@pytest.mark.parametrize(('text', 'names', 'ids'), [
    (model_file(NESTED), FrameNames.AUTO, ['m', 'l', 'n', 'n/k']),
    (model_file(NESTED), FrameNames.SCOPED, ['m', 'm/l', 'm/n', 'm/n/k']),
    (in_world(NESTED), FrameNames.AUTO, ['m', 'm/l', 'm/n', 'm/n/k']),
    (in_world(NESTED), FrameNames.RELATIVE, ['m', 'l', 'n', 'n/k']),
    (world_file('<light name="s" type="point"/><actor name="m"/><model name="m1"><link name="l"/>'
                '</model><frame name="f"/>' + fixed_joint('j', 'world', 'm1')),
     FrameNames.RELATIVE, ['light/s', 'actor/m', 'm1', 'l', 'f', 'j']),
])
def test_scoped_and_relative(text, names, ids):
    assert ids_of(text, names) == ids


@pytest.mark.parametrize(('separator', 'frame_id'), [
    ('/', 'm/n/k'), ('::', 'm::n::k'), ('_', 'm_n_k'), ('', 'mnk')])
def test_the_separator(separator, frame_id):
    assert ids_of(in_world(NESTED), FrameNames.AUTO, separator)[-1] == frame_id


@pytest.mark.parametrize('tag', CHILDREN)
def test_kinds_that_share_names_have_the_kind_in_the_id(tag):
    link = f'<link name="l">{element(tag, "x")}</link>'
    assert ids_of(in_world(link))[-1] == f'm/l/{tag}/x'
    assert ids_of(model_file(link))[-1] == f'l/{tag}/x'


@pytest.mark.parametrize(('content', 'frame_id'), [
    ('<link name="l"><sensor name="s" type="camera"/></link>', 'm/l/s'),
    (TWO_LINKS + fixed_joint('j', 'a', 'b', element('sensor', 's')), 'm/j/s'),
    ('<link name="l"><inertial/></link>', 'm/l/inertial'),
])
def test_kinds_that_share_no_names(content, frame_id):
    assert ids_of(in_world(content))[-1] == frame_id


@pytest.mark.parametrize(('name', 'frame_id'), [
    ('a', 'a'), ('a::b', 'a/b'), ('/a', 'a'), ('//a/b/', 'a/b/'), ('a b', 'a b'),
    ('größe', 'größe'), ('::a', 'a'), ('/', ''), ('', ''), ('a:::b', 'a/:b'),
])
def test_an_id_of_a_name(name, frame_id):
    assert FrameNaming().frame_id_from_name(name) == frame_id
    assert FrameNaming(prefix='r/').frame_id_from_name(name) == (frame_id and f'r/{frame_id}')


def lidar(name, frame_id='', pose='1 0 0 0 0 0'):
    frame_id = f'<gz_frame_id>{frame_id}</gz_frame_id>' if frame_id else ''
    return f'<sensor name="{name}" type="gpu_lidar"><pose>{pose}</pose>{frame_id}</sensor>'


# Sensors with a frame id of their own

@pytest.mark.parametrize(('frame_id', 'prefix', 'parents'), [
    ('laser', '', {'m': 'l', 'l': '', 'laser': 'l'}), ('world', '', {'m': 'l', 'l': ''}),
    ('laser', 'r/', {'r/m': 'r/l', 'r/l': '', 'r/laser': 'r/l'}),
    ('m::laser', '', {'m': 'l', 'l': '', 'm/laser': 'l'})])
def test_a_frame_id_becomes_a_frame_unless_it_is_that_of_the_root(frame_id, prefix, parents):
    assert parents_of(link_with(lidar('s', frame_id)), frame_prefix=prefix) == parents


TAGS = {'f': '<frame_id>f</frame_id>', 'g': '<gz_frame_id>g</gz_frame_id>',
        'i': '<ignition_frame_id>i</ignition_frame_id>'}


@pytest.mark.parametrize(('scoped', 'default'), [(True, 'm/l/s'), (False, 'l/s')])
@pytest.mark.parametrize(('tags', 'ids'), [
    ('', ['{}']), ('i', ['{}']), ('f', ['f', '{}']), ('fi', ['f', '{}']), ('g', ['g']),
    ('gi', ['g']), ('fg', ['f', 'g']), ('fgi', ['f', 'g'])])
def test_each_frame_id_that_a_release_sends_has_a_frame_in_one_place(tags, ids, scoped, default):
    sensor = ('<sensor name="s" type="gpu_lidar"><pose>1 0 0 0 0 0</pose>'
              f'{"".join(map(TAGS.get, tags))}</sensor>')
    link = f'<link name="l">{sensor}</link>'
    tree = tree_of(in_world(link) if scoped else model_file(link))
    found = [each.format(default) for each in ids]
    assert list(tree.frame_ids[2:]) == found
    assert [pose_of(tree, each)[0] for each in found] == [1.0] * len(found)
    assert list(tree.parent_ids[2:]) == [tree.frame_ids[1], *found[:1]][:len(found)]
    assert tree.elements.tolist()[-len(found):] == [tree.elements.item(2)] * len(found)


def test_both_frame_ids_of_a_sensor_move_with_its_link():
    text = model_file('<link name="l"/><link name="k"><sensor name="s" type="camera"><frame_id>f'
                      '</frame_id></sensor></link>' + joint(
                          '<parent>l</parent><child>k</child>', joint_type='revolute'))
    parents = parents_of(text, use_joint_states=True)
    assert {each: parents[each] for each in ('k/s', 'f', 'f_optical')} == {
        'k/s': 'f', 'f': 'k', 'f_optical': 'f'}


def test_the_frame_of_harmonic_is_in_the_link_whose_id_later_releases_send():
    text = model_file('<link name="l"/><link name="k"><sensor name="s" type="imu"><pose>1 0 0 0 0 '
                      '0</pose><frame_id>l</frame_id></sensor></link>')
    assert parents_of(text)['k/s'] == 'k'
    (warning,) = tree_of(text).warnings
    assert warning.message.startswith('the frame id "l" of sensor "m::k::s" is that of a frame')


@pytest.mark.parametrize(('other', 'messages'), [
    ('<frame name="g"><pose>3 0 0 0 0 0</pose></frame>', 1),
    ('<frame name="g"><pose>1 0 0 0 0 0</pose></frame>', 0),
    ('<link name="k">{}</link>', 1),
])
def test_an_id_in_harmonic_of_another_element_makes_no_frame(other, messages):
    sensor = '<sensor name="{}" type="imu"><pose>{} 0 0 0 0 0</pose>{}</sensor>'
    content = sensor.format('s', 1, TAGS['f'] + TAGS['g'])
    tree = tree_of(model_file(
        f'<link name="l">{content}</link>' + other.format(sensor.format('t', 3, TAGS['g']))))
    assert tree.frame_ids.count('g') == 1
    assert pose_of(tree, 'f')[0] == 1.0
    assert [each.message[:57] for each in tree.warnings] == [
        'the frame id in Gazebo Harmonic "g" of sensor "m::l::s" is'[:57]] * messages


def test_an_id_in_harmonic_that_is_that_of_the_optical_frame_is_this_frame():
    tree = tree_of(link_with('<sensor name="s" type="camera"><frame_id>f</frame_id>'
                             '<gz_frame_id>f_optical</gz_frame_id></sensor>'))
    assert tree.frame_ids == ('m', 'l', 'f', 'f_optical')
    assert pose_of(tree, 'f_optical')[3] == -0.5


@pytest.mark.parametrize('children', [
    '<link name="l">{}</link><link name="laser"/>', '<link name="laser"/><link name="l">{}</link>',
    '<link name="l">{}</link><frame name="laser"/>'])
def test_a_frame_id_of_another_frame_makes_no_frame(children):
    tree = tree_of(model_file(children.format(lidar('s', 'laser'))))
    assert sorted(tree.frame_ids) == ['l', 'laser', 'm']
    assert pose_of(tree, 'laser')[:3] == [0, 0, 0]


def test_two_sensors_elsewhere_share_a_frame_id():
    error = only_tree_error(
        link_with(lidar('s', 'laser') + lidar('t', 'laser', '2 0 0 0 0 0')))
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
    tree = tree_of(link_with(lidar('s', 'laser') + lidar('t', 'laser')))
    assert tree.frame_ids == ('m', 'l', 'laser')
    assert pose_of(tree, 'laser')[:3] == [1, 0, 0]


def test_of_two_frames_of_a_sensor_look_ups_name_the_first():
    scene = load_text(link_with(
        f'<sensor name="s" type="imu">{TAGS["f"]}{TAGS["g"]}</sensor>'))
    lookup = PoseLookup(scene, tf_tree_from_scene(scene))
    assert lookup.pose('m::l', 'm::l::s').frame_id == 'f'
    assert lookup.pose('m::l', 'g').frame_id == 'g'
