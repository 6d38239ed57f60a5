# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What poses of models change, and the ones that are ignored."""

import math

from geometry_msgs.msg import PoseStamped
from moving_models import Models, POSE
import numpy as np
import pytest
from rclpy.serialization import serialize_message

from sdf_pose_bridge.errors import JointPositionError
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy
from sdf_pose_bridge.ros.cdr import LONGEST_READ_S, StampedPose
from sdf_pose_bridge.ros.following.model_poses import messages_from_poses
from sdf_pose_bridge.ros.following.state_messages import MOST_BYTES
from sdf_pose_bridge.ros.following.state_topic import StateTopic, TopicKey

QUARTER = (*POSE[:3], *quaternion_from_rpy((0.0, 0.0, math.pi / 2.0)))
"""That pose after a quarter turn about z."""


@pytest.fixture
def models(make_node):
    return Models(make_node('bridge'))


@pytest.mark.parametrize(('child', 'name'), [
    ('a', 'a'), ('p/a', 'a'), ('a::b', 'a/b'), ('a/b', 'a/b'), ('p/a/b', 'a/b')])
def test_models_have_their_names_and_their_frame_ids(models, child, name):
    (message,) = models.read(child)
    assert [models.positions.names[dof] for dof in message.stream.selection.dofs] == [name]
    assert message.values.tolist() == [list(POSE)]
    assert models.read(child)[0].stream is message.stream


@pytest.mark.parametrize('frame_id', ['', 'world', 'w', 'robot/odom'])
def test_frames_that_mean_the_root(models, frame_id):
    assert models.read(frame_id=frame_id)[0].frame_id == ''


@pytest.mark.parametrize('frame_id', ['', 'p/a/b'])
def test_a_model_is_placed_before_poses_in_its_frame(models, frame_id):
    messages = messages_from_poses(
        [StampedPose(5, 'p/a', 'a/b', POSE), StampedPose(5, frame_id, 'a', POSE)], models.source,
        models.streams)
    assert [each.frame_id for each in messages] == [frame_id, 'p/a']


@pytest.mark.parametrize(('fields', 'line'), [
    ({'child': 'fixed'}, '/poses has poses of "fixed", which are ignored: no model has'),
    ({'child': 'aa'}, 'another body; did you mean "a"?'),
    ({'child': 'k'}, 'another body; did you mean "p/a/k"?'),
    ({'frame_id': 'odom'}, '/poses has poses in "odom", which are ignored: there is no such'),
    ({'frame_id': f'{"x" * 255}/odom'}, '/odom", which are ignored: there is no such'),
    ({'frame_id': 'p/a/k'}, '/poses has poses in "p/a/k", which are ignored: such a frame moves'),
    *(({'pose': (*POSE[:3], *quat)}, 'has no quaternion of length 1') for quat in (
        (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.02), (0.0, 0.0, float('nan'), 1.0),
        (float('inf'), 0.0, 0.0, 0.0))),
    *(({'pose': (x, *POSE[1:])}, 'or a position that is not finite or beyond 1e+09') for x in (
        float('nan'), float('-inf'), 1e10)),
])
def test_a_pose_that_cannot_be_used_is_reported_once(models, capfd, fields, line):
    assert not models.read(**fields)
    assert not models.read(**fields)
    assert capfd.readouterr().err.count(line) == 1


def test_a_pose_of_a_part_in_what_contains_it_is_not_reported(models, capfd):
    assert not models.read('p/a/k/mesh', 'p/a/k')
    assert not models.read('mesh', 'p/a/k')
    log = capfd.readouterr().err
    assert '/poses has poses of "mesh", which are ignored' in log
    assert 'p/a/k/mesh' not in log


@pytest.mark.parametrize(('placement', 'fields', 'moved'), [
    # The frame that the child frame id names.
    ('', {'child': 'p/a/k'}, ('a', 0.75, 2.0)),
    ('', {'child': 'a::k', 'model': 'a'}, ('a', 0.75, 2.0)),
    ('', {'child': 'p/a/k', 'frame_id': 'p/fixed/l'}, ('a', 0.75, 4.0)),
    ('', {'child': 'a', 'model': 'a'}, ('a', 1.0, 2.0)),
    ('', {'child': 'base_link', 'model': 'a'}, ('a', 1.0, 2.0)),
    # As in the file of the model.
    ('', {'child': 'k', 'model': 'a'}, ('a', 0.75, 2.0)),
    ('', {'child': 'c/l', 'model': 'a'}, ('a', pytest.approx(-3.25), 2.0)),
    ('', {'child': 'k', 'frame_id': 'o', 'model': 'a'}, ('a', 1.0, 2.0)),
    ('', {'child': 'p/a/k', 'pose': QUARTER}, ('a', pytest.approx(1.0), pytest.approx(1.75))),
    # The frame of the parameter, whatever the child frame id says.
    ('k', {'child': '', 'model': 'a'}, ('a', 0.75, 2.0)),
    ('k', {'child': 'p/a/l', 'model': 'a'}, ('a', 0.75, 2.0)),
    ('k', {'child': '', 'model': 'a::b'}, ('a/b', 1.0, 2.0)),
    ('k', {'child': '', 'model': 'a::b', 'frame_id': 'b/odom'}, ('a/b', 1.0, 5.0)),
])
def test_the_frame_that_a_message_or_the_parameter_names_is_put_there(
        make_node, placement, fields, moved):
    models = Models(make_node('bridge'), placement)
    models.positions.update(models.positions.selection(['j']), np.array([0.25]), 5)
    assert models.moved(**fields) == moved


