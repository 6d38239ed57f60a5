# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A running bridge whose file or parameters change, seen by listeners in another process."""

from pathlib import Path
import signal

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from changes import (
    last_x,
    listen_to_tf,
    Monitor,
    reload,
    replace,
    set_parameters,
    wait_for_x,
    world,
)
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import TransformStamped
from listener import latched
from rcl_interfaces.msg import Parameter
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from sizes import size
from tf2_msgs.msg import TFMessage


def value_of(listener, name):
    request = GetParameters.Request(names=[name])
    (value,) = listener.call(GetParameters, '/sdf_pose_bridge/get_parameters', request).values
    return value.string_value


def test_a_bad_file_is_refused_with_the_reason_and_changes_nothing(
        bridge, file, start_listener, tmp_path):
    bad = tmp_path / 'bad.sdf'
    bad.write_text(world(2).replace('<pose>', '<pose relative_to="floor">'))
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    (result,) = set_parameters(listener, sdf_file=str(bad))
    assert not result.successful
    assert f'{bad}:3: POSE_RELATIVE_TO_INVALID: relative_to="floor"' in result.reason
    assert value_of(listener, 'sdf_file') == str(file)
    assert len(listener.tf_messages) == 1


def test_another_file_reaches_an_early_and_a_late_listener(bridge, start_listener, tmp_path):
    other = tmp_path / 'other.sdf'
    other.write_text(world(5))
    early = start_listener()
    listen_to_tf(early)
    wait_for_x(early, 1.0)
    (result,) = set_parameters(early, sdf_file=str(other))
    assert result.successful, result.reason
    wait_for_x(early, 5.0)
    late = start_listener()
    late.listen_to_frames()
    late.listen_to_poses(['/sdf_pose_bridge/poses/crate/body'])
    wait_for_x(late, 5.0)
    late.wait_for_keys(late.transforms, ['crate', 'crate/body'])
    assert late.transforms['crate/body'].transform.translation.x == 5.0
    late.wait_for_keys(late.poses, ['/sdf_pose_bridge/poses/crate/body'])
    assert late.poses['/sdf_pose_bridge/poses/crate/body'].pose.position.x == 5.0


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
    (result,) = set_parameters(listener, pose_frame='dsk')
    assert not result.successful
    assert 'no frame "dsk" to be the pose_frame; did you mean "desk"?' in result.reason
    assert value_of(listener, 'pose_frame') == ''
    (result,) = set_parameters(listener, pose_frame='desk')
    assert result.successful, result.reason
    wait_for_poses('desk', desk=0.0, crate=-2.0)


def test_an_unknown_frame_of_poses_is_named_at_the_start(start_bridge, file):
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={file}', '-p', 'pose_frame:=crate/bdy')
    assert 'did you mean "crate/body"?' in bridge.wait_for_line('no frame "crate/bdy"')
    assert bridge.wait_for_end() == 1


def test_parameters_set_in_one_call_take_effect_together(bridge, start_listener):
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    results = set_parameters(listener, frame_prefix='a/', root_frame='map')
    assert [result.successful for result in results] == [True, True]
    listener.wait(lambda: len(listener.tf_messages) == 2, lambda: 'the new frames')
    ids = {(each.header.frame_id, each.child_frame_id)
           for each in listener.tf_messages[1].transforms}
    assert ids == {('map', 'a/crate/body'), ('a/crate/body', 'a/crate')}


def test_of_parameters_set_in_one_call_none_is_taken_if_one_is_wrong(bridge, start_listener):
    listener = start_listener()
    results = set_parameters(listener, frame_prefix='a/', root_frame='')
    assert [result.successful for result in results] == [False, False]
    assert 'parameter root_frame is ""' in results[0].reason
    assert value_of(listener, 'frame_prefix') == ''


def test_what_is_dumped_can_be_loaded(bridge, start_listener):
    listener = start_listener()
    names = listener.call(
        ListParameters, '/sdf_pose_bridge/list_parameters', ListParameters.Request()).result.names
    values = listener.call(
        GetParameters, '/sdf_pose_bridge/get_parameters',
        GetParameters.Request(names=names)).values
    assert {'sdf_file', 'start_type_description_service', 'use_sim_time'} <= set(names)
    results = listener.call(
        SetParameters, '/sdf_pose_bridge/set_parameters', SetParameters.Request(parameters=[
            Parameter(name=name, value=value)
            for name, value in zip(names, values, strict=True)])).results
    assert [result.successful for result in results] == [True] * len(names), results[0].reason


