# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The topics of Gazebo as its sources name them, with the files and the lines.

They are gz-sim 8.14.0 (b81e26da), gz-sensors 8.2.2 (c8159af0) and ros_gz_bridge of Jazzy
(739cb42a). The model ``b`` is in the model ``a`` in the world ``w``, and a sensor ``s`` in its
link ``l``.
"""

TOPICS = """
SimulationRunner.cc: server
870 clock Clock clock /clock

JointStatePublisher.cc: JointStatePublisher
190 joints Model joint_states /world/w/model/a/model/b/joint_state
JointStatePublisher.cc: JointStatePublisher topic=x
193 joints Model joint_states /x

PosePublisher.cc: PosePublisher static_publisher=true
274 poses Pose pose /model/a/model/b/pose
304 poses Pose pose_static /model/a/model/b/pose_static
PosePublisher.cc: PosePublisher topic=x static_publisher=true
264 poses Pose pose /x
282 poses Pose pose_static /x_static
PosePublisher.cc: PosePublisher static_publisher=1 use_pose_vector_msg=true
287 poses Pose_V pose /model/a/model/b/pose
292 poses Pose_V pose_static /model/a/model/b/pose_static
PosePublisher.cc: PosePublisher topic=x static_publisher=1 use_pose_vector_msg=true
264 poses Pose_V pose /x
282 poses Pose_V pose_static /x_static
PosePublisher.cc: PosePublisher
299 poses Pose pose /model/a/model/b/pose
PosePublisher.cc: PosePublisher use_pose_vector_msg=true
287 poses Pose_V pose /model/a/model/b/pose
SceneBroadcaster.cc: SceneBroadcaster
717 poses Pose_V pose/info /world/w/pose/info

OdometryPublisher.cc: OdometryPublisher
226 odometry Odometry odometry /model/b/odometry
228 odometry OdometryWithCovariance odometry_with_covariance /model/b/odometry_with_covariance
OdometryPublisher.cc: OdometryPublisher odom_topic=x odom_covariance_topic=y
231 odometry Odometry odometry /x
233 odometry OdometryWithCovariance odometry_with_covariance /y

DiffDrive.cc: DiffDrive
341 commands Twist cmd_vel /model/b/cmd_vel
350 commands Boolean enable /model/b/enable
366 odometry Odometry odometry /model/b/odometry
DiffDrive.cc: DiffDrive topic=x odom_topic=y
339 commands Twist cmd_vel /x
350 commands Boolean enable /model/b/enable
363 odometry Odometry odometry /y
AckermannSteering.cc: AckermannSteering
419 commands Twist cmd_vel /model/b/cmd_vel
463 odometry Odometry odometry /model/b/odometry
AckermannSteering.cc: AckermannSteering topic=x sub_topic=z odom_topic=y
399 commands Twist cmd_vel /x
460 odometry Odometry odometry /y
AckermannSteering.cc: AckermannSteering sub_topic=z
404 commands Twist cmd_vel /model/b/z
463 odometry Odometry odometry /model/b/odometry
AckermannSteering.cc: AckermannSteering steering_only=true
410 commands Double steer_angle /model/b/steer_angle
AckermannSteering.cc: AckermannSteering steering_only=true topic=x sub_topic=z
399 commands Double steer_angle /x
AckermannSteering.cc: AckermannSteering steering_only=true sub_topic=z
404 commands Double steer_angle /model/b/z
AckermannSteering.cc: AckermannSteering steering_only=1 use_actuator_msg=1
415 commands Actuators actuators /actuators
AckermannSteering.cc: AckermannSteering steering_only=1 use_actuator_msg=1 topic=x sub_topic=z
399 commands Actuators actuators /x
AckermannSteering.cc: AckermannSteering steering_only=1 use_actuator_msg=1 sub_topic=z
404 commands Actuators actuators /model/b/z
MecanumDrive.cc: MecanumDrive
300 commands Twist cmd_vel /model/b/cmd_vel
312 odometry Odometry odometry /model/b/odometry
MecanumDrive.cc: MecanumDrive topic=x odom_topic=y
298 commands Twist cmd_vel /x
309 odometry Odometry odometry /y
TrackedVehicle.cc: TrackedVehicle
371 commands Twist cmd_vel /model/b/cmd_vel
379 odometry Odometry odometry /model/b/odometry
395 commands Double steering_efficiency /model/b/steering_efficiency
TrackedVehicle.cc: TrackedVehicle topic=x odom_topic=y steering_efficiency_topic=z
373 commands Twist cmd_vel /x
381 odometry Odometry odometry /y
397 commands Double steering_efficiency /z
VelocityControl.cc: VelocityControl
149 commands Twist cmd_vel /model/b/cmd_vel
VelocityControl.cc: VelocityControl topic=x
146 commands Twist cmd_vel /x

