# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names of topics: legal, visible, readable where they can be, and never shared."""

import re

import pytest
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
from rclpy.validate_full_topic_name import validate_full_topic_name
from rclpy.validate_topic_name import validate_topic_name

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st
from sdf_texts import joint, model, model_file, plugin, world_file

from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS, SettingsError
from sdf_pose_bridge.ros.parameters.given import settings_from_values
from sdf_pose_bridge.ros.publishing import topic_names
from sdf_pose_bridge.ros.publishing.topic_names import (
    check_number_of_topics,
    LONGEST_FULL_NAME,
    pose_topics_from_patterns,
    state_topics_from_settings,
    topics_from_patterns,
)
from sdf_pose_bridge.tf.frame_ids import LONGEST_NAME, SHORTEST_LIMIT, topic_name_from_frame_id

NODE = '/sdf_pose_bridge'

# Letters that the escapes themselves are made of, so that look-alikes are common.
ESCAPE_LIKE_TEXT = st.text(alphabet='xab0235_ /-hé', max_size=24)
ANY_TEXT = st.one_of(ESCAPE_LIKE_TEXT, st.text(max_size=60))
LEGAL_LEVEL = re.compile(r'[A-Za-z][A-Za-z0-9_]*')
ESCAPE = re.compile(r'_x((?:[0-9a-f]{2})+)_')
FIRST_ESCAPE = re.compile(r'x((?:[0-9a-f]{2})+)_')


def frame_id_from_topic_name(name):
    """Read a name back by the documented rule; written apart from the code under test."""
    return '/'.join(text_from_level(level) for level in name.split('/'))


def text_from_level(level):
    if level == 'x_':
        return ''
    parts = []
    place = 0
    while place < len(level):
        escape = (ESCAPE if place else FIRST_ESCAPE).match(level, place)
        if escape:
            parts.append(bytes.fromhex(escape[1]).decode('utf-8', 'surrogatepass'))
            place = escape.end()
        else:
            parts.append(level[place])
            place += 1
    return ''.join(parts)


@pytest.mark.parametrize(('frame_id', 'name'), [
    ('left camera', 'left_x20_camera'),
    ('link-1', 'link_x2d_1'),
    ('v1.2/tool', 'v1_x2e_2/tool'),
    ('a::b', 'a_x3a3a_b'),
    ('a__b', 'a_x5f5f_b'),
    ('a_ b', 'a_x5f20_b'),
    ('3d_map', 'x33_d_map'),
    ('3', 'x33_'),
    ('_hidden', 'x5f_hidden'),
    ('größe', 'gr_xc3b6c39f_e'),
    ('', 'x_'),
    ('/a//b/', 'x_/a/x_/b/x_'),
    ('x_', 'x785f_'),
    ('a_x20_b', 'a_x5f_x20_b'),
    ('x20_b', 'x78_20_b'),
    ('a_x20 b', 'a_x5f_x20_x20_b'),
    ('{node}~', 'x7b_node_x7d7e_'),
])
def test_the_documented_rule(frame_id, name):
    assert topic_name_from_frame_id(frame_id) == name


@given(ANY_TEXT)
def test_rclpy_takes_every_name_and_shows_it(frame_id):
    name = topic_name_from_frame_id(frame_id)
    assert validate_topic_name(f'~/poses/{name}')
    assert validate_full_topic_name(f'/robot_1/sdf_pose_bridge/poses/{name}')
    assert not topic_or_service_is_hidden(f'/sdf_pose_bridge/poses/{name}')


@given(ESCAPE_LIKE_TEXT)
def test_a_name_says_which_frame_id_it_stands_for(frame_id):
    name = topic_name_from_frame_id(frame_id, limit=1000)
    assert frame_id_from_topic_name(name) == frame_id


@given(st.lists(ANY_TEXT, unique=True, max_size=30))
def test_no_two_frame_ids_share_a_name(frame_ids):
    names = {topic_name_from_frame_id(frame_id, SHORTEST_LIMIT) for frame_id in frame_ids}
    assert len(names) == len(frame_ids)


