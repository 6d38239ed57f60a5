# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The topics of Gazebo's plugins and sensors, and their types in ROS.

Sources: ``Configure`` of the classes in gz-sim 8 to 10, ``Load`` of the classes in gz-sensors 8 to
10, ``AsValidTopic`` of gz-transport, and ``mappings.py`` of ros_gz_bridge 2.1.1.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
import contextlib
import re
from typing import NamedTuple

_ROS_TYPES = """
actuator_msgs/Actuators geometry_msgs/TransformStamped=Pose geometry_msgs/Twist
geometry_msgs/WrenchStamped=Wrench nav_msgs/Odometry nav_msgs/Odometry=OdometryWithCovariance
ros_gz_interfaces/Altimeter ros_gz_interfaces/Contacts rosgraph_msgs/Clock sensor_msgs/BatteryState
sensor_msgs/CameraInfo sensor_msgs/FluidPressure sensor_msgs/Image sensor_msgs/Imu=IMU
sensor_msgs/JointState=Model sensor_msgs/LaserScan sensor_msgs/MagneticField=Magnetometer
sensor_msgs/NavSatFix=NavSat sensor_msgs/PointCloud2=PointCloudPacked std_msgs/Bool=Boolean
std_msgs/Empty std_msgs/Float64=Double tf2_msgs/TFMessage=Pose_V trajectory_msgs/JointTrajectory
vision_msgs/Detection2DArray=AnnotatedAxisAligned2DBox_V
vision_msgs/Detection3DArray=AnnotatedOriented3DBox_V std_msgs/String=StringMsg
"""
ROS_TYPES = {
    gz_type or name.partition('/')[2]: name.replace('/', '/msg/')
    for name, _, gz_type in (each.partition('=') for each in _ROS_TYPES.split())}
"""The type in ROS of each type in ``gz.msgs``; that of a pose is one that names its frame, too."""

