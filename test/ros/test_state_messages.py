# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What poses of models change, and the ones that are ignored."""

import re

from deadline import wait_until
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from geometry_msgs.msg import PoseStamped
from sdf_texts import joint, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.errors import JointPositionError
from sdf_pose_bridge.ros.cdr import LONGEST_READ_S, StampedPose
from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers
from sdf_pose_bridge.ros.state_messages import Effects, MOST_BYTES, StateSource
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

TEXT = world_file(
    '<model name="a"><link name="l"/><link name="k"/>' + joint(
        '<parent>l</parent><child>k</child><axis><xyz>1 0 0</xyz></axis>', 'j', 'prismatic')
    + '<model name="b"><link name="l"/></model></model>'
    '<model name="fixed"><static>true</static><pose>0 2 0 0 0 0</pose><link name="l"/></model>')
TURNED = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)


class Models:
    """A source of poses of the models ``a`` and ``a::b``."""

    def __init__(self, node):
        scene = load_text(TEXT)
        tree = tf_tree_from_scene(scene, TfOptions(
            use_joint_states=True, follows_models=True, frame_prefix='p/'))
        self.positions = JointPositions(scene, tree.moving.motion)
        self.effects = Effects(
            PublishedFrames(Publishers(node), tree, self.positions, {}).moving,
            PoseLookup(scene, tree, self.positions), [re.compile('.*/odom')])
        self.source = StateSource(node, '/poses')

    def read(self, child='a', frame_id='', pose=TURNED, stamp_ns=5):
        """Return the messages of a pose."""
        return self.source.messages_from_poses(
            [StampedPose(stamp_ns, frame_id, child, pose)], self.effects)


@pytest.fixture(name='models')
def make_models(make_node):
    return Models(make_node('bridge'))


@pytest.mark.parametrize(('child', 'name'), [
    ('a', 'a'), ('p/a', 'a'), ('a::b', 'a/b'), ('a/b', 'a/b'), ('p/a/b', 'a/b')])
def test_models_have_their_names_and_their_frame_ids(models, child, name):
    (message,) = models.read(child)
    assert [models.positions.names[dof] for dof in message.effect.selection.dofs] == [name]
    assert message.values.tolist() == [list(TURNED)]
    assert models.read(child)[0].effect is message.effect


@pytest.mark.parametrize('frame_id', ['', 'world', 'w', 'robot/odom'])
def test_frames_that_mean_the_root(models, frame_id):
    assert models.read(frame_id=frame_id)[0].frame_id == ''


@pytest.mark.parametrize(('fields', 'line'), [
    ({'child': 'fixed'}, '/poses has poses of "fixed", which are ignored: no model has'),
    ({'child': 'aa'}, 'another body; did you mean "a"?'),
    ({'frame_id': 'odom'}, '/poses has poses in "odom", which are ignored: there is no such'),
    ({'frame_id': f'{"x" * 255}/odom'}, '/odom", which are ignored: there is no such'),
    ({'frame_id': 'p/a/k'}, 'a pose from /poses is ignored: "p/a/k" moves with the model'),
    *(({'pose': (*TURNED[:3], *quat)}, 'has no quaternion of length 1') for quat in (
        (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.02), (0.0, 0.0, float('nan'), 1.0),
        (float('inf'), 0.0, 0.0, 0.0))),
])
def test_a_pose_that_cannot_be_used_is_reported_once(models, capfd, fields, line):
    assert not models.read(**fields)
    assert not models.read(**fields)
    assert capfd.readouterr().err.count(line) == 1


def test_a_quaternion_that_is_nearly_unit_is_made_unit(models):
    (message,) = models.read(pose=(*TURNED[:3], 0.0, 0.0, 0.0, -1.009))
    assert message.values[0, 3:].tolist() == [0.0, 0.0, 0.0, 1.0]


def test_poses_in_a_frame_of_the_tree_are_composed_with_it(models):
    (message,) = models.read(frame_id='p/fixed/l')
    assert models.effects.values(message).tolist() == [[1.0, 4.0, 3.0, 0.0, 0.0, 0.0, 1.0]]


def test_a_frame_without_a_pose_of_its_own_is_refused(models):
    (message,) = models.read('a::b', 'p/a/l')
    with pytest.raises(JointPositionError, match='depends on the pose of model "a"'):
        models.effects.values(message)


def test_frame_ids_are_looked_up_once_and_for_a_limited_time_in_a_message(models, monkeypatch):
    now, looked_up = 0.0, []

    def knows(name):
        nonlocal now
        now += 0.4 * LONGEST_READ_S
        looked_up.append(name)
        return name == 'p/fixed/l'

    monkeypatch.setattr('time.monotonic', lambda: now)
    models.effects.lookup.knows = knows
    frame_ids = [*'abcdefg', 'p/fixed/l']
    poses = [StampedPose(5, each, 'a', TURNED) for each in frame_ids]
    found = [models.source.messages_from_poses(poses, models.effects) for _ in range(4)]
    assert looked_up == frame_ids
    assert [len(each) for each in found] == [0, 0, 1, 1]