@given(st.text(min_size=200, max_size=400), st.integers(SHORTEST_LIMIT, LONGEST_NAME))
def test_long_names_are_cut_and_stay_legal(frame_id, limit):
    name = topic_name_from_frame_id(frame_id, limit)
    assert len(name) <= limit
    assert re.search(r'[^_/]_xh[0-9a-f]{32}_$', name)
    assert all(LEGAL_LEVEL.fullmatch(level) for level in name.split('/'))


def test_a_frame_id_that_reads_as_a_cut_name_does_not_take_its_place():
    cut = topic_name_from_frame_id('a' * 500)
    assert topic_name_from_frame_id(cut) != cut


@pytest.mark.parametrize(('count', 'patterns', 'chosen'), [
    (1000, ['*'], 1000),
    (1001, ['*'], 0),
    (1001, ['?*'], 1001),
    (1001, ['a/*', '*'], 1001),
    (1001, [], 0),
])
def test_the_default_pattern_does_not_mean_thousands_of_topics(count, patterns, chosen):
    frame_ids = [f'f{number}' for number in range(count)]
    topics = pose_topics_from_patterns(frame_ids, patterns, NODE)
    assert len(topics.names) == chosen
    assert ('1001 frames are more than 1000' in topics.warning) is (chosen == 0 and patterns != [])


@pytest.mark.parametrize(('patterns', 'chosen'), [
    (['*'], ['a/b c', 'a/d', 'e']),
    (['a/*', 'e', 'e'], ['a/b c', 'a/d', 'e']),
    (['e', '?/d'], ['a/d', 'e']),
    (['[ae]'], ['e']),
    (['E', 'a'], []),
    ([], []),
])
def test_patterns_choose_whole_frame_ids_in_their_order(patterns, chosen):
    names = pose_topics_from_patterns(['a/b c', 'a/d', 'e'], patterns, NODE).names
    assert list(names) == chosen
    assert all(name == topic_name_from_frame_id(frame_id) for frame_id, name in names.items())


def test_patterns_that_match_nothing_are_named():
    topics = pose_topics_from_patterns(['a/b', 'c'], ['a::*', 'a/*', '*', 'C'], NODE)
    assert 'for "a::*", "C" in pose_topics: no frame id matches' in topics.warning


@pytest.mark.parametrize(('pattern', 'count'), [('*', 1), ('?*', 0), ('a' * 20_000, 1)])
def test_an_endless_frame_id_is_not_compared_with_wildcards(pattern, count):
    assert len(pose_topics_from_patterns(['a' * 20_000], [pattern], NODE).names) == count


def test_an_empty_pattern_is_no_mistake():
    assert pose_topics_from_patterns(['a'], ['', 'a'], NODE).warning == ''


def test_a_name_leaves_room_for_that_of_the_node():
    long_name = '/n' * 60
    (name,) = pose_topics_from_patterns(['a' * 200], ['*'], long_name).names.values()
    assert len(f'{long_name}/poses/{name}') == LONGEST_FULL_NAME


def test_a_node_whose_name_leaves_no_room_has_no_topics():
    topics = pose_topics_from_patterns(['a'], ['*'], '/n' * 100)
    assert topics.names == {}
    assert 'longer than the middleware allows' in topics.warning


@pytest.fixture
def no_comparison(monkeypatch):
    """Makes a comparison with a pattern an error."""
    monkeypatch.setattr(topic_names, 'fnmatchcase', None)


def test_patterns_that_would_take_too_long_are_refused(no_comparison):
    frame_ids = [f'{number}/{"a" * 300}' for number in range(40_000)]
    topics = pose_topics_from_patterns(frame_ids, [f'*{n}{"a" * 200}b' for n in range(1000)], '/n')
    assert topics.names == {}
    assert 'to compare 1000 patterns with 40000 frame ids takes too long' in topics.warning


def test_many_names_without_wildcards_are_found_at_once(no_comparison):
    frame_ids = [f'{number}/{"a" * 300}' for number in range(40_000)]
    topics = pose_topics_from_patterns(frame_ids, [*frame_ids[:999], 'none'], '/n')
    assert list(topics.names) == frame_ids[:999]
    assert '"none"' in topics.warning


