# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose gz_bridge``: both files that it writes, and what is wrong."""

import pytest
from sdf_texts import joint, model, model_file, plugin, world_file

SENSORS = ('<sensor name="s" type="imu"><gz_frame_id>imu</gz_frame_id></sensor>'
           '<sensor name="l" type="lidar"/>')
CONTENT = (
    f'<link name="l">{SENSORS}</link><link name="k"/>'
    + joint('<parent>l</parent><child>k</child>', joint_type='revolute') + ''.join(
        f'<plugin filename="f" name="gz::sim::systems::{system}"/>'
        for system in ('JointStatePublisher', 'DiffDrive')))
ODD = 'a "b": #1 \u2028é'


@pytest.fixture(autouse=True)
def write_files(files):
    """The folder has a robot, and a world with two of it."""
    (files / 'robot.sdf').write_text(model_file(CONTENT))
    (files / 'two.sdf').write_text(world_file(''.join(
        f'<model name="{name}">{CONTENT}</model>' for name in 'ab')))
    odd = ODD.replace('"', '&quot;')
    (files / 'odd.sdf').write_text(world_file(f'<model name="{odd}">{CONTENT}</model>'))


@pytest.fixture
def parsed(run_main):
    """Run the command, and return the object in its output."""
    yaml = pytest.importorskip('yaml', reason='needs PyYAML')

    def run(*arguments):
        result = run_main('gz_bridge', *arguments)
        assert result.returncode == 0, result.stderr
        return yaml.safe_load(result.stdout)
    return run


def test_entries_have_the_keys_of_ros_gz_bridge(parsed):
    entries = parsed('two.sdf', '--only', 'joints,commands')
    assert entries[0] == {
        'ros_topic_name': '/clock', 'gz_topic_name': '/clock',
        'ros_type_name': 'rosgraph_msgs/msg/Clock', 'gz_type_name': 'gz.msgs.Clock',
        'direction': 'GZ_TO_ROS', 'lazy': False}
    assert [(each['ros_topic_name'], each['direction']) for each in entries[1:]] == [
        (f'/{name}/{topic}', direction) for name in 'ab' for topic, direction in (
            ('joint_states', 'GZ_TO_ROS'), ('cmd_vel', 'ROS_TO_GZ'), ('enable', 'ROS_TO_GZ'))]


def test_only_sensors_are_lazy(parsed):
    assert {each['gz_type_name'] for each in parsed('two.sdf') if each['lazy']} == {'gz.msgs.IMU'}


def test_a_topic_that_cannot_be_bridged_has_a_comment_with_the_reason(run_main):
    assert ('# /world/w/model/a/link/l/sensor/l/scan of gz.msgs.LaserScan: Gazebo sends nothing'
            in run_main('gz_bridge', 'two.sdf').stdout)


def test_plugins_with_topics_that_are_not_known_are_named(run_main, files):
    (files / 'lift.sdf').write_text(world_file(model('tower 1', (
        plugin('Elevator') + '<plugin filename="ignition-gazebo-track-controller-system" name=""/>'
        + plugin('Physics')))))
    assert run_main('gz_bridge', 'lift.sdf').stdout.endswith(
        'lazy: false\n# Elevator of "tower 1": add its topics\n'
        '# TrackController of "tower 1": add its topics\n')


def test_a_topic_of_several_robots_has_a_comment_that_names_them(run_main, files):
    shared = '<link name="l"><sensor name="s" type="imu"><topic>/i</topic></sensor></link>'
    (files / 'two.sdf').write_text(world_file(''.join(
        f'<model name="{name}">{shared}</model>' for name in 'ab')))
    assert ('# the topic /i belongs to "a::l::s", "b::l::s", so it has messages of all; give each '
            'a topic of its own in the file\n- ros_topic_name: "/i"'
            in run_main('gz_bridge', 'two.sdf').stdout)


def test_an_error_of_urdf_in_gazebo_has_the_name_of_the_file(run_main, files):
    (files / 'robot.urdf').write_text('<robot name="r"><link name="no_mass"/></robot>')
    done = run_main('gz_bridge', 'robot.urdf')
    assert done.returncode == 1
    assert '(included from robot.urdf in Gazebo:1)' in done.stderr


def test_sensors_of_urdf_are_in_the_links_that_gazebo_keeps(parsed, files):
    mass = ('<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
            '</inertial>')
    (files / 'robot.urdf').write_text(
        f'<robot name="r"><link name="a">{mass}</link><link name="b">{mass}</link>'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
        '<gazebo reference="b"><sensor name="s" type="imu"/></gazebo></robot>')
    _, imu = parsed('robot.urdf', '--world-name', 'w')
    assert imu['gz_topic_name'] == '/world/w/model/r/link/a/sensor/s/imu'


def test_robots_with_one_frame_id_are_told(run_main):
    assert ('sensor "b::l::s" and sensor "a::l::s" (line 1) would share the frame id "imu"'
            in run_main('gz_bridge', 'two.sdf').stderr)


