# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge beside a real Gazebo, with the parameters of ``sdf_pose gz_bridge --node``."""

from fnmatch import fnmatch
import itertools
from typing import NamedTuple

from deadline import wait_until
from gazebo import environment_of_gazebo, Gazebo, gazebo_world, plugin, pose_from_messages
import needs
import pytest

from sdf_pose_bridge import load
from sdf_pose_bridge.geometry.poses import distance_and_angle, Pose, pose_inverse, pose_product
from sdf_pose_bridge.sdformat.poses import EULER_RPY, pose_from_text


def elements(**values):
    """Return ``<name>value</name>`` for each value; several for a list, none for None."""
    return ''.join(
        f'<{name}>{each}</{name}>' for name, value in values.items()
        for each in (value if isinstance(value, list) else [value]) if each is not None)


def link(name, pose='0 0 0 0 0 0', shape='<box><size>0.1 0.1 0.1</size></box>', gravity=1):
    inertia = elements(ixx=0.01, iyy=0.01, izz=0.01)
    return (f'<link name="{name}"><pose>{pose}</pose><gravity>{gravity}</gravity><inertial><mass>1'
            f'</mass><inertia>{inertia}</inertia></inertial><collision name="c"><geometry>{shape}'
            '</geometry></collision></link>')


def hinge(child, parent='base', axis='0 0 1', kind='revolute'):
    return (f'<joint name="of_{child.partition(":")[0]}" type="{kind}"><parent>{parent}</parent>'
            f'<child>{child}</child><axis><xyz>{axis}</xyz></axis></joint>')


def wheels(*names, steered=''):
    """Return a base with wheels at its corners: ``fl``, ``fr``, ``bl`` and ``br``."""
    found = link('base') + JOINTS
    for name in names:
        place = f'{0.15 if "f" in name else -0.15} {0.2 if "l" in name else -0.2} 0'
        found += link(name, f'{place} -1.5707963267948966 0 0',
                      '<cylinder><radius>0.1</radius><length>0.05</length></cylinder>')
        found += hinge(name, f's{name}' if name in steered else 'base')
        if name in steered:
            found += link(f's{name}', f'{place} 0 0 0') + hinge(f's{name}')
    return found


def flying(*plugins, arm=True):
    """Return the content of a model without weight, which flies and turns by ``cmd_vel``."""
    return ''.join((
        link('base', '0.1 0.2 0.3 0.4 0.5 0.6', gravity=0), plugin('VelocityControl'), *plugins,
        arm * (link('arm', '0.5 0 0 0.3 0 0', gravity=0) + hinge('arm', axis='0 1 1') + JOINTS
               + plugin('JointController', elements(joint_name='of_arm')))))


def odometry(**values):
    return plugin('OdometryPublisher', elements(**values))


class Robot(NamedTuple):
    """A model, and the pose that its frame is to have in TF."""

    content: str
    source: str = 'true'
    """``true``, ``flat`` at height zero, ``none`` (as in the file), ``unsent`` by Fortress, or
    ``wheels`` of it or of a model in it."""
    height: float = 3.0


JOINTS = plugin('JointStatePublisher')
SIZES = elements(
    wheel_separation=0.4, kingpin_width=0.4, wheel_radius=0.1, wheel_base=0.3, wheelbase=0.3)
ALL_POSES = elements(publish_model_pose=1, publish_nested_model_pose=1, use_pose_vector_msg=1)
DIFF = wheels('fl', 'fr') + plugin(
    'DiffDrive', SIZES + elements(left_joint='of_fl', right_joint='of_fr'))