_TOPICS = """
clock
server Clock clock /clock

joints
JointStatePublisher Model joint_states {topic} /world/{W}/model/{P}/joint_state

poses
PosePublisher Pose pose_static {topic}_static /model/{P}/pose_static \
    ?static_publisher ?!use_pose_vector_msg
PosePublisher Pose_V pose_static {topic}_static /model/{P}/pose_static \
    ?static_publisher ?use_pose_vector_msg
PosePublisher Pose pose {topic} /model/{P}/pose ?!use_pose_vector_msg
PosePublisher Pose_V pose {topic} /model/{P}/pose ?use_pose_vector_msg
SceneBroadcaster Pose_V pose/info /world/{W}/pose/info # not bridged, as poses have no frame ids

odometry
OdometryPublisher Odometry odometry {odom_topic} ~/odometry *odom_frame
OdometryPublisher OdometryWithCovariance odometry_with_covariance \
    {odom_covariance_topic} ~/odometry_with_covariance *odom_frame
AckermannSteering,DiffDrive,MecanumDrive,TrackedVehicle Odometry odometry {odom_topic} ~/odometry \
    ?!steering_only *frame_id

sensors
LinearBatteryPlugin BatteryState {battery_name}/battery_state ~/battery/{battery_name}/state
camera,thermal,wide_angle,wideanglecamera Image image {topic} @/image
camera CameraInfo camera_info {camera/camera_info_topic} {topic}/../camera_info @/camera_info
boundingbox,depth,thermal,wide_angle,wideanglecamera CameraInfo camera_info \
    {topic}/../camera_info @/camera_info
depth Image depth_image {topic} @/depth_image
depth PointCloudPacked points {topic}/points @/depth_image/points
rgbd Image image {topic}/image @/image
rgbd Image depth_image {topic}/depth_image @/depth_image
rgbd PointCloudPacked points {topic}/points @/points
rgbd CameraInfo camera_info {topic}/camera_info @/camera_info
segmentation Image colored_map {topic}/colored_map @/segmentation/colored_map
segmentation Image labels_map {topic}/labels_map @/segmentation/labels_map
segmentation CameraInfo camera_info {topic}/camera_info @/segmentation/camera_info
boundingbox AnnotatedAxisAligned2DBox_V boxes {topic} @/boundingbox ?!camera/box_type
boundingbox AnnotatedOriented3DBox_V boxes {topic} @/boundingbox ?camera/box_type
boundingbox Image boxes_image {topic}_image @/boundingbox_image
gpu_lidar,gpu_ray LaserScan scan {topic} @/scan
gpu_lidar,gpu_ray PointCloudPacked points {topic}/points @/scan/points
lidar,ray LaserScan scan {topic} @/scan # Gazebo sends nothing for it, but for gpu_lidar
imu IMU imu {topic} @/imu
gps,navsat NavSat navsat {topic} @/navsat
altimeter Altimeter altimeter {topic} @/altimeter
air_pressure FluidPressure air_pressure {topic} @/air_pressure
air_speed AirSpeed air_speed {topic} @/air_speed # ros_gz_bridge has it since 3.0.10
magnetometer Magnetometer magnetometer {topic} @/magnetometer
force_torque Wrench force_torque {topic} @/forcetorque
logical LogicalCameraImage models {topic} @/logical_camera # ros_gz_bridge has it since 2.1.5
contact Contacts contacts {contact/topic} @/contact
TouchPlugin Boolean touched /{namespace}/touched /model/{P}/touch/touched
DetachableJoint StringMsg detachable_joint/state {output_topic} \
    /model/{child_model}/detachable_joint/state

commands
DiffDrive,MecanumDrive,TrackedVehicle,VelocityControl Twist cmd_vel {topic} ~/cmd_vel
AckermannSteering Twist cmd_vel {topic} ~/{sub_topic} ~/cmd_vel ?!steering_only
AckermannSteering Double steer_angle {topic} ~/{sub_topic} ~/steer_angle ?steering_only \
    ?!use_actuator_msg
AckermannSteering Actuators actuators {topic} ~/{sub_topic} /actuators ?steering_only \
    ?use_actuator_msg
DiffDrive Boolean enable ~/enable
TrackedVehicle Double steering_efficiency {steering_efficiency_topic} ~/steering_efficiency
JointPositionController Double {joint_name}/cmd_pos {topic} ~/{sub_topic} \
    ~/joint/{joint_name}/{joint_index}/cmd_pos ?!use_actuator_msg
JointController Double {joint_name}/cmd_vel {topic} ~/{sub_topic} ~/joint/{joint_name}/cmd_vel \
    ?!use_actuator_msg
JointController,JointPositionController Actuators actuators {topic} ~/{sub_topic} /actuators \
    ?use_actuator_msg
ApplyJointForce Double {joint_name}/cmd_force ~/joint/{joint_name}/cmd_force
DetachableJoint Empty detachable_joint/detach {detach_topic} {topic} ~/detachable_joint/detach
DetachableJoint Empty detachable_joint/attach {attach_topic} ~/detachable_joint/attach
JointTrajectoryController JointTrajectory joint_trajectory {topic} ~/joint_trajectory
Thruster Double {joint_name}/cmd_thrust /{N}/{topic} /model/{N}/joint/{joint_name}/cmd_thrust \
    ?!use_angvel_cmd
Thruster Double {joint_name}/cmd_vel /{N}/{topic} /model/{N}/joint/{joint_name}/cmd_vel \
    ?use_angvel_cmd
MulticopterVelocityControl Twist cmd_vel /{N}/{commandSubTopic} /{N}/cmd_vel
MulticopterVelocityControl Boolean enable /{N}/{enableSubTopic} /{N}/enable
MulticopterMotorModel Actuators motor_speed /{N}/{commandSubTopic}
camera Boolean trigger {camera/trigger_topic} {topic}/trigger @/image/trigger ?camera/triggered
"""
"""
Groups with lines about classes of plugins, and about types of sensors without ``_camera``.

A line has the type in ``gz.msgs``, the name in ROS below the model or the sensor, and names in
Gazebo, of which the first one counts whose fields have values. ``{W}``, ``{P}`` and ``{M}`` stand
for the world, the model with those around it (``a/model/b``), and its own name, ``{N}`` for the
name space of a plugin, ``{C}`` and ``{S}`` for the link of a sensor (``link/l``) and its name,
others for parameters. ``?name`` must be true, and ``?!name`` must not; ``*name`` has the frame of
odometry. Of several poses of one model, those that are first here are followed.
"""
LEFT_OUT = frozenset("""
ApplyLinkWrench Breadcrumbs BuoyancyEngine Elevator EnvironmentalSystem Hydrodynamics
KineticEnergyMonitor LogicalAudioSensorPlugin OpticalTactilePlugin PerformerDetector
SpacecraftThrusterModel TrackController TrajectoryFollower TriggeredPublisher""".lower().split())
"""Other classes that have topics of types that ros_gz_bridge converts, in small letters."""
SENSOR_PATHS = tuple(dict.fromkeys(('topic', *re.findall(r'[{?!](\w+(?:/\w+)+)', _TOPICS))))
"""Elements of a sensor on which its topics depend."""
STATE_GROUPS = ('joints', 'poses', 'odometry')
GROUPS = (*STATE_GROUPS, 'sensors', 'commands')
_ABBREVIATIONS = {'~': '/model/{M}', '@': '/world/{W}/model/{P}/{C}/sensor/{S}'}
_DELETED, _LAST_LEVEL = re.compile('@|~|//|:='), re.compile(r'(?<![^/])[^/]+/\.\./')


