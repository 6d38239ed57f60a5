# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a running bridge notices, what it replaces, and what it keeps when something is wrong."""

from changes import (
    BRIDGE,
    listen_to_tf,
    Monitor,
    reload,
    replace,
    set_parameters,
    wait_for_x,
    world,
)
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped, TransformStamped
from listener import latched
import pytest

INCLUDING = """<sdf version="1.10"><world name="w">
  <include><uri>model://box</uri></include>
</world></sdf>"""


def box(x, name='box'):
    return (f'<sdf version="1.10"><model name="{name}">'
            f'<link name="l"><pose>{x} 0 0 0 0 0</pose></link></model></sdf>')


def config(file):
    return f'<model><name>box</name><sdf version="1.10">{file}</sdf></model>'


def listen_to_transforms(listener, quality):
    """Keep the x of each transform that arrives one by one."""
    found = []
    listener.node.create_subscription(
        TransformStamped, f'{BRIDGE}/transforms',
        lambda message: found.append((message.child_frame_id, message.transform.translation.x)),
        quality)
    return found


# What was published is really replaced


def test_a_moved_frame_is_moved_on_every_topic(file, listener):
    transforms = listen_to_transforms(listener, latched(10))
    places = []
    listener.node.create_subscription(
        PoseStamped, f'{BRIDGE}/poses/crate/body',
        lambda message: places.append(message.pose.position.x), latched(10))
    listener.wait(lambda: transforms and places, 'what was published before')
    replace(file, world(2))
    wait_for_x(listener, 2.0)
    listener.wait(lambda: ('crate/body', 2.0) in transforms, transforms)
    listener.wait(lambda: places[-1:] == [2.0], places)


@pytest.mark.parametrize(('new', 'expected'), [
    (world(2, 'box'), {('box/body', 2.0), ('box', 0.0)}),
    (world(2, extra='<frame name="f"/>'), {('crate/body', 2.0), ('crate', 0.0), ('f', 0.0)}),
    ('<sdf version="1.10"><world name="w"><frame name="f"/></world></sdf>', {('f', 0.0)}),
    ('<sdf version="1.10"><world name="w"/></sdf>', set()),
], ids=['as many', 'more', 'fewer', 'none'])
def test_a_late_listener_gets_nothing_of_what_was_before(
        bridge, file, listener, start_listener, new, expected):
    # A file that is read just after its change would be published a second time.
    set_parameters(listener, watch=False)
    replace(file, new)
    assert reload(listener).success
    late = start_listener()
    transforms = listen_to_transforms(late, latched(100))
    listen_to_tf(late)
    late.wait(lambda: late.tf_messages and expected <= set(transforms), transforms)
    set_parameters(late, watch=False)  # by the answer, whatever came with the rest is here
    assert sorted(transforms) == sorted(expected)
    assert {each.child_frame_id for each in late.tf_messages[0].transforms} == {
        frame for frame, _ in expected}


def test_topics_of_frames_come_and_go_with_them_and_with_the_patterns(bridge, file, listener):
    def topics():
        prefix = f'{BRIDGE}/poses/'
        names = [name for name, _ in listener.node.get_topic_names_and_types()]
        return {name[len(prefix):] for name in names if name.startswith(prefix)}

    def wait_for_topics(*expected):
        listener.wait(lambda: topics() == set(expected), topics)

    wait_for_topics('crate', 'crate/body')
    replace(file, world(1, 'box'))
    wait_for_topics('box', 'box/body')
    set_parameters(listener, pose_topics=['*/body'])
    wait_for_topics('box/body')
    set_parameters(listener, pose_topics=['box::*', 'box'])
    wait_for_topics('box')
    bridge.wait_for_line('no ~/poses/... topics for "box::*" in pose_topics')
    set_parameters(listener, pose_topics=['*'])
    wait_for_topics('box', 'box/body')


def test_a_frame_that_loses_its_transform_alone_is_named(bridge, listener):
    set_parameters(listener, anchor_models='none')
    line = bridge.wait_for_line('1 frame without a parent now')
    assert line.endswith('restarted: "crate/body"')
    assert not any('no longer published' in each for each in bridge.lines)


# What is noticed


def test_a_broken_file_is_reported_and_its_repair_is_noticed(bridge, file, listener):
    monitor = Monitor(listener)
    monitor.wait_for(DiagnosticStatus.OK)
    text = world(8)
    with file.open('w') as half:
        half.write(text[:40])
        half.flush()
        monitor.wait_for(DiagnosticStatus.ERROR)
        assert f'{file}:2: FILE_READ' in monitor.status.message
        bridge.wait_for_line('the frames published before stay')
        assert len(listener.tf_messages) == 1
        half.write(text[40:])
    wait_for_x(listener, 8.0)
    monitor.wait_for(DiagnosticStatus.OK)


def test_an_include_is_found_once_it_appears_is_mended_or_named_anew(
        bridge, file, listener, tmp_path):
    set_parameters(listener, resource_paths=[str(tmp_path)])
    replace(file, INCLUDING)
    bridge.wait_for_line('URI_LOOKUP')
    new = tmp_path / 'new'
    new.mkdir()
    (new / 'model.config').write_text(config('a.sdf'))
    (new / 'a.sdf').write_text('<sdf')
    new.rename(tmp_path / 'box')
    bridge.wait_for_line('box/a.sdf:1: FILE_READ')
    replace(tmp_path / 'box/a.sdf', box(2))
    wait_for_x(listener, 2.0, 'box/l')
    (tmp_path / 'box/b.sdf').write_text(box(3))
    replace(tmp_path / 'box/model.config', config('b.sdf'))
    wait_for_x(listener, 3.0, 'box/l')


def test_simulated_time_that_stands_still_keeps_no_change_from_being_noticed(file, listener):
    set_parameters(listener, use_sim_time=True)
    replace(file, world(2))
    wait_for_x(listener, 2.0)
    Monitor(listener).wait_for(DiagnosticStatus.OK)