DRIVES = {
    'diff': Robot(DIFF, 'wheels', 0.1),
    'ackermann': Robot(wheels('fl', 'fr', 'bl', 'br', steered='fl fr') + plugin(
        'AckermannSteering', SIZES + elements(
            left_joint=['of_fl', 'of_bl'], right_joint=['of_fr', 'of_br'], frame_id='start',
            left_steering_joint='of_sfl', right_steering_joint='of_sfr')), 'wheels', 0.1),
    # Fortress, and Harmonic before 8.10, offer its odometry, but send none.
    'mecanum': Robot(wheels('fl', 'fr', 'bl', 'br') + plugin('MecanumDrive', SIZES + elements(
        front_left_joint='of_fl', front_right_joint='of_fr', back_left_joint='of_bl',
        back_right_joint='of_br')) + plugin('PosePublisher', ALL_POSES), height=0.1),
}
SOURCES = {
    'flat': Robot(flying(odometry()), 'flat'),
    'full': Robot(flying(odometry(dimensions=3))),
    'named': Robot(flying(odometry(
        dimensions=3, odom_frame='a::b', robot_base_frame='x', odom_topic='/o'))),
    'shifted': Robot(flying(odometry(
        dimensions=3, xyz_offset='0.3 0.1 0.2', rpy_offset='0.5 0.4 0.3',
        xyz_global_offset='3 2 1', rpy_global_offset='0.1 0.2 0.3'))),
    'every': Robot(flying(plugin('PosePublisher', ALL_POSES + elements(
        publish_visual_pose=1, publish_collision_pose=1, publish_sensor_pose=1)))),
    # Fortress, and Harmonic before 8.10, need both options for the pose of the model.
    'rather': Robot(flying(odometry(dimensions=3), plugin(
        'PosePublisher', elements(publish_model_pose=1, use_pose_vector_msg=1)))),
    **{f'posed{number}': Robot(
        flying(plugin('PosePublisher', elements(
            publish_nested_model_pose=nested, publish_model_pose=model, use_pose_vector_msg=vector,
            static_publisher=static, update_frequency=20)), arm=static),
        'true' if nested and model != 0 else 'unsent' if model else 'none')
        for number, (nested, model, vector, static) in enumerate(
            itertools.product((0, 1), (None, 0, 1), (0, 1), (0, 1)))},
}
TRAILER = '<model name="t"><pose>-0.5 0 0.1 0 0.2 0</pose>' + link('box', gravity=0) + (
    '</model>') + plugin('PosePublisher', ALL_POSES)
PLACES = {
    'two': Robot(DIFF + odometry(dimensions=3, odom_topic='/o'), height=0.1),
    # Fortress has another default name of the topic of joints in a nested model.
    'wrapper': Robot(
        '<model name="in"><pose>0.2 0.1 0 0 0 0.5</pose>' + DIFF.replace(
            JOINTS, plugin('JointStatePublisher', '<topic>/j</topic>')) + '</model>',
        'wheels::in', 0.1),
    'truck': Robot(flying(TRAILER, hinge('t::box'), plugin(
        'JointPositionController', elements(joint_name='of_t', topic='/tow', p_gain=9)))),
    'boat': Robot(flying(TRAILER, link('hat', gravity=0), hinge('hat', kind='fixed'))),
    **{name: Robot('<uri>robot.sdf</uri><placement_frame>grip</placement_frame>', 'wheels', 0.3)
       for name in ('twin1', 'twin2')},
}
MIXED = {
    'cart': Robot(DIFF, 'wheels', 0.1),
    'arm 1': Robot(flying(odometry(dimensions=3))),
    'carrier': Robot(flying(TRAILER)),
    'crate': Robot(link('box'), 'none'),
    'gate': Robot(link('post') + link('bar', '1 0 0 0 0 0') + hinge('bar', 'post'), 'none'),
    'wall': Robot('<static>true</static>' + link('l'), 'none'),
}
LEFT_OUT = {
    '/world/shop/clock': 'the same as /clock',
    '/world/shop/*pose/info': 'poses without frame ids',
    '/model/*/tf': 'frames that the node publishes',
    **dict.fromkeys(
        ('/gazebo/resource_paths', '/stats', '/world/shop/scene/*', '/world/shop/stat*'),
        'for programs of Gazebo')}


def shifted(topic, pose):
    """Add the offsets, which Fortress does not know (OdometryPublisher.cc:402 of gz-sim 10)."""
    if not topic.startswith('/shifted/'):
        return pose
    offset, of_frame = (pose_from_text(each, EULER_RPY)[0] for each in (
        '0.3 0.1 0.2 0.5 0.4 0.3', '3 2 1 0.1 0.2 0.3'))
    return pose_product(pose_inverse(of_frame), pose_product(pose, offset))


