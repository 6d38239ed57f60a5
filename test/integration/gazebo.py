# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A real Gazebo Fortress, and what ros_gz_bridge makes of its messages."""

from collections import defaultdict
import importlib
import json
from pathlib import Path
import re
import subprocess
import sys
import threading

from bridge_process import LoggedProcess
from builtin_interfaces.msg import Time
from command_line import COMMAND, completed, ENVIRONMENT
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3
from listener import latched
from nav_msgs.msg import Odometry
from processes import started
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
import yaml

from sdf_pose_bridge.geometry.poses import Pose, pose_product

FOLDER = Path(sys.prefix, 'gazebo')
TOOL = '/usr/libexec/ignition/transport11/ign-transport-{}'.format
POSES = '/world/shop/dynamic_pose/info'


def environment_of_gazebo(folder):
    """Return the variables for the processes of a world in a folder of its own."""
    return {'IGN_IP': '127.0.0.1', 'IGN_PARTITION': str(folder).replace('/', '_'),
            'IGN_GAZEBO_SYSTEM_PLUGIN_PATH': str(FOLDER / 'lib')}


def plugin(system, content=''):
    library = re.sub('(?<=[a-z])(?=[A-Z])', '-', system).lower()
    return (f'<plugin filename="libignition-gazebo-{library}-system.so" '
            f'name="ignition::gazebo::systems::{system}">{content}</plugin>')


def gazebo_world(content):
    """Return a world with a floor and 100 steps in a second, and with all poses of each step."""
    engine = '<engine><filename>libignition-physics5-dartsim-plugin.so.5</filename></engine>'
    return f"""<sdf version="1.9"><world name="shop">
<physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>
{plugin('Physics', engine)}{plugin('UserCommands')}
{plugin('SceneBroadcaster', '<dynamic_pose_hertz>1000</dynamic_pose_hertz>')}
<model name="floor"><static>true</static><link name="l"><collision name="c"><geometry>
<plane><normal>0 0 1</normal><size>100 100</size></plane></geometry></collision></link></model>
{content}</world></sdf>"""