def test_the_meanings_of_frame_ids_take_a_limited_number_of_bytes(models):
    looked_up = []
    models.effects.lookup.knows = looked_up.append
    for number in range(2 * MOST_BYTES // 100_000):
        models.read(frame_id=f'{number} {"x" * 100_000}')
    count = len(looked_up)
    models.read(frame_id=looked_up[-1])
    assert len(looked_up) == count
    models.read(frame_id=looked_up[0])
    assert len(looked_up) == count + 1


def test_the_newest_message_of_a_model_counts(models):
    waiting = [models.read(stamp_ns=stamp_ns) for stamp_ns in (5, 6, 4)]
    models.source.messages = lambda _effects: waiting.pop() if waiting else None
    newest = {}
    while models.source.take(models.effects, newest):
        pass
    assert [each.stamp_ns for each in newest.values()] == [6]


def test_a_pose_moves_the_link_at_which_the_model_hangs(models):
    (message,) = models.read()
    models.positions.update(message.effect.selection, message.values, 5)
    frames = models.effects.rows(message.effect)
    assert len(frames) == 1


def test_poses_in_one_frame_with_one_stamp_are_one_message(models):
    poses = [
        StampedPose(stamp_ns, frame_id, child, (x, *TURNED[1:]))
        for x, child, stamp_ns, frame_id in (
            (1.0, 'a::b', 5, ''), (2.0, 'a', 5, 'w'), (3.0, 'a', 6, ''), (4.0, 'a', 5, ''),
            (5.0, 'a::b', 5, 'p/fixed/l'), (6.0, 'a', 5, 'p/fixed/l'))]
    messages = models.source.messages_from_poses(poses, models.effects)
    names = models.positions.names
    found = [
        ([names[dof] for dof in each.effect.selection.dofs], each.values[:, 0].tolist(),
         each.stamp_ns) for each in messages]
    assert found == [(['a', 'a/b'], [4.0, 1.0], 5), (['a'], [3.0], 6),
        (['a', 'a/b'], [6.0, 5.0], 5)]
    assert models.effects.values(messages[2])[:, :2].tolist() == [[6.0, 4.0], [5.0, 4.0]]
    again = models.source.messages_from_poses(poses[1::-1], models.effects)
    assert again[0].effect is messages[0].effect


# Publishers

@pytest.fixture(name='look')
def make_look(models, make_node):
    """
    Sends messages and returns the lines about publishers; ``look(*periods)``.

    A period has messages, each as a source, the number of its publisher and a model.
    """
    other = make_node('other')
    publishers = [other.create_publisher(PoseStamped, '/poses', 10) for _ in range(2)]
    sources = {'poses': models.source, 'alone': StateSource(models.source._node, '/alone')}
    publishers.append(other.create_publisher(PoseStamped, '/alone', 10))
    wait_until(lambda: [len(each.publishers()) for each in sources.values()] == [2, 1])

    def look(*periods):
        for period in periods:
            for name, number, child in period:
                source = sources[name]
                source.number = number
                source.messages = lambda effects, source=source, child=child: (
                    source.messages_from_poses(
                        [StampedPose(5, '', child, TURNED)], effects))
                source.take(models.effects, {})
            models.effects.look_at_publishers()
        return models.effects.problems([])
    return look


BOTH = [('poses', 1, 'a'), ('alone', 1, 'a')]
TURNS = [('poses', number, 'a') for number in (7, 1, 8, 2, 9, 3)]


def test_publishers_of_one_model_on_two_topics_are_reported_as_long_as_it_lasts(look, capfd):
    line = 'messages about model "a" come from several publishers at once on /alone and /poses; '
    assert not look(BOTH)
    found = look(BOTH)
    assert len(found) == 1
    assert found[0].startswith(line)
    assert not look(BOTH[:1])
    look(BOTH, BOTH)
    assert capfd.readouterr().err.count(line) == 1


def test_publishers_of_one_model_on_one_topic_are_reported(look):
    line = 'messages about model "a" come from several publishers at once on /poses, among "/'
    found = look(TURNS)
    assert len(found) == 1
    assert found[0].startswith(line)
    assert not look([])


@pytest.mark.parametrize('periods', [
    [BOTH[:1], BOTH, BOTH[1:]],
    [[('alone', number, 'a') for _, number, _ in TURNS]],
    [[('poses', None, 'a')] * 6] * 2,
    [[('poses', number, 'a') for number in (7, 8, 1, 2, 3)]] * 2,
    [[(*each, ('a', 'a::b')[row % 2]) for row, (*each, _) in enumerate(TURNS)]],
], ids=['replaced', 'one publisher', 'no numbers', 'restarted', 'different models'])
def test_publishers_that_are_not_several_at_once_are_not_reported(look, periods):
    for period in periods:
        assert not look(period)