@pytest.fixture
def start_gazebo(start_listener, start_bridge, monkeypatch, tmp_path):
    """Starts Gazebo with robots, and the bridge; ``start_gazebo(robots, *file)``."""
    needs.gazebo()
    for name, value in environment_of_gazebo(tmp_path).items():
        monkeypatch.setenv(name, value)
    monkeypatch.chdir(tmp_path)  # Gazebo finds included files there
    listener, made = start_listener(), []

    def start(robots, *file):
        frame = '<frame name="{}"><pose>{}</pose></frame>'.format
        (tmp_path / 'robot.sdf').write_text(
            f'<sdf version="1.9"><model name="robot">{frame("grip", "0 0 0.2 0 0 0.1")}{DIFF}'
            '</model></sdf>')
        text = frame('stand', '1 -5 0 0 0 0.3')
        for number, (name, each) in enumerate(robots.items()):
            pose = f'{2 * number} {number % 3} {each.height} 0 0 {number / 10 + 1}</pose>'
            text += (
                f'<include>{each.content}<name>{name}</name><pose relative_to="stand">{pose}'
                '</include>' if 'uri' in each.content else
                f'<model name="{name}"><pose>{pose}{each.content}</model>')
        (tmp_path / 'shop.sdf').write_text(gazebo_world(text))
        made.append(Gazebo(tmp_path / 'shop.sdf', listener, *file, change=shifted))
        made[-1].bridge = start_bridge('--ros-args', '--params-file', made[-1].node_file)
        made[-1].bridge.wait_until_started()
        return made[-1]

    yield start
    for each in made:
        each.end()


def in_world(poses, name):
    outer = name.rpartition('::')[0]
    return pose_product(in_world(poses, outer), poses[name]) if outer else poses[name]


def shift_in_tf(gazebo, scene, model, source, stamp_ns, poses):
    """Return where a model in TF has the origin of Gazebo; None if no message says that."""
    if not source.startswith('wheels'):
        return Pose(z=-poses[model].z) if source == 'flat' else Pose()
    driven = source.replace('wheels', model)
    sent = gazebo.sent[f'/{driven.replace("::", "/")}/odometry'].get(stamp_ns)
    return sent and pose_product(pose_product(scene.pose(driven), pose_from_messages(
        sent[0].pose.pose.position, sent[0].pose.pose.orientation)), pose_inverse(
            in_world(poses, driven)))


def check_frames(gazebo, robots):
    """Drive until all frames have moved; compare TF with the true poses at each stamp."""
    scene, found, missing = load(gazebo.world), {}, set()

    def are_complete():
        found.clear()
        for stamp_ns, poses in gazebo.true_poses():
            for name in poses:
                model = name.partition('::')[0]
                source = robots[model].source
                if source == 'none' and name.endswith('::arm'):
                    continue  # its joint moves it in TF, and the model too in Gazebo
                shift = shift_in_tf(gazebo, scene, model, source, stamp_ns, poses)
                in_tf = gazebo.pose_in_tf(name.replace('::', '/'), stamp_ns)
                if in_tf is None or shift is None:
                    missing.update([name] if source != 'unsent' else [])
                    continue
                assert source != 'unsent', name
                expected = scene.pose(name) if source == 'none' else (
                    pose_product(shift, in_world(poses, name)))
                difference = max(distance_and_angle(in_tf, expected))
                # Gazebo keeps each pose until a number changes by 1e-6 (Physics.cc:353).
                assert difference < 5e-6, (name, in_tf, expected)
                start, *last = found.get(name, (expected, 0, 0, 0))
                new = difference, *distance_and_angle(start, expected)
                found[name] = start, *map(max, last, new)
        joints = [[*sent.values()][-1][0].position for topic, sent in [*gazebo.sent.items()]
                  if topic.endswith('/joint_states')]
        return found and missing <= found.keys() and all(
            max(way) > 0.2 or robots[name.partition('::')[0]].source == 'none'
            for name, (_, _, *way) in found.items()) and all(
            max(map(abs, each)) > 0.02 for each in joints)

    wait_until(are_complete, lambda: gazebo.drive(0.4), lambda: f'{missing} {found}')
    stamps = {stamp_ns for sent in [*gazebo.sent.values()] for stamp_ns in [*sent]}
    for each in gazebo.stamps.values():
        assert each == sorted(set(each))
        assert stamps.issuperset(each)