@pytest.mark.parametrize(('arguments', 'is_told'), [([], True), (['--model-name', 'a'], False)])
def test_the_frame_id_of_a_link_elsewhere_is_told_unless_it_has_the_name_of_the_robot(
        run_main, files, arguments, is_told):
    sensor = ('<sensor name="s" type="gpu_lidar"><pose>1 0 0 0 0 0</pose><topic>scan</topic>'
              '<gz_frame_id>l</gz_frame_id></sensor>')
    (files / 'robot.sdf').write_text(model_file(f'<link name="l">{sensor}</link>'))
    errors = run_main('gz_bridge', 'robot.sdf', *arguments).stderr
    assert ('is that of a frame 1 m' in errors) is is_told


def test_any_name_is_quoted(parsed):
    assert parsed('odd.sdf', '--only', 'odometry')[1]['gz_topic_name'] == (
        f'/model/{ODD.replace(" ", "_")}/odometry')
    assert parsed('robot.sdf', '--world-name', ODD, '--model-name', ODD, '--node')['/**'][
        'ros__parameters']['model_name'] == ODD


def test_the_standard_input_is_no_file_of_the_node(run_main):
    result = run_main('gz_bridge', '-', '--node', stdin='two.sdf')
    assert result.stdout.startswith('/**:\n  ros__parameters:\n    use_sim_time: true\n')


def test_a_file_without_a_model_has_the_topic_of_the_clock_alone(run_main, parsed, files):
    (files / 'empty.sdf').write_text('<sdf version="1.9"/>')
    assert [each['ros_topic_name'] for each in parsed('empty.sdf')] == ['/clock']
    assert 'model_name' not in run_main('gz_bridge', 'empty.sdf', '--node').stdout


def test_output_is_written_to_a_file(run_main, files):
    printed = run_main('gz_bridge', 'two.sdf').stdout
    assert run_main('gz_bridge', 'two.sdf', '-o', 'a.yaml').stdout == ''
    assert (files / 'a.yaml').read_text() == printed


@pytest.mark.parametrize(('arguments', 'models'), [
    (['two.sdf'], ['a', 'b']),
    (['odd.sdf'], [ODD]),
    (['robot.sdf', '--world-name', 'w', '--model-name', 'm-1', '--skip-missing', '-I', '.'],
     ['m-1']),
])
def test_the_node_follows_the_topics_that_are_bridged(parsed, files, arguments, models):
    pytest.importorskip('rclpy', reason='needs ROS 2')
    from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
    from sdf_pose_bridge.ros.parameters.given import settings_from_values
    from sdf_pose_bridge.ros.publishing.topic_names import state_topics_from_settings
    parameters = parsed(*arguments, '--node')['/**']['ros__parameters']
    assert parameters['sdf_file'] == str(files / arguments[0])
    assert parameters.pop('use_sim_time') is True
    settings = settings_from_values(
        {**parameters, 'kinds': ['link'], 'publish_frequency': 1.0})
    loaded = loaded_scene_from_request(settings.load_request)
    topics = state_topics_from_settings(
        settings, loaded.tree, loaded.joint_positions, lambda name: name)
    bridged = {each['ros_topic_name'] for each in parsed(*arguments)}
    assert topics.warnings == ()
    assert [*topics.joint_states.values()] == [*topics.model_poses.values()] == models
    assert {*topics.joint_states, *topics.model_poses} <= bridged


def test_commands_of_velocity_show_the_stamped_type(run_main):
    output = run_main('gz_bridge', 'two.sdf', '--only', 'commands').stdout
    assert ('  ros_type_name: geometry_msgs/msg/Twist\n'
            '  # ros_type_name: geometry_msgs/msg/TwistStamped\n') in output


BURGER = ('<link name="base_footprint">{}</link><plugin filename="f" '
          'name="gz::sim::systems::DiffDrive"><child_frame_id>base_footprint</child_frame_id>'
          '</plugin>')
BURGER_URDF = (
    '<robot name="r"><link name="l"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" '
    'ixy="0" ixz="0" iyz="0"/></inertial></link>'
    f'<gazebo reference="l">{SENSORS}</gazebo></robot>')
BURGER_NAME = ['--model-name', 'burger', '--world-name', 'w']


@pytest.mark.parametrize(('text', 'arguments', 'told'), [
    (model_file(BURGER.format('')), [], ''),
    (model_file(BURGER.format('')), BURGER_NAME,
     '"base_footprint", which is none of the node; did you mean "burger/base_footprint"?'),
    (model_file(f'<link name="l">{SENSORS}</link>'), BURGER_NAME, ''),
    (BURGER_URDF, BURGER_NAME, '/link/l/sensor/s/imu have the frame id "imu", which is none'),
])
def test_frame_ids_that_the_node_does_not_publish_are_told(
        run_main, files, text, arguments, told):
    (files / 'robot.sdf').write_text(text)
    errors = run_main('gz_bridge', 'robot.sdf', *arguments).stderr
    assert told in errors
    assert errors.count('none of the node') == bool(told)