# Topics of joint states

DEFAULT = DECLARATIONS['joint_states_topics'].default
GAZEBO = '/world/{world}/model/{model}/joint_state'


def joint_state_topics(patterns, world='w', models=('r1', 'r2'), remapped=None):
    """Name topics for a node in the name space ``/n``, some of which are remapped."""
    def full_name(name):
        full = name if name.startswith('/') else f'/n/{name}'
        return (remapped or {}).get(full, full)
    return topics_from_patterns(
        'joint_states_topics', patterns, world, models, full_name, 'there is none')


@pytest.mark.parametrize(('patterns', 'world', 'models', 'topics'), [
    (DEFAULT, 'w', ['r1', 'r2'],
     {'joint_states': '', 'r1/joint_states': 'r1', 'r2/joint_states': 'r2'}),
    (DEFAULT, 'w', [], {'joint_states': ''}),
    (DEFAULT, '', [], {'joint_states': ''}),
    ([GAZEBO], 'my shop', ['r-1'],
     {'/world/my_x20_shop/model/r_x2d_1/joint_state': 'r-1'}),
    (['a', GAZEBO, '/world/{world}/all'], '', [], {'a': ''}),
    (['/world/{world}/all'], 'w', ['r1'], {'/world/w/all': ''}),
    (['fleet_{model}', 'fleet_{model}'], 'w', ['1', '{world}'],
     {'fleet_x31_': '1', 'fleet_x7b_world_x7d_': '{world}'}),
])
def test_topics_of_joint_states(patterns, world, models, topics):
    assert joint_state_topics(patterns, world, models) == (topics, [])


@pytest.mark.parametrize(('patterns', 'models', 'topics', 'words'), [
    (['a/{model}', '{model}/b'], ['a', 'b'], {'a/a': 'a', 'a/b': '', 'b/b': 'b'},
     'joint_states_topics has /n/a/b for "b", "a", so messages on it can be about all models'),
    (['joint_states', 'joint_{model}'], ['states', 'r'], {'joint_states': '', 'joint_r': 'r'},
     'joint_states_topics has /n/joint_states for "all models", "states", so'),
    (['{model}/s'], ['r1', 'r2'], {'r1/s': ''}, 'has /n/s for "r1", "r2", so'),
])
def test_a_topic_of_two_models_is_one_of_all(patterns, models, topics, words):
    named, (warning,) = joint_state_topics(
        patterns, models=models, remapped={'/n/r1/s': '/n/s', '/n/r2/s': '/n/s'})
    assert named == topics
    assert words in warning


def test_a_model_whose_topic_would_have_too_long_a_name_has_none():
    named, (warning,) = joint_state_topics(['a' * 200 + '/{model}'], models=['r', 'm' * 60])
    assert list(named.values()) == ['r']
    name = 'm' * 60
    assert f'joint_states_topics has no topic for "{name}": its name would be longer' in warning


@pytest.mark.parametrize(('pattern', 'shown'), [('x' * 240, 'x'), ('x' * 100 + '/{model}', 'm')])
def test_a_name_that_is_too_long_in_its_namespace_is_none(make_node, pattern, shown):
    node = make_node('n', '-r', f'__ns:=/{"s" * 30}')
    named, (warning,) = topics_from_patterns(
        'parameter', [pattern], 'w', ['m' * 240], node.resolve_topic_name, '')
    assert named == {}
    assert 'would be longer than the middleware allows' in warning
    assert warning.startswith(f'parameter has no topic for "{shown * 20}')


def test_patterns_that_name_no_topic_of_a_model_file_are_reported():
    named, (warning,) = joint_state_topics(['{model}/joint_states'], '', [])
    assert named == {}
    assert warning == 'joint_states_topics names no topic, because there is none'


# Topics of poses of models

FREE = world_file(
    '<model name="a"><link name="l"/><model name="b c"><link name="l"/></model></model>'
    '<model name="d"><static>true</static><link name="l"/></model>')