JointPositionController.cc: JointPositionController joint_name=j joint_index=1
233 commands Double j/cmd_pos /model/b/joint/j/1/cmd_pos
JointPositionController.cc: JointPositionController joint_name=j topic=x sub_topic=z
273 commands Double j/cmd_pos /x
JointPositionController.cc: JointPositionController joint_name=j sub_topic=z
258 commands Double j/cmd_pos /model/b/z
JointPositionController.cc: JointPositionController use_actuator_msg=true
245 commands Actuators actuators /actuators
JointPositionController.cc: JointPositionController use_actuator_msg=true topic=x sub_topic=z
273 commands Actuators actuators /x
JointPositionController.cc: JointPositionController use_actuator_msg=true sub_topic=z
258 commands Actuators actuators /model/b/z
JointController.cc: JointController joint_name=j
187 commands Double j/cmd_vel /model/b/joint/j/cmd_vel
JointController.cc: JointController joint_name=j topic=x sub_topic=z
227 commands Double j/cmd_vel /x
JointController.cc: JointController joint_name=j sub_topic=z
212 commands Double j/cmd_vel /model/b/z
JointController.cc: JointController use_actuator_msg=true
199 commands Actuators actuators /actuators
JointController.cc: JointController use_actuator_msg=true topic=x sub_topic=z
227 commands Actuators actuators /x
JointController.cc: JointController use_actuator_msg=true sub_topic=z
212 commands Actuators actuators /model/b/z
ApplyJointForce.cc: ApplyJointForce joint_name=j
108 commands Double j/cmd_force /model/b/joint/j/cmd_force
DetachableJoint.cc: DetachableJoint child_model=c
104 commands Empty detachable_joint/detach /model/b/detachable_joint/detach
152 commands Empty detachable_joint/attach /model/b/detachable_joint/attach
186 sensors StringMsg detachable_joint/state /model/c/detachable_joint/state
DetachableJoint.cc: DetachableJoint child_model=c topic=x attach_topic=y output_topic=z
127 commands Empty detachable_joint/detach /x
150 commands Empty detachable_joint/attach /y
183 sensors StringMsg detachable_joint/state /z
DetachableJoint.cc: DetachableJoint child_model=c topic=x detach_topic=w
102 commands Empty detachable_joint/detach /w
152 commands Empty detachable_joint/attach /model/b/detachable_joint/attach
186 sensors StringMsg detachable_joint/state /model/c/detachable_joint/state
TouchPlugin.cc: TouchPlugin
268 sensors Boolean touched /model/a/model/b/touch/touched
TouchPlugin.cc: TouchPlugin namespace=x
264 sensors Boolean touched /x/touched
JointTrajectoryController.cc: JointTrajectoryController
382 commands JointTrajectory joint_trajectory /model/b/joint_trajectory
JointTrajectoryController.cc: JointTrajectoryController topic=x
378 commands JointTrajectory joint_trajectory /x
Thruster.cc: Thruster joint_name=j
375 commands Double j/cmd_thrust /model/b/joint/j/cmd_thrust
Thruster.cc: Thruster joint_name=j topic=x
346 commands Double j/cmd_thrust /b/x
Thruster.cc: Thruster joint_name=j use_angvel_cmd=true
393 commands Double j/cmd_vel /model/b/joint/j/cmd_vel
Thruster.cc: Thruster joint_name=j use_angvel_cmd=true topic=x
346 commands Double j/cmd_vel /b/x
MulticopterVelocityControl.hh: MulticopterVelocityControl
212 commands Twist cmd_vel /b/cmd_vel
215 commands Boolean enable /b/enable
MulticopterVelocityControl.cc: MulticopterVelocityControl commandSubTopic=x enableSubTopic=y
287 commands Twist cmd_vel /b/x
293 commands Boolean enable /b/y
MulticopterMotorModel.cc: MulticopterMotorModel commandSubTopic=x
377 commands Actuators motor_speed /b/x
LinearBatteryPlugin.cc: LinearBatteryPlugin battery_name=x
422 sensors BatteryState x/battery_state /model/b/battery/x/state