def test_a_replaced_file_is_read_again(bridge, file, start_listener):
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    replace(file, world(7))
    wait_for_x(listener, 7.0)


def test_a_broken_file_is_reported_and_its_repair_is_noticed(bridge, file, start_listener):
    listener = start_listener()
    listen_to_tf(listener)
    monitor = Monitor(listener)
    monitor.wait_for(DiagnosticStatus.OK)
    file.write_text('<sdf version="1.10"><world name="w">')
    monitor.wait_for(DiagnosticStatus.ERROR)
    assert f'{file}:1: FILE_READ' in monitor.status.message
    bridge.wait_for_line('the frames published before stay')
    assert len(listener.tf_messages) == 1
    file.write_text(world(3))
    wait_for_x(listener, 3.0)
    monitor.wait_for(DiagnosticStatus.OK)


def test_a_deleted_file_is_reported_and_its_return_is_noticed(bridge, file, start_listener):
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    file.unlink()
    bridge.wait_for_line('the file cannot be read: No such file or directory')
    replace(file, world(4))
    wait_for_x(listener, 4.0)


def test_an_included_model_is_watched_too(start_bridge, start_listener, tmp_path):
    (tmp_path / 'box').mkdir()
    (tmp_path / 'box' / 'model.config').write_text(
        '<model><name>box</name><sdf version="1.10">box.sdf</sdf></model>')
    model = """<sdf version="1.10"><model name="box">
      <link name="l"><pose>{} 0 0 0 0 0</pose></link></model></sdf>"""
    (tmp_path / 'box' / 'box.sdf').write_text(model.format(1))
    (tmp_path / 'w.sdf').write_text('<sdf version="1.10"><world name="w"><include>'
                                    '<uri>model://box</uri></include></world></sdf>')
    start_bridge('--ros-args', '-p', f'sdf_file:={tmp_path / "w.sdf"}',
                 '-p', f'resource_paths:=[{tmp_path}]').wait_until_started()
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0, 'box/l')
    replace(tmp_path / 'box' / 'box.sdf', model.format(2))
    wait_for_x(listener, 2.0, 'box/l')


def test_unwatched_files_are_read_again_only_when_asked(start_bridge, file, start_listener):
    start_bridge('--ros-args', '-p', f'sdf_file:={file}', '-p', 'watch:=false'
                 ).wait_until_started()
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    replace(file, world(6))
    monitor = Monitor(listener)
    monitor.wait_for(DiagnosticStatus.OK)
    assert last_x(listener) == 1.0
    answer = reload(listener)
    assert answer.success, answer.message
    wait_for_x(listener, 6.0)
    replace(file, world(7))
    (result,) = set_parameters(listener, sdf_file=str(file))
    assert result.successful, result.reason
    wait_for_x(listener, 7.0)


def test_a_reload_that_fails_is_reported_at_once(start_bridge, file, start_listener):
    # Nobody looks at the file a second time.
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={file}', '-p', 'watch:=false'
                          ).wait_until_started()
    file.write_text('not XML')
    listener = start_listener()
    assert not reload(listener).success
    assert f'{file}:1: FILE_READ' in bridge.wait_for_line('FILE_READ')
    Monitor(listener).wait_for(DiagnosticStatus.ERROR)


def test_reloading_a_bad_file_answers_with_the_reason(bridge, file, start_listener):
    file.write_text('not XML')
    answer = reload(start_listener())
    assert not answer.success
    assert f'{file}:1: FILE_READ' in answer.message


def test_frames_that_are_gone_are_named(bridge, file):
    replace(file, world(1, name='box'))
    line = bridge.wait_for_line('no longer published')
    assert '"crate", "crate/body"' in line


def test_warnings_are_in_the_diagnostics(start_bridge, start_listener, file):
    light = """<model name="k"><link name="l">
      <light name="i" type="point"><pose relative_to="x"/></light></link></model>"""
    file.write_text(world(1, extra=light))
    start_bridge('--ros-args', '-p', f'sdf_file:={file}').wait_until_started()
    monitor = Monitor(start_listener())
    monitor.wait_for(DiagnosticStatus.WARN)