@pytest.mark.parametrize(('text', 'values', 'model_poses', 'words'), [
    (FREE, {}, {'/m/a/p': 'a', '/m/a/b_x20_c/p': 'a::b c'}, ()),
    (FREE, {'model_pose_topics': ['/tf_of_{world}']}, {'/tf_of_w': ''}, ()),
    (FREE, {'anchor_models': 'static'}, {}, ('no model follows poses',)),
    (model_file('<link name="l"/>'), {}, {'/m/m/p': 'm'}, ()),
    (model_file('<link name="l"/>'), {'model_name': 'x'}, {'/m/x/p': 'x'}, ()),
    (model_file('<link name="l"/>'), {'model_pose_topics': ['{world}']}, {},
     ('model_pose_topics names no topic, because there is no world',)),
])
def test_topics_of_poses_of_models(text, values, model_poses, words):
    settings = settings_from_values(
        {'robot_description': text, 'model_pose_topics': ['/m/{model}/p'], **values})
    loaded = loaded_scene_from_request(settings.load_request)
    found = state_topics_from_settings(
        settings, loaded.tree, loaded.joint_positions, str)
    assert (found.joint_states, found.model_poses) == ({}, model_poses)
    for line, beginning in zip(found.warnings, words, strict=True):
        assert line.startswith(beginning)


def test_the_topics_of_a_spawned_model_have_its_name():
    settings = settings_from_values({
        'robot_description': model_file(
            '<link name="a"/><link name="b"/>' + joint(
                '<parent>a</parent><child>b</child>', 'j', 'revolute')),
        'model_name': 'x_0', 'use_joint_states': True})
    loaded = loaded_scene_from_request(settings.load_request)
    assert 'x_0/b' in loaded.tree.frame_ids
    found = state_topics_from_settings(settings, loaded.tree, loaded.joint_positions, str)
    assert found.joint_states == {'joint_states': '', 'x_0/joint_states': 'x_0'}


def test_the_topics_of_plugins_are_for_their_models_and_others_stay_where_the_file_puts_them():
    elbow = '<link name="k"/>' + joint('<parent>l</parent><child>k</child>', 'j', 'revolute')
    plugins = plugin('JointStatePublisher', '<topic>/j{}</topic>') + plugin('DiffDrive')
    given_values = {
        'robot_description': world_file(''.join(
            model(name, elbow + content) for name, content in (
                ('a', plugins.format(1)), ('b', ''), ('c', plugins.format(2))))),
        'use_joint_states': True, 'joint_states_topics': ['/a/joint_states', '/j2'],
        'model_pose_topics': ['/a/odometry', '/model/c/odometry'], 'description_format': 'urdf'}
    settings = settings_from_values(given_values)
    loaded = loaded_scene_from_request(settings.load_request)
    found = state_topics_from_settings(settings, loaded.tree, loaded.joint_positions, str)
    assert found == ({'/a/joint_states': 'a', '/j2': 'c'},
                     {'/a/odometry': 'a', '/model/c/odometry': 'c'}, ())
    assert loaded.tree.at_rest == (['b/j'], ['b'])
    fixed = {loaded.tree.frame_ids[each] for each in loaded.tree.fixed_indices}
    assert {'b', 'b/l', 'b/k'} <= fixed
    assert fixed.isdisjoint({'a/l', 'a/k', 'c/l', 'c/k'})
    # A topic of others may be about any model, and so may a simulator.
    for values in ({'model_pose_topics': ['/a/odometry', '/poses']}, {'simulator': '/s'}):
        tree = loaded_scene_from_request(settings_from_values(
            {**given_values, **values}).load_request).tree
        assert tree.at_rest == (['b/j'], [])


def test_too_many_topics_of_poses_are_refused():
    models = ''.join(f'<model name="m{n}"><link name="l"/></model>' for n in range(501))
    settings = settings_from_values({
        'robot_description': world_file(models), 'model_pose_topics': ['{model}/a', '{model}/b']})
    loaded = loaded_scene_from_request(settings.load_request)
    with pytest.raises(SettingsError, match='model_pose_topics names 1002 topics'):
        check_number_of_topics(settings, loaded.joint_positions)