@pytest.mark.parametrize('child', ['a::b', 'p/a/b/l', 'fixed', 'world'])
def test_a_child_frame_id_of_another_model_is_reported_on_the_topic_of_a_model(
        models, capfd, child):
    models.source.model = 'a'
    assert not models.read(child=child, model='a')
    words = f'poses of "{child}", which are ignored: the topic is for the model "a"'
    assert words in capfd.readouterr().err


def test_the_odometry_of_wheels_counts_from_the_file_whatever_the_parameters_say(models, capfd):
    assert models.moved(child='p/a/b/l', frame_id='b/odom') == ('a/b', 1.0, 5.0)
    assert models.moved(child='x', model='a::b', frame_id='b/odom') == ('a/b', 1.0, 5.0)
    assert models.moved(frame_id='a/odom') == ('a', 1.0, 2.0)
    assert models.moved(child='p/a/b/l', frame_id='b/odom', pose=QUARTER) == ('a/b', 1.0, 5.0)
    models.read(frame_id='c/odom')
    log = capfd.readouterr().err
    assert log.count('model_pose_frames has no effect on "b/odom": the odometry of wheels') == 1
    assert log.count('which counts as the root frame by model_pose_frames') == 1


@pytest.mark.parametrize(('topic', 'moved'), [
    # The offset is taken back in the turned model.
    ('/a/odometry_1', ('a', 0.0, 2.0)),
    ('/model/a/odometry', ('a', 0.0, 2.0)),
    ('/a/odometry', ('a', 1.0, 2.0)),
    ('/wheels', ('a', 1.0, 2.0)),
])
@pytest.mark.parametrize('model', [None, 'a'])
def test_the_topic_decides_between_odometries_in_one_frame(models, capfd, topic, moved, model):
    models.source.name = topic
    assert models.moved(
        child='p/a/k', frame_id='o', pose=QUARTER, model=model) == pytest.approx(moved)
    assert 'o"' not in capfd.readouterr().err


def test_another_topic_in_the_frame_of_two_odometries_counts_as_the_first_and_is_told(
        models, capfd):
    assert models.moved(frame_id='o', pose=QUARTER)[1:] == pytest.approx((1.0, 2.0))
    models.read(frame_id='o')
    line = ('/poses has poses in "o", the frame of the odometry of several plugins, and is none '
            'of their topics "/a/odometry", "/a/odometry_1"; its poses count as on the first')
    assert capfd.readouterr().err.count(line) == 1


def test_on_a_topic_and_in_a_frame_of_two_models_the_child_frame_id_decides(models, capfd):
    models.source.name = '/shared'
    assert models.moved(child='a::b', frame_id='s')[0] == 'a/b'
    assert not models.read(child='x', frame_id='s')
    assert 'poses of "x", which are ignored: no model has this name' in capfd.readouterr().err


@pytest.mark.parametrize('source', ['/a/c/odometry', '/poses'])
def test_the_odometry_of_a_model_in_another_one_moves_both(models, source):
    models.source.name = source
    models.positions.update(models.positions.selection(['j']), np.array([0.25]), 5)
    # The model c starts at x = 4, and is 4.25 m before a now.
    model = 'a' if source == '/poses' else None
    assert models.moved(child='x', frame_id='of_c', model=model) == (
        'a', pytest.approx(0.75), pytest.approx(2.0))


def test_a_pose_on_a_topic_for_no_single_model_is_ignored(models, capfd):
    topic = StateTopic(
        models.source._node, TopicKey('/p', '', 'geometry_msgs/msg/PoseStamped'))
    assert topic.read(serialize_message(PoseStamped()), models.streams) == ()
    assert 'no single model is meant' in capfd.readouterr().err