class Gazebo:
    """
    A running world, ``shop``, whose messages go to ROS as ``sdf_pose gz_bridge`` says, and TF.

    :param world: its file.
    :param file: the file, and options, for ``sdf_pose gz_bridge``.
    :param change: changes the poses of odometry, by the names of topics in ROS.
    """

    def __init__(self, world, listener, *file, change=lambda topic, pose: pose):
        self.world, self._listener, self._change = world, listener, change
        config, parameters = (completed(
            [*COMMAND, 'gz_bridge', *(file or [world]), *option], env=ENVIRONMENT).stdout
            for option in ([], ['--node']))
        self.node_file = world.with_suffix('.yaml')
        self.node_file.write_text(parameters)
        self.entries = yaml.safe_load(config)
        self.now, self._names, self._fixed = -1.0, {}, {}
        self.sent = defaultdict(lambda: defaultdict(list))  # by topics in ROS and stamps in ns
        self.types = {}  # by topics in Gazebo
        self._publishers = {}
        for each in self.entries:
            if each['direction'] == 'GZ_TO_ROS':
                package, _, kind = each['ros_type_name'].split('/')
                self._publishers[each['gz_topic_name']] = listener.node.create_publisher(
                    getattr(importlib.import_module(f'{package}.msg'), kind),
                    each['ros_topic_name'], 10)
        listener.node.create_subscription(TFMessage, '/tf', self._take, 1000)
        listener.node.create_subscription(
            TFMessage, '/tf_static', lambda message: self._fixed.update(_by_child(message)),
            latched(100))
        self.forget()
        self._topics = started(
            [FOLDER / 'bin/gazebo_topics', *self._publishers, POSES],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.server = LoggedProcess([FOLDER / 'bin/gazebo_server', world, 0, 1])
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def forget(self):
        """Forget the poses in Gazebo and in TF."""
        self._poses = {}  # by stamps in ns and numbers of models and links
        self._moved = defaultdict(dict)  # by stamps in ns and frames
        self.stamps = defaultdict(list)  # in ns, by frames

    def end(self):
        self.server.end()
        self._topics.stdin.close()
        self._reader.join()
        self._topics.stdout.close()
        self._topics.wait()

    def _take(self, message):
        for each in message.transforms:
            self.stamps[each.child_frame_id].append(_ns(each))
            self._moved[_ns(each)].update(_by_child(TFMessage(transforms=[each])))

    def _read(self):
        for line in self._topics.stdout:
            got = json.loads(line, parse_int=float)
            message, self.types[got['topic']] = got['message'], got['type'].partition('.')[2]
            if got['topic'] == POSES:
                self._poses[_ns(_filled(JointState(), {**message, 'joint': ()}))] = {
                    each['id']: _pose(each) for each in message['pose']}
                continue
            publisher = self._publishers[got['topic']]
            if publisher.msg_type == Odometry:
                message['pose'] = self._change(publisher.topic, _pose(message['pose']))
            made = _filled(publisher.msg_type(), message)
            if isinstance(made, Clock):
                self.now = made.clock.sec + 1e-9 * made.clock.nanosec
            else:
                for each in getattr(made, 'transforms', [made]):
                    self.sent[publisher.topic][_ns(each)].append(each)
            publisher.publish(made)

    def wait(self, condition, what='it'):
        """Wait for a condition."""
        def has_come():
            assert self.server.is_running, self.server.lines
            return condition()
        self._listener.wait(has_come, what)

    def pass_time(self, sec):
        """Wait for a time in Gazebo to pass."""
        ends = self.now + sec
        self.wait(lambda: self.now >= ends, f'time {ends} in Gazebo')

    def drive(self, sec):
        """Send a speed or a position to all commands for a time, and then a speed of zero."""
        texts = {'Twist': 'linear: {x: 0.3, y: 0.2, z: 0.1}, angular: {x: 0.3, y: 0.2, z: 0.4}',
                 'Double': 'data: 0.5'}
        ends = self.now + sec
        while self.now < ends + 0.3:
            for each in self.entries:
                kind = each['gz_type_name'].rpartition('.')[2]
                if each['direction'] == 'ROS_TO_GZ' and kind in texts:
                    text = texts[kind] if self.now < ends or kind == 'Double' else ''
                    print(each['gz_topic_name'], f'ignition.msgs.{kind}', text,
                          file=self._topics.stdin, flush=True)
            self.pass_time(0.1)

    def call(self, service, kind, text='', answer='Boolean'):
        """Call a service of the world; return its answer as text of protobuf."""
        found = completed([
            TOOL('service'), '-s', f'/world/shop/{service}', '--timeout', '60000',
            '--reqtype', f'ignition.msgs.{kind}', '--reptype', f'ignition.msgs.{answer}', '--req',
            text])
        assert 'timed out' not in found.stdout, found
        return found.stdout

    def topics(self):
        """Return the topics that Gazebo offers."""
        return set(completed([TOOL('topic'), '-l']).stdout.split())

    def true_poses(self):
        """Iterate over stamps in ns, and the poses of models and links by their scoped names."""
        path = []
        for line in self.call('scene/info', 'Empty', answer='Scene').splitlines():
            key, _, value = line.strip().partition(' ')
            if value == '{':
                path.append({'kind': key})
            elif key == '}':
                if path[-1]['kind'] in ('model', 'link'):
                    self._names[int(path[-1]['id:'])] = '::'.join(each['name:'] for each in path)
                path.pop()
            elif path:
                path[-1][key] = value.strip('"')
        for stamp_ns, poses in [*self._poses.items()]:
            yield stamp_ns, {self._names[each]: pose for each, pose in poses.items()
                             if each in self._names}

    def pose_in_tf(self, frame, stamp_ns):
        """Return the pose of a frame in ``world`` at a stamp; None where TF has none of it."""
        found = Pose()
        while frame != 'world':
            step = self._moved[stamp_ns].get(frame) or self._fixed.get(frame)
            if step is None:
                return None
            frame, found = step[0], pose_product(step[1], found)
        return found


def pose_from_messages(position, orientation):
    return Pose(*(getattr(position, axis) for axis in 'xyz'),
                *(getattr(orientation, axis) for axis in 'xyzw'))


def _by_child(message):
    return {each.child_frame_id: (each.header.frame_id, pose_from_messages(
        each.transform.translation, each.transform.rotation)) for each in message.transforms}


def _ns(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def _pose(message):
    return Pose(*message['position'].values(), *message['orientation'].values())


def _time(stamp):
    return Time(sec=int(stamp['sec']), nanosec=int(stamp['nsec']))


def _filled(made, message):
    """Fill a message in ROS as ``src/convert`` of ros_gz_bridge 2.1.1 does."""
    if isinstance(made, Clock):
        made.clock = _time(message['sim'])
        return made
    if isinstance(made, TFMessage):
        made.transforms = [_filled(TransformStamped(), each) for each in message['pose']]
        return made
    made.header.stamp = _time(message['header']['stamp'])  # std_msgs.cpp:170
    for each in message['header']['data']:  # geometry_msgs.cpp:253, nav_msgs.cpp:48
        owner = made if each['key'] == 'child_frame_id' else made.header
        setattr(owner, each['key'], each['value'][0].replace('::', '/'))  # utils.cpp:49
    if isinstance(made, JointState):
        made.name = [each['name'] for each in message['joint']]
        made.position = [
            each.get('axis1', {}).get('position', 0.0) for each in message['joint']]
        return made
    x, y, z, *quat_xyzw = message['pose'] if isinstance(made, Odometry) else _pose(message)
    orientation = Quaternion(**dict(zip('xyzw', quat_xyzw, strict=True)))
    if isinstance(made, Odometry):
        made.pose.pose.position, made.pose.pose.orientation = Point(x=x, y=y, z=z), orientation
    else:
        made.transform.translation, made.transform.rotation = Vector3(x=x, y=y, z=z), orientation
    return made