@pytest.mark.parametrize('robots', [DRIVES, SOURCES, PLACES, MIXED], ids=[
    'drives', 'sources', 'places', 'mixed'])
def test_frames_are_where_gazebo_has_them(start_gazebo, robots):
    gazebo = start_gazebo(robots)
    check_frames(gazebo, robots)
    written = {
        each['gz_topic_name']: each['gz_type_name'].partition('gz.')[2] for each in gazebo.entries}
    written['/world/shop/dynamic_pose/info'] = 'msgs.Pose_V'
    assert gazebo.types.items() <= written.items()
    # Fortress has no odometry with covariances, and does not tell which commands it receives.
    wanted = {each['gz_topic_name'] for each in gazebo.entries if each['direction'] == 'GZ_TO_ROS'
              and not each['gz_topic_name'].endswith('_with_covariance')}
    wait_until(lambda: wanted <= gazebo.topics(), what=wanted)
    assert [each for each in gazebo.topics() - written.keys() if not any(
        fnmatch(each, pattern) for pattern in LEFT_OUT)] == []
    unsent = [name for name, each in robots.items() if each.source == 'unsent']
    assert [line for line in gazebo.bridge.lines
            if '[WARN]' in line and 'white space' not in line
            and not any(f' /{name}/' in line for name in unsent)] == []
    # Nothing waits for messages that never come.
    late = [line for line in gazebo.bridge.lines if 'has come yet' in line or 'has named' in line]
    wait_until(lambda: not late or unsent or any(
        'have been reported now' in line for line in gazebo.bridge.lines), what=late)


def test_time_stops_crawls_and_jumps_back(start_gazebo):
    robots = {name: SOURCES[name] for name in ('full', 'posed14')}
    gazebo = start_gazebo(robots)
    check_frames(gazebo, robots)
    gazebo.call('control', 'WorldControl', 'pause: true')
    joints = gazebo.sent['/full/joint_states']
    gazebo.wait(lambda: len([*joints.values()][-1]) > 1000, 'ten seconds without time')
    gazebo.call('set_physics', 'Physics', 'max_step_size: 0.01 real_time_factor: 0.1')
    gazebo.call('control', 'WorldControl', 'pause: false')
    gazebo.forget()
    check_frames(gazebo, robots)
    gazebo.call('set_physics', 'Physics', 'max_step_size: 0.01 real_time_factor: 1')
    gazebo.call('control', 'WorldControl', 'reset: {all: true}')
    gazebo.wait(lambda: all(each != sorted(each) for each in gazebo.stamps.values()), 'a reset')
    gazebo.forget()
    check_frames(gazebo, robots)


def test_a_model_is_removed_and_created_again(start_gazebo, tmp_path):
    file = tmp_path / 'model.sdf'
    file.write_text('<sdf version="1.9"><model name="robot">' + link('base') + plugin(
        'PosePublisher', ALL_POSES) + '</model></sdf>')
    gazebo = start_gazebo({}, file, '--model-name', 'robot_2', '--world-name', 'shop')
    for x in (3.0, 5.0):
        gazebo.call('create', 'EntityFactory', (
            f'sdf_filename: "{file}" name: "robot_2" pose {{position {{x: {x} z: 200}}}}'))
        gazebo.wait(lambda x=x: gazebo.stamps and gazebo.pose_in_tf(
            'robot_2', gazebo.stamps['robot_2/base'][-1]).x == x, f'x = {x}')
        gazebo.forget()
        check_frames(gazebo, {'robot_2': Robot('')})
        gazebo.call('remove', 'Entity', 'name: "robot_2" type: MODEL')
