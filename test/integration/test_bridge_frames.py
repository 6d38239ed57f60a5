# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Frames of a running bridge, received by another process.

What is expected is worked out here, from the numbers in the file, with matrices and by the rules
for TF parents; nothing of the package takes part.
"""

from matrices import assert_same_pose, matrix_from_degrees, OPTICAL
import numpy as np
import pytest

FILE = """\
<sdf version="1.10">
  <world name="hall">
    <model name="table">
      <static>true</static>
      <pose degrees="true">1 2 0 0 0 90</pose>
      <link name="top"><pose>0.5 0 0.7 0 0 0</pose></link>
    </model>
    <frame name="corner"><pose>-3 -2 0 0 0 0</pose></frame>
    <model name="robot">
      <pose>0 0 1 0 0 0</pose>
      <link name="base">
        <sensor name="eye" type="camera">
          <pose degrees="true">0.2 0 0.3 0 30 0</pose>
          <camera/>
        </sensor>
      </link>
      <model name="arm">
        <pose degrees="true">1 0 0 90 0 0</pose>
        <link name="hand"><pose>0 0 0.5 0 0 0</pose></link>
      </model>
      <joint name="shoulder" type="revolute">
        <parent>base</parent><child>arm::hand</child><axis><xyz>0 0 1</xyz></axis>
      </joint>
      <frame name="left grip-1" attached_to="arm::hand">
        <pose degrees="true">0.1 0 0 0 0 180</pose>
      </frame>
    </model>
  </world>
</sdf>
"""

TABLE = matrix_from_degrees(1, 2, 0, 0, 0, 90)
TOP = TABLE @ matrix_from_degrees(0.5, 0, 0.7)
BASE = matrix_from_degrees(0, 0, 1)
EYE = BASE @ matrix_from_degrees(0.2, 0, 0.3, 0, 30, 0)
ARM = BASE @ matrix_from_degrees(1, 0, 0, 90, 0, 0)
HAND = ARM @ matrix_from_degrees(0, 0, 0.5)

PARENTS_AND_POSES = {
    'table/top': ('world', TOP),
    'table': ('table/top', TABLE),
    'corner': ('world', matrix_from_degrees(-3, -2, 0)),
    'robot/base': ('world', BASE),
    'robot': ('robot/base', BASE),
    'robot/base/eye': ('robot/base', EYE),
    'robot/base/eye_optical': ('robot/base/eye', EYE @ OPTICAL),
    'robot/arm/hand': ('robot/base', HAND),
    'robot/arm': ('robot/arm/hand', ARM),
    'robot/left grip-1': ('robot/arm/hand', HAND @ matrix_from_degrees(0.1, 0, 0, 0, 0, 180)),
}
TOPICS = {
    frame: f'/sdf_pose_bridge/poses/{frame}'.replace(
        'left grip-1', 'left_x20_grip_x2d_1') for frame in PARENTS_AND_POSES
}
TF_MESSAGE_HASH = 'RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087'


@pytest.fixture(scope='module')
def sdf_file(tmp_path_factory):
    path = tmp_path_factory.mktemp('frames') / 'hall.sdf'
    path.write_text(FILE)
    return path


@pytest.fixture(scope='module')
def listeners(start_shared_bridge, start_shared_listener, sdf_file):
    """A listener that was there before the bridge, and one that comes when it has published."""
    def start():
        listener = start_shared_listener()
        listener.listen_to_frames()
        listener.listen_to_poses(TOPICS.values())
        return listener

    early = start()
    start_shared_bridge(sdf_file=sdf_file).wait_until_started()
    return {'early': early, 'late': start()}


@pytest.fixture(params=['early', 'late'])
def listener(request, listeners):
    return listeners[request.param]


@pytest.fixture
def late_listener(listeners):
    return listeners['late']


def assert_expected_transforms(transforms):
    """Check messages against the table, none missing and none too many."""
    assert {
        each.child_frame_id: each.header.frame_id for each in transforms
    } == {frame: parent for frame, (parent, _) in PARENTS_AND_POSES.items()}
    for each in transforms:
        parent, pose = PARENTS_AND_POSES[each.child_frame_id]
        parent_pose = PARENTS_AND_POSES.get(parent, (None, np.eye(4)))[1]
        xyz, quat = each.transform.translation, each.transform.rotation
        assert_same_pose(
            (xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w),
            np.linalg.inv(parent_pose) @ pose, name=each.child_frame_id)


def test_tf_static_has_every_transform_in_one_message(listener):
    listener.wait(lambda: listener.tf_messages, '/tf_static')
    (message,) = listener.tf_messages
    assert len(message.transforms) == len(PARENTS_AND_POSES)
    assert_expected_transforms(message.transforms)


def test_they_are_those_of_the_one_message_with_its_stamp(listener):
    listener.wait(lambda: listener.tf_messages, '/tf_static')
    listener.wait_for_keys(listener.transforms, PARENTS_AND_POSES)
    (message,) = listener.tf_messages
    assert {each.child_frame_id: each for each in message.transforms} == listener.transforms


def test_every_frame_has_its_pose_in_the_root_frame(listener):
    listener.wait_for_keys(listener.poses, TOPICS.values())
    for frame, (_, pose) in PARENTS_AND_POSES.items():
        message = listener.poses[TOPICS[frame]]
        assert message.header.frame_id == 'world'
        xyz, quat = message.pose.position, message.pose.orientation
        assert_same_pose(
            (xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w), pose, name=frame)


def test_the_type_of_tf_static_is_the_one_on_every_ros_machine(late_listener):
    late_listener.wait(lambda: late_listener.tf_messages, '/tf_static')
    (publisher,) = late_listener.node.get_publishers_info_by_topic('/tf_static')
    assert publisher.topic_type == 'tf2_msgs/msg/TFMessage'
    assert str(publisher.topic_type_hash) == TF_MESSAGE_HASH


def test_models_that_are_not_anchored_still_have_poses(start_bridge, start_listener, sdf_file):
    bridge = start_bridge(sdf_file=sdf_file, anchor_models='static')
    bridge.wait_for_line('no transform to "robot/base", the root of its tree')
    listener = start_listener()
    listener.listen_to_frames()
    listener.listen_to_poses(TOPICS.values())
    listener.wait_for_keys(listener.poses, TOPICS.values())
    listener.wait_for_keys(listener.transforms, PARENTS_AND_POSES.keys() - {'robot/base'})
    listener.wait(lambda: listener.tf_messages, '/tf_static')
    (message,) = listener.tf_messages
    assert 'robot/base' not in {each.child_frame_id for each in message.transforms}
    xyz = listener.poses[TOPICS['robot/base']].pose.position
    assert (xyz.x, xyz.y, xyz.z) == (0.0, 0.0, 1.0)


def test_names_root_and_topics_follow_the_parameters(start_bridge, start_listener, sdf_file):
    start_bridge(
        '--ros-args', '-r', '__ns:=/left', sdf_file=sdf_file, root_frame='map',
        frame_prefix='left_', frame_separator='.', model='robot::arm', pose_topics=['*hand'])
    listener = start_listener()
    listener.listen_to_frames('/left/sdf_pose_bridge')
    topic = '/left/sdf_pose_bridge/poses/left_robot_x2e_arm_x2e_hand'
    listener.listen_to_poses([topic])
    listener.wait_for_keys(listener.poses, [topic])
    assert listener.poses[topic].header.frame_id == 'map'
    listener.wait_for_keys(listener.transforms, ['left_robot.arm', 'left_robot.arm.hand'])
    assert len(listener.transforms) == 2