RenderUtil.cc: camera,thermal,thermal_camera,wide_angle_camera,wideanglecamera
1737 sensors Image image @/image
CameraSensor.cc:673 sensors CameraInfo camera_info @/camera_info
CameraSensor.cc: camera,thermal,wide_angle_camera,wideanglecamera topic=y/x
396 sensors Image image /y/x
673 sensors CameraInfo camera_info /y/camera_info
CameraSensor.cc: camera topic=y/x camera/camera_info_topic=z camera/triggered=true
396 sensors Image image /y/x
391 sensors CameraInfo camera_info /z
412 commands Boolean trigger /y/x/trigger
CameraSensor.cc: camera camera/triggered=true
RenderUtil.cc:1737 sensors Image image @/image
673 sensors CameraInfo camera_info @/camera_info
412 commands Boolean trigger @/image/trigger
CameraSensor.cc: camera topic=y/x camera/triggered=true camera/trigger_topic=z
396 sensors Image image /y/x
673 sensors CameraInfo camera_info /y/camera_info
409 commands Boolean trigger /z
DepthCameraSensor.cc: depth_camera,depth
RenderUtil.cc:1738 sensors Image depth_image @/depth_image
303 sensors PointCloudPacked points @/depth_image/points
CameraSensor.cc:673 sensors CameraInfo camera_info @/camera_info
DepthCameraSensor.cc: depth_camera topic=y/x
274 sensors Image depth_image /y/x
303 sensors PointCloudPacked points /y/x/points
CameraSensor.cc:673 sensors CameraInfo camera_info /y/camera_info
RgbdCameraSensor.cc: rgbd_camera
202 sensors Image image @/image
216 sensors Image depth_image @/depth_image
230 sensors PointCloudPacked points @/points
252 sensors CameraInfo camera_info @/camera_info
RgbdCameraSensor.cc: rgbd_camera,rgbd topic=x
202 sensors Image image /x/image
216 sensors Image depth_image /x/depth_image
230 sensors PointCloudPacked points /x/points
252 sensors CameraInfo camera_info /x/camera_info
SegmentationCameraSensor.cc: segmentation_camera,segmentation
198 sensors Image colored_map @/segmentation/colored_map
213 sensors Image labels_map @/segmentation/labels_map
238 sensors CameraInfo camera_info @/segmentation/camera_info
SegmentationCameraSensor.cc: segmentation_camera topic=x
198 sensors Image colored_map /x/colored_map
213 sensors Image labels_map /x/labels_map
238 sensors CameraInfo camera_info /x/camera_info
BoundingBoxCameraSensor.cc: boundingbox_camera,boundingbox
190 sensors Image boxes_image @/boundingbox_image
213 sensors AnnotatedAxisAligned2DBox_V boxes @/boundingbox
CameraSensor.cc:673 sensors CameraInfo camera_info @/camera_info
BoundingBoxCameraSensor.cc: boundingbox_camera topic=y/x
190 sensors Image boxes_image /y/x_image
213 sensors AnnotatedAxisAligned2DBox_V boxes /y/x
CameraSensor.cc:673 sensors CameraInfo camera_info /y/camera_info
BoundingBoxCameraSensor.cc: boundingbox_camera camera/box_type=3d
190 sensors Image boxes_image @/boundingbox_image
208 sensors AnnotatedOriented3DBox_V boxes @/boundingbox
CameraSensor.cc:673 sensors CameraInfo camera_info @/camera_info
BoundingBoxCameraSensor.cc: boundingbox_camera camera/box_type=3d topic=y/x
190 sensors Image boxes_image /y/x_image
208 sensors AnnotatedOriented3DBox_V boxes /y/x
CameraSensor.cc:673 sensors CameraInfo camera_info /y/camera_info
GpuLidarSensor.cc: gpu_lidar,gpu_ray
RenderUtil.cc:1741 sensors LaserScan scan @/scan
154 sensors PointCloudPacked points @/scan/points
GpuLidarSensor.cc: gpu_lidar,gpu_ray topic=x
Lidar.cc:130 sensors LaserScan scan /x
151 sensors PointCloudPacked points /x/points
Lidar.cc: lidar,ray
130 sensors LaserScan scan @/scan
Lidar.cc: lidar,ray topic=x
130 sensors LaserScan scan /x
Imu.cc: imu
201 sensors IMU imu @/imu
ImuSensor.cc: imu topic=x
142 sensors IMU imu /x
NavSat.cc: navsat,gps
184 sensors NavSat navsat @/navsat
NavSatSensor.cc: navsat,gps topic=x
111 sensors NavSat navsat /x
Altimeter.cc: altimeter
189 sensors Altimeter altimeter @/altimeter
AltimeterSensor.cc: altimeter topic=x
106 sensors Altimeter altimeter /x
AirPressure.cc: air_pressure
188 sensors FluidPressure air_pressure @/air_pressure
AirPressureSensor.cc: air_pressure topic=x
117 sensors FluidPressure air_pressure /x
AirSpeed.cc: air_speed
191 sensors AirSpeed air_speed @/air_speed
AirSpeedSensor.cc: air_speed topic=x
116 sensors AirSpeed air_speed /x
Magnetometer.cc: magnetometer
361 sensors Magnetometer magnetometer @/magnetometer
MagnetometerSensor.cc: magnetometer topic=x
108 sensors Magnetometer magnetometer /x
ForceTorque.cc: force_torque
348 sensors Wrench force_torque @/forcetorque
ForceTorqueSensor.cc: force_torque topic=x
134 sensors Wrench force_torque /x
LogicalCamera.cc: logical_camera,logical
192 sensors LogicalCameraImage models @/logical_camera
LogicalCameraSensor.cc: logical_camera topic=x
110 sensors LogicalCameraImage models /x
Contact.cc: contact
226 sensors Contacts contacts @/contact
Contact.cc: contact contact/topic=x topic=y
136 sensors Contacts contacts /x
"""
"""
A line with a file, classes of plugins or types of sensors, and the values of parameters, is above
those of the topics: a line in this file or a place in another one, the group, the type in Gazebo,
the name in ROS below the model or sensor, and the name in Gazebo, with ``@`` for the sensor.
"""

ROS_TYPES = """
31 Actuators actuator_msgs/msg/Actuators
42 Pose geometry_msgs/msg/TransformStamped
43 Twist geometry_msgs/msg/Twist
48 Wrench geometry_msgs/msg/WrenchStamped
55 Odometry nav_msgs/msg/Odometry
56 OdometryWithCovariance nav_msgs/msg/Odometry
62 Altimeter ros_gz_interfaces/msg/Altimeter
64 Contacts ros_gz_interfaces/msg/Contacts
81 Clock rosgraph_msgs/msg/Clock
84 BatteryState sensor_msgs/msg/BatteryState
85 CameraInfo sensor_msgs/msg/CameraInfo
86 FluidPressure sensor_msgs/msg/FluidPressure
87 Image sensor_msgs/msg/Image
88 IMU sensor_msgs/msg/Imu
89 Model sensor_msgs/msg/JointState
91 LaserScan sensor_msgs/msg/LaserScan
92 Magnetometer sensor_msgs/msg/MagneticField
93 NavSat sensor_msgs/msg/NavSatFix
94 PointCloudPacked sensor_msgs/msg/PointCloud2
97 Boolean std_msgs/msg/Bool
99 Empty std_msgs/msg/Empty
101 Double std_msgs/msg/Float64
105 StringMsg std_msgs/msg/String
108 Pose_V tf2_msgs/msg/TFMessage
111 JointTrajectory trajectory_msgs/msg/JointTrajectory
114 AnnotatedAxisAligned2DBox_V vision_msgs/msg/Detection2DArray
116 AnnotatedOriented3DBox_V vision_msgs/msg/Detection3DArray
"""
"""The line in ``mappings.py`` of each type in Gazebo and its type in ROS."""

SYSTEMS = """
AckermannSteering AcousticComms AdvancedLiftDrag AirPressure AirSpeed Altimeter ApplyJointForce
ApplyLinkWrench Breadcrumbs Buoyancy BuoyancyEngine CameraVideoRecorder ColladaWorldExporter
CommsEndpoint Contact DetachableJoint DiffDrive DopplerVelocityLogSystem Elevator EntitySemantics
EnvironmentPreload EnvironmentalSystem FollowActor ForceTorque Hydrodynamics Imu JointController
JointPositionController JointStatePublisher JointTrajectoryController KineticEnergyMonitor Label
LensFlare LiftDrag LighterThanAirDynamics LinearBatteryPlugin LogPlayback LogRecord
LogVideoRecorder LogicalAudioSensorPlugin LogicalCamera Magnetometer MecanumDrive ModelPhotoShoot
MulticopterMotorModel MulticopterVelocityControl NavSat OdometryPublisher OpticalTactilePlugin
ParticleEmitter PerfectComms PerformerDetector Physics PosePublisher PythonSystemLoader RFComms
SceneBroadcaster Sensors ShaderParam SpacecraftThrusterModel Thermal ThermalSensor Thruster
TouchPlugin TrackController TrackedVehicle TrajectoryFollower TriggeredPublisher UserCommands
VelocityControl WheelSlip WindEffects
"""
"""The classes of plugins in gz-sim, by the names with which they are registered."""

SYSTEMS_WITHOUT_TOPICS = """
AcousticComms AdvancedLiftDrag AirPressure AirSpeed Altimeter Buoyancy CameraVideoRecorder
ColladaWorldExporter CommsEndpoint Contact DopplerVelocityLogSystem EntitySemantics
EnvironmentPreload FollowActor ForceTorque Imu Label LensFlare LiftDrag LighterThanAirDynamics
LogPlayback LogRecord LogVideoRecorder LogicalCamera Magnetometer ModelPhotoShoot NavSat
ParticleEmitter PerfectComms Physics PythonSystemLoader RFComms Sensors ShaderParam Thermal
ThermalSensor UserCommands WheelSlip WindEffects
"""
"""Those without topics of types that ros_gz_bridge converts and that ROS can use; those of sensors
send what the table has for types of sensors."""
