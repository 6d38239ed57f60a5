# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A running bridge whose parameters change, seen by listeners in another process."""

from changes import (
    last_x,
    listen_to_tf,
    Monitor,
    parameter_value,
    reason_for_refusal,
    reload,
    replace,
    set_parameters,
    usage_of,
    wait_for_x,
    world,
)
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import TransformStamped
from listener import latched
from sizes import size
from tf2_msgs.msg import TFMessage

FRAMES = ''.join(f'<frame name="f{number}"/>' for number in range(5000))


REFUSED = [
    ({'kinds': [True]}, 'is [True], which is a list of booleans; it must be a list of strings'),
    ({'sdf_file': 'not_there.sdf'}, '/not_there.sdf: FILE_READ: the file cannot be read'),
    ({'frame_prefix': 'a', 'kinds': ['linc']}, 'parameter kinds is "linc"'),
    ({'frame_prefix': 'a', 'frame_name': 'b'},
     'there is no parameter "frame_name"; did you mean "frame_names"?'),
    ({'x' * 1000: 'a'}, f'there is no parameter "{"x" * 38}...{"x" * 38}"'),
]


def test_what_cannot_be_taken_is_answered_and_changes_nothing(bridge, listener):
    for values, reason in REFUSED:
        assert reason in reason_for_refusal(listener, **values)
    assert parameter_value(listener, 'frame_prefix').string_value == ''
    Monitor(listener).wait_for(DiagnosticStatus.OK)
    assert len(listener.tf_messages) == 1
    assert not [line for line in bridge.lines if line.startswith('[ERROR]')]


def test_poses_are_given_in_the_frame_that_is_set(bridge, file, start_listener):
    file.write_text(world(1, extra='<frame name="desk"><pose>3 0 0 0 0 0</pose></frame>'))
    listener = start_listener()
    listener.listen_to_poses(['/sdf_pose_bridge/poses/desk', '/sdf_pose_bridge/poses/crate'])

    def wait_for_poses(frame, **expected):
        def found():
            return {
                topic.rpartition('/')[2]: pose.pose.position.x
                for topic, pose in listener.poses.items() if pose.header.frame_id == frame}
        listener.wait(lambda: found() == expected, found)

    wait_for_poses('world', desk=3.0, crate=1.0)
    assert 'no frame "dsk" to be the pose_frame; did you mean "desk"?' in (
        reason_for_refusal(listener, pose_frame='dsk'))
    assert parameter_value(listener, 'pose_frame').string_value == ''
    set_parameters(listener, pose_frame='desk')
    wait_for_poses('desk', desk=0.0, crate=-2.0)


def test_parameters_set_in_one_call_take_effect_together(file, listener):
    set_parameters(
        listener, sdf_file=str(file), frame_prefix='a/', root_frame='map', watch=True)
    listener.wait(lambda: len(listener.tf_messages) == 2, 'the new frames')
    ids = {(each.header.frame_id, each.child_frame_id)
           for each in listener.tf_messages[1].transforms}
    assert ids == {('map', 'a/crate/body'), ('a/crate/body', 'a/crate')}


def test_parameters_that_change_nothing_publish_nothing(file, listener):
    set_parameters(listener, root_frame='world', publish_rate=0.0, watch=True, pose_topics=['*'])
    replace(file, world(2))
    wait_for_x(listener, 2.0)
    assert len(listener.tf_messages) == 2


def test_unwatched_files_are_read_again_only_when_asked(bridge, file, listener):
    set_parameters(listener, watch=False)
    monitor = Monitor(listener)
    replace(file, world(6))
    monitor.wait_for(DiagnosticStatus.OK)
    assert last_x(listener) == 1.0
    answer = reload(listener)
    assert answer.success, answer.message
    wait_for_x(listener, 6.0)
    replace(file, world(7))
    set_parameters(listener, sdf_file=str(file))
    wait_for_x(listener, 7.0)
    # Nobody looks at the file a second time.
    replace(file, 'not XML')
    answer = reload(listener)
    assert not answer.success
    assert f'{file}:1: FILE_READ' in answer.message
    assert f'{file}:1: FILE_READ' in bridge.wait_for_line('FILE_READ')
    monitor.wait_for(DiagnosticStatus.ERROR)
    replace(file, world(8))
    set_parameters(listener, watch=True)
    wait_for_x(listener, 8.0)


def test_everything_is_published_again_at_a_rate(bridge, start_listener):
    listener = start_listener()
    listener.node.create_subscription(
        TFMessage, '/tf_static', listener.tf_messages.append, 10)
    set_parameters(listener, publish_rate=20.0)
    listener.wait(lambda: len(listener.tf_messages) > 2, 'messages without latching')
    stamps = [(each.transforms[0].header.stamp.sec, each.transforms[0].header.stamp.nanosec)
              for each in listener.tf_messages[:3]]
    assert stamps == sorted(set(stamps))


def test_a_rate_that_is_not_reached_keeps_nobody_from_changing_anything(
        bridge, file, start_listener):
    listener = start_listener()
    replace(file, world(1, extra=FRAMES))
    set_parameters(listener, publish_rate=100.0)
    bridge.wait_for_line('publish_rate 100.0 Hz is not reached: to publish everything takes ')
    # It takes longer for a message than the bridge, so a queue would delay it.
    listen_to_tf(listener, depth=1)
    assert reload(listener).success
    replace(file, world(2, extra=FRAMES))
    wait_for_x(listener, 2.0)
    set_parameters(listener, publish_rate=0.0)


def test_many_reloads_leave_nothing_behind(bridge, start_listener):
    listener = start_listener()

    def reload_often(times):
        for _ in range(times):
            answer = reload(listener)
            assert answer.success, answer.message

    def used():
        return usage_of(bridge.pid)

    reload_often(10)
    memory, threads, files = used()
    reload_often(size(30, 1000))
    assert used()[0] - memory < 4096, 'kB more'
    # The thread of the last load may be about to end.
    listener.wait(
        lambda: used()[1] <= threads and used()[2] <= files,
        lambda: f'{threads} threads and {files} descriptors, there are {used()[1:]}')


def test_thousands_of_frames_have_no_topics_unless_asked_for(bridge, file, start_listener):
    replace(file, world(1, extra=FRAMES))
    line = bridge.wait_for_line('no ~/poses/... topics')
    assert '5002 frames are more than 1000' in line
    listener = start_listener()
    frame_ids = set()
    subscription = listener.node.create_subscription(
        TransformStamped, '/sdf_pose_bridge/transforms',
        lambda message: frame_ids.add(message.child_frame_id), latched(6000))

    def has_all():
        # The executor would take most of the time.
        while taken := subscription.handle.take_message(TransformStamped, False):
            frame_ids.add(taken[0].child_frame_id)
        return len(frame_ids) == 5002

    # More than the 5000 samples that Fast DDS keeps by default.
    listener.wait(has_all, lambda: len(frame_ids))