def test_a_placement_that_no_model_has_is_reported(make_node, capfd):
    Models(make_node('bridge'), 'markers').read()
    assert 'model_pose_placement: no model that can move has "markers"' in capfd.readouterr().err


def test_poses_of_links_say_nothing_unless_the_pose_of_the_model_is_there(models, capfd):
    links = [StampedPose(5, 'p/a', child, POSE) for child in ('p/a/l', 'p/a/k')]
    model = StampedPose(5, 'w', 'a', POSE)
    (message,) = messages_from_poses([*links, model], models.source, models.streams)
    assert message.values.tolist() == [list(POSE)]
    words = 'PosePublisher sends poses of models with <publish_model_pose>'
    assert words not in capfd.readouterr().err
    assert not messages_from_poses(links, models.source, models.streams)
    assert not messages_from_poses(links, models.source, models.streams)
    assert capfd.readouterr().err.count(words) == 1


def test_poses_of_links_in_messages_of_their_own_are_told_if_that_of_the_model_never_comes(
        models, capfd):
    def send(*children):
        for child in children:
            models.read(child, 'w' if child == 'a' else 'p/a')
        return capfd.readouterr().err.count('PosePublisher sends poses of models')

    assert send('p/a/l', 'p/a/k', 'a', 'p/a/l', 'p/a/k', 'a', 'p/a/l', 'p/a/k') == 0
    assert send('p/a/l') == 1


def test_a_quaternion_that_is_nearly_unit_is_made_unit(models):
    (message,) = models.read(pose=(*POSE[:3], 0.0, 0.0, 0.0, -1.009))
    assert message.values[0, 3:].tolist() == [0.0, 0.0, 0.0, 1.0]


def test_poses_in_a_frame_of_the_tree_are_composed_with_it(models):
    (message,) = models.read(frame_id='p/fixed/l')
    assert models.streams.values(message).tolist() == [[1.0, 4.0, 3.0, 0.0, 0.0, 0.0, 1.0]]


def test_a_frame_without_a_pose_of_its_own_is_refused(models):
    (message,) = models.read('a::b', 'p/a/l')
    with pytest.raises(JointPositionError, match='depends on the pose of model "a"'):
        models.streams.values(message)


def test_frame_ids_are_looked_up_once_and_for_a_limited_time_in_a_message(models, monkeypatch):
    now, looked_up = 0.0, []

    def knows(name):
        nonlocal now
        now += 0.4 * LONGEST_READ_S
        looked_up.append(name)
        return name == 'p/fixed/l'

    monkeypatch.setattr('time.thread_time', lambda: now)
    models.streams.lookup.knows = knows
    frame_ids = [*'abcdefg', 'p/fixed/l']
    poses = [StampedPose(5, each, 'a', POSE) for each in frame_ids]
    found = [messages_from_poses(poses, models.source, models.streams) for _ in range(4)]
    assert looked_up == frame_ids
    assert [len(each) for each in found] == [0, 0, 1, 1]


def test_the_meanings_of_frame_ids_take_a_limited_number_of_bytes(models):
    looked_up = []
    models.streams.lookup.knows = looked_up.append
    for number in range(2 * MOST_BYTES // 100_000):
        models.read(frame_id=f'{number} {"x" * 100_000}')
    count = len(looked_up)
    models.read(frame_id=looked_up[-1])
    assert len(looked_up) == count
    models.read(frame_id=looked_up[0])
    assert len(looked_up) == count + 1


def test_poses_in_one_frame_with_one_stamp_are_one_message(models):
    poses = [
        StampedPose(stamp_ns, frame_id, child, (x, *POSE[1:]))
        for x, child, stamp_ns, frame_id in (
            (1.0, 'a::b', 5, ''), (2.0, 'a', 5, 'w'), (3.0, 'a', 6, ''), (4.0, 'a', 5, ''),
            (5.0, 'a::b', 5, 'p/fixed/l'), (6.0, 'a', 5, 'p/fixed/l'))]
    messages = messages_from_poses(poses, models.source, models.streams)
    names = models.positions.names
    found = [
        ([names[dof] for dof in each.stream.selection.dofs], each.values[:, 0].tolist(),
         each.stamp_ns) for each in messages]
    assert found == [(['a', 'a/b'], [4.0, 1.0], 5), (['a'], [3.0], 6),
        (['a', 'a/b'], [6.0, 5.0], 5)]
    assert models.streams.values(messages[2])[:, :2].tolist() == [[6.0, 4.0], [5.0, 4.0]]
    again = messages_from_poses(poses[1::-1], models.source, models.streams)
    assert again[0].stream is messages[0].stream