class GazeboTopic(NamedTuple):
    """A topic of a plugin or a sensor, as in the table."""

    group: str
    gz_type: str
    ros_name: str
    names: list[str]
    conditions: list[str]
    odometry_frame: str
    reason: str
    """Why it cannot be bridged; empty if it can."""

    @property
    def is_of_wheels(self) -> bool:
        """Whether odometry is zero where the model was spawned; others are poses in the world."""
        return self.odometry_frame == 'frame_id'

    def name(self, values: Mapping[str, str]) -> str:
        """Return its name in Gazebo; empty if it needs a value that is missing."""
        for name in self.names:
            with contextlib.suppress(KeyError):
                valid = _DELETED.sub('', name.format_map(values).replace(' ', '_')).strip('/')
                if valid:
                    return '/' + _LAST_LEVEL.sub('', valid)
        return ''


def topics_of(owner: str, values: Mapping[str, str]) -> list[GazeboTopic]:
    """Return the topics of a class of plugins or a type of sensors, by the values of fields."""
    topics = TOPICS_BY_OWNER.get(_key(owner).removesuffix('_camera'), ())
    return [topic for topic in topics if all(
        is_true(values, each.lstrip('!')) != each.startswith('!') for each in topic.conditions)]


def is_true(values: Mapping[str, str], name: str) -> bool:
    """Return whether a parameter is true, or the type of boxes is the second one."""
    return values.get(name, '').lower() in ('1', 'true', '3d')


def _key(owner: str) -> str:
    # A class begins with a capital, unlike a type. Names of libraries do not have all capitals.
    return owner[:1] + owner[1:].lower()


def _topics_by_owner() -> Mapping[str, list[GazeboTopic]]:
    topics: defaultdict[str, list[GazeboTopic]] = defaultdict(list)
    for section in _TOPICS.strip().split('\n\n'):
        group, *lines = section.splitlines()
        for line in lines:
            row, _, reason = line.partition(' # ')
            owners, gz_type, ros_name, *words = row.split()
            names = [_ABBREVIATIONS.get(each[0], each[0]) + each[1:] for each in words
                     if each[0] not in '?*']
            conditions, frames = ([each[1:] for each in words if each[0] == mark] for mark in '?*')
            for owner in owners.split(','):
                topics[_key(owner)].append(GazeboTopic(
                    group, gz_type, ros_name, names, conditions, ''.join(frames), reason))
    return topics


TOPICS_BY_OWNER = _topics_by_owner()
