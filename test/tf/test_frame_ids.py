# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frame ids made of scoped names."""

import numpy as np
import pytest
from sdf_texts import element
from sdf_texts import fixed_joint
from sdf_texts import model_file
from sdf_texts import TWO_LINKS
from sdf_texts import world_file

import sdf_pose_bridge
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.frame_ids import FrameNaming

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