def test_everything_is_published_again_at_a_rate(start_bridge, start_listener, file):
    start_bridge('--ros-args', '-p', f'sdf_file:={file}', '-p', 'publish_rate:=20.0'
                 ).wait_until_started()
    listener = start_listener()
    listener.node.create_subscription(
        TFMessage, '/tf_static', listener.tf_messages.append, 10)
    listener.wait(lambda: len(listener.tf_messages) > 2, lambda: 'messages without latching')
    stamps = [(each.transforms[0].header.stamp.sec, each.transforms[0].header.stamp.nanosec)
              for each in listener.tf_messages[:3]]
    assert stamps == sorted(set(stamps))


def test_a_rate_can_be_set(bridge, start_listener):
    listener = start_listener()
    listener.node.create_subscription(
        TFMessage, '/tf_static', listener.tf_messages.append, 10)
    result, = set_parameters(listener, publish_rate=20.0)
    assert result.successful, result.reason
    listener.wait(lambda: len(listener.tf_messages) > 2, lambda: 'messages without latching')


def test_a_rate_that_is_not_reached_is_reported(start_bridge, file):
    frames = ''.join(f'<frame name="f{number}"/>' for number in range(5000))
    file.write_text(world(1, extra=frames))
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={file}', '-p', 'publish_rate:=100.0')
    bridge.wait_for_line('publish_rate 100.0 Hz is not reached: to publish everything takes ')


def test_a_rate_that_is_not_reached_keeps_nobody_from_changing_anything(
        start_bridge, start_listener, file):
    frames = ''.join(f'<frame name="f{number}"/>' for number in range(5000))
    replace(file, world(1, extra=frames))
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={file}', '-p', 'publish_rate:=100.0')
    bridge.wait_for_line('publish_rate 100.0 Hz is not reached')
    listener = start_listener()
    # It takes longer for a message than the bridge, so a queue would delay it.
    listen_to_tf(listener, depth=1)
    assert reload(listener).success
    replace(file, world(2, extra=frames))
    wait_for_x(listener, 2.0)
    result, = set_parameters(listener, publish_rate=0.0)
    assert result.successful, result.reason


def test_two_bridges_share_a_domain_by_prefixes(start_bridge, start_listener, file):
    for name in ('left', 'right'):
        start_bridge('--ros-args', '-r', f'__ns:=/{name}', '-p', f'sdf_file:={file}',
                     '-p', f'frame_prefix:={name}/').wait_until_started()
    listener = start_listener()
    listen_to_tf(listener)

    def children():
        return {each.child_frame_id for message in listener.tf_messages
                for each in message.transforms}
    listener.wait(lambda: len(children()) == 4, children)
    assert children() == {'left/crate', 'left/crate/body', 'right/crate', 'right/crate/body'}


def test_many_reloads_leave_nothing_behind(bridge, file, start_listener):
    listener = start_listener()

    def reload_often(times):
        for _ in range(times):
            answer = reload(listener)
            assert answer.success, answer.message

    def used():
        process = Path('/proc', str(bridge.pid))
        status = dict(line.split(':', 1) for line in (process / 'status').read_text().splitlines())
        return (int(status['VmRSS'].split()[0]), int(status['Threads']),
                len(list((process / 'fd').iterdir())))

    reload_often(10)
    memory, threads, files = used()
    reload_often(size(30, 1000))
    assert used()[0] - memory < 4096, 'kB more'
    # The thread of the last load may be about to end.
    listener.wait(
        lambda: used()[1] <= threads and used()[2] <= files,
        lambda: f'{threads} threads and {files} descriptors, there are {used()[1:]}')


def test_a_signal_during_a_reload_ends_it_well(bridge, file):
    models = ''.join(f'<model name="m{i}"><link name="l"/></model>' for i in range(30000))
    replace(file, world(1, extra=models))
    bridge.wait_until_handling(signal.SIGTERM)
    bridge.send(signal.SIGTERM)
    assert bridge.wait_for_end() == 0
    assert not any('Traceback' in line for line in bridge.lines)


def test_thousands_of_frames_have_no_topics_unless_asked_for(
        start_bridge, start_listener, tmp_path):
    path = tmp_path / 'large.sdf'
    path.write_text(world(1, extra=''.join(
        f'<frame name="f{number}"/>' for number in range(1200))))
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={path}')
    line = bridge.wait_for_line('no ~/poses/... topics')
    assert '1202 frames are more than 1000' in line
    listener = start_listener()
    listener.node.create_subscription(
        TransformStamped, '/sdf_pose_bridge/transforms',
        lambda message: listener.transforms.update({message.child_frame_id: message}),
        latched(2000))
    listener.wait(lambda: len(listener.transforms) == 1202, lambda: len(listener.transforms))
