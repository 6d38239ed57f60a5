# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Types of joints, choices of values, and all elements without a pose in SDFormat.

Elements that version 1.12 renamed have both names.

The elements are in the notation of the module ``grammar``. Facts of the specification, version
1.11 (http://sdformat.org/spec).
"""

from __future__ import annotations

from collections.abc import Mapping
import enum
from typing import NamedTuple

from sdf_pose_bridge.geometry.pose_attributes import ATTRIBUTES_OF_NUMBERS


class Motion(enum.Enum):
    """The motion of a joint along or about an axis."""

    TURN = enum.auto()
    """The position is an angle in radians."""
    SLIDE = enum.auto()
    """The position is a distance in metres."""
    SCREW = enum.auto()
    """The position is an angle in radians; the pitch of the thread gives the distance."""


class DofType(NamedTuple):
    """A degree of freedom of a type of joints."""

    motion: Motion
    axis: int | tuple[float, float, float] = 0
    """The axis of the joint, 0 or 1, or a fixed direction in the frame of the joint."""
    suffix: str = ''
    """Appended to the name of the joint for its name in ``joint_states``."""


class UrdfJointType(NamedTuple):
    """A type of joints in URDF."""

    sdformat: str
    """The corresponding type of SDFormat, a key of :data:`JOINT_TYPES`; empty if there is none."""
    has_axis: bool
    has_limit: bool
    """Whether it requires a ``<limit>`` of its position."""


_ONE_TURN = (DofType(Motion.TURN),)
_TWO_TURNS = (DofType(Motion.TURN), DofType(Motion.TURN, 1, '_axis2'))

JOINT_TYPES: Mapping[str, tuple[DofType, ...]] = {
    'ball': (
        DofType(Motion.TURN, (0.0, 0.0, 1.0), '_yaw'),
        DofType(Motion.TURN, (0.0, 1.0, 0.0), '_pitch'),
        DofType(Motion.TURN, (1.0, 0.0, 0.0), '_roll')),
    'continuous': _ONE_TURN,
    'fixed': (),
    'gearbox': _ONE_TURN,
    'prismatic': (DofType(Motion.SLIDE),),
    'revolute': _ONE_TURN,
    'revolute2': _TWO_TURNS,
    'screw': (DofType(Motion.SCREW),),
    'universal': _TWO_TURNS,
}
"""The types of joints by their names in SDFormat: degrees of freedom from parent to child."""

URDF_JOINT_TYPES: Mapping[str, UrdfJointType] = {
    'continuous': UrdfJointType('revolute', has_axis=True, has_limit=False),
    'fixed': UrdfJointType('fixed', has_axis=False, has_limit=False),
    'floating': UrdfJointType('', has_axis=False, has_limit=False),
    'planar': UrdfJointType('', has_axis=True, has_limit=False),
    'prismatic': UrdfJointType('prismatic', has_axis=True, has_limit=True),
    'revolute': UrdfJointType('revolute', has_axis=True, has_limit=True),
}
"""The types of joints by their names in URDF."""

URDF_TAGS = ('ros2_control', 'transmission', 'gazebo')
"""The elements of URDF that users write into a ``<model>``; SDFormat does not define them."""


class Choice(NamedTuple):
    """The possible texts of a value."""

    texts: tuple[str, ...]
    ignores_case: bool = False


CAMERA_TYPES = (
    'boundingbox', 'boundingbox_camera', 'camera', 'depth', 'depth_camera', 'multicamera', 'rgbd',
    'rgbd_camera', 'segmentation', 'segmentation_camera', 'thermal', 'thermal_camera',
    'wide_angle_camera', 'wideanglecamera')
"""Types of sensors that take images."""

CHOICES: Mapping[str, Choice] = {
    'atmosphere_type': Choice(('adiabatic',)),
    'emitter_type': Choice(('box', 'cylinder', 'ellipsoid', 'point')),
    'joint_type': Choice(tuple(JOINT_TYPES), ignores_case=True),
    'light_type': Choice(('directional', 'point', 'spot')),
    'sensor_type': Choice(tuple(sorted((
        *CAMERA_TYPES, 'air_pressure', 'air_speed', 'altimeter', 'contact', 'custom',
        'force_torque', 'gps', 'gpu_lidar', 'gpu_ray', 'imu', 'lidar', 'logical_camera',
        'magnetometer', 'navsat', 'ray', 'rfid', 'rfidtag', 'sonar', 'wireless_receiver',
        'wireless_transmitter')))),
    'shader_type': Choice(
        ('normal_map_object_space', 'normal_map_tangent_space', 'pixel', 'vertex')),
    'surface_model': Choice(('EARTH_WGS84', 'MOON_SCS', 'CUSTOM_SURFACE')),
    'world_frame_orientation': Choice(('ENU',)),
}
"""The types of values that are one of a few texts."""

_CONTENTS = {
    'sdf': '@version! include',
    'actor/animation': '@name! filename! scale:double interpolate_x:bool',
    'actor/script': 'loop:bool delay_start:double auto_start:bool trajectory',
    'air_pressure': '/ reference_altitude:double pressure',
    'air_speed': '/ pressure',
    'altimeter': '/ vertical_position vertical_velocity',
    'angular_velocity,force,linear_acceleration,torque': 'x y z',
    'atmosphere': '/ @type!:atmosphere_type temperature,pressure,temperature_gradient:double',
    'attenuation': 'range!,linear,constant,quadratic:double',
    'audio': 'device!',
    'audio_sink,rfid,rfidtag': '/',
    'audio_source': '/ uri! pitch,gain:double contact loop:bool pose',
    'audio_source/contact': 'collision+:string',
    'auto_inertia_params': '*',
    'axis,axis2': 'xyz! dynamics limit! mimic',
    'axis/limit': 'lower!,upper!,effort,velocity,stiffness,dissipation:double',
    'axis2/limit': 'lower,upper,effort,velocity,stiffness,dissipation:double',
    'battery': '/ @name! voltage!:double',
    'blend': 'min_height!,fade_dist!:double',
    'bounce': 'restitution_coefficient:double[0,1] threshold:double',
    'box': '/box_shape size!:vector3',
    'bullet,ode': 'solver! constraints!',
    'bullet/constraints': (
        'cfm!,erp!,contact_surface_layer!:double split_impulse!:bool '
        'split_impulse_penetration_threshold!:double'),
    'bullet/solver': 'type! min_step_size:double iters!:int sor!:double',
    'camera': (
        '/ @name triggered:bool camera_info_topic trigger_topic '
        'horizontal_fov!:double[0.001,6.283186] image! clip! save depth_camera segmentation_type '
        'box_type noise distortion lens visibility_mask:uint optical_frame_id pose'),
    'camera/clip': 'near!:double[0,] far!:double[0.1,]',
    'camera/image': 'width!,height!:int format anti_aliasing:int',
    'camera/noise': 'type! mean,stddev:double',
    'capsule': '/capsule_shape radius!,length!:double',
    'clouds': (
        'speed:double[0,] direction:double[0,3.1456] humidity,mean_size:double[0,1] '
        'ambient:color'),
    'cone': '/cone_shape radius!,length!:double',
    'contact': '/ collision!:string topic!',
    'convex_decomposition': 'max_convex_hulls,voxel_resolution:uint',
    'custom_function': 'c1,c2,c3,f:double fun!',
    'custom_rpy': ':vector3 @parent_frame:frame',
    'cylinder': '/cylinder_shape radius!,length!:double',
    'dart': 'solver! collision_detector',
    'dart/solver': 'solver_type!',
    'deletions': 'name+',
    'depth_camera': 'output! clip',
    'depth_camera/clip': 'near:double[0,] far:double[0.1,]',
    'distortion': 'k1,k2,k3,p1,p2:double center:vector2',
    'dynamics': 'damping,friction,spring_reference!,spring_stiffness!:double',
    'ellipsoid': '/ellipsoid_shape radii!:vector3',
    'empty': '',
    'fluid_added_mass': 'xx,xy,xz,xp,xq,xr,yy,yz,yp,yq,yr,zz,zp,zq,zr,pp,pq,pr,qq,qr,rr:double',
    'fog': 'color:color type start,end,density:double[0,]',
    'force_torque': '/forcetorque frame:string measure_direction force torque',
    'friction': 'torsional ode bullet',
    'friction/bullet': 'friction,friction2:double[0,] fdir1:vector3 rolling_friction:double',
    'friction/ode': 'mu,mu2:double[0,] fdir1:vector3 slip1,slip2:double',
    'geometry': (
        '/ empty box capsule cone cylinder ellipsoid heightmap image mesh plane polyline sphere'),
    'gps,navsat': '/ position_sensing velocity_sensing',
    'grasp_check': 'detach_steps,attach_steps:int min_contact_count:uint',
    'grav_dir_x': ':vector3 @parent_frame',
    'gripper': '/ @name! grasp_check gripper_link+ palm_link!',
    'gui': '/ @fullscreen:bool plugin camera=gui_camera',
    'gui_camera': '@name! view_controller projection_type track_visual pose',
    'heightmap': (
        '/heightmap_shape uri! size,pos:vector3 texture blend use_terrain_paging:bool '
        'sampling:uint'),
    'horizontal': 'samples!:uint resolution!,min_angle!,max_angle!:double',
    'image': '/image_shape uri! scale!:double threshold!:int height!:double granularity!:int',
    'imu': (
        '/ orientation_reference_frame angular_velocity linear_acceleration '
        'enable_orientation:bool'),
    'include': '@merge:bool uri! pose plugin name static:bool placement_frame model_state',
    'inertia': 'ixx!,ixy!,ixz!,iyy!,iyz!,izz!:double',
    'include/pose,audio_source/pose': f':pose @relative_to:frame {ATTRIBUTES_OF_NUMBERS}',
    'inertial/pose': f':pose {ATTRIBUTES_OF_NUMBERS}',
    'insertions': 'model+=model light+=light joint+=joint',
    'intrinsics': 'fx!,fy!,cx!,cy!,s!:double',
    'joint/physics': 'simbody=joint_simbody ode=joint_ode provide_feedback:bool',
    'joint_ode': (
        'cfm_damping,implicit_spring_damper:bool '
        'fudge_factor,cfm,erp,bounce,max_force,velocity:double limit suspension'),
    'joint_simbody': 'must_be_loop_joint:bool',
    'lens': (
        'type! scale_to_hfov!:bool custom_function cutoff_angle:double[0,3.141592653] '
        'env_texture_size:int[4,2048] intrinsics projection'),
    'lidar,ray': '/ scan! range! noise=camera/noise visibility_mask:uint',
    'light_map': ':string @uv_set:uint',
    'light_state': '/ @name! pose',
    'limit,suspension': 'cfm!,erp!:double',
    'link_state': (
        '/ @name! angular_velocity linear_velocity:vector3 velocity:pose angular_acceleration '
        'linear_acceleration:vector3 acceleration:pose torque,force:vector3 wrench:pose '
        'collision_state pose'),
    'link_state/angular_acceleration,link_state/angular_velocity': ':vector3 @degrees:bool',
    'link_state/collision_state': '@name!',
    'old_link_state': (
        '@name! velocity,acceleration,wrench:pose collision=link_state/collision_state pose'),
    'logical_camera': '/ near!,far!,aspect_ratio!,horizontal_fov!:double',
    'magnetometer': '/ x y z',
    'material': (
        '/ script shader render_order:float lighting:bool ambient,diffuse,specular:color '
        'shininess:double emissive:color double_sided:bool pbr'),
    'material/script': 'uri+ name!',
    'mesh': '/mesh_shape @optimization convex_decomposition uri! submesh scale:vector3',
    'meta': 'layer:int',
    'metal': (
        'albedo_map roughness_map roughness metalness_map metalness environment_map '
        'ambient_occlusion_map normal_map emissive_map light_map'),
    'mimic': '/ @joint! @axis multiplier!,offset!,reference!:double',
    'model_state': '/ @name! joint_state model_state frame=frame pose scale:vector3 link_state',
    'old_model_state': (
        '@name! joint=old_joint_state model=old_model_state frame=frame pose scale:vector3 '
        'link=old_link_state'),
    'joint_state': '@name! angle axis_state axis2_state=axis_state',
    'old_joint_state': '@name! angle+',
    'angle': ':double @axis!:uint',
    'axis_state': 'position=quantity velocity=quantity acceleration=quantity effort:double',
    'quantity': ':double @degrees:bool',
    'noise': (
        '/ @type! mean:double stddev:double[0,] bias_mean:double '
        'bias_stddev,dynamic_bias_stddev:double[0,] '
        'dynamic_bias_correlation_time,precision:double'),
    'normal_map': ':string @type',
    'ode/constraints': 'cfm!,erp!,contact_max_correcting_vel!,contact_surface_layer!:double',
    'ode/solver': (
        'type! min_step_size:double island_threads,iters!,precon_iters:int sor!:double '
        'thread_position_correction,use_dynamic_moi_rescaling!:bool friction_model'),
    'orientation_reference_frame': 'localization! custom_rpy grav_dir_x',
    'pbr': 'metal specular',
    'physics': (
        '/ @name @default:bool @type! max_step_size!,real_time_factor!,'
        'real_time_update_rate!:double max_contacts:int dart simbody bullet ode'),
    'plane': '/plane_shape normal!:vector3 size!:vector2',
    'plugin': '/ @name @filename! *',
    'polyline': '/polyline_shape point+:vector2 height!:double',
    'population': '/ @name! box cylinder model_count!:int distribution! pose model!=model',
    'distribution': 'type! rows,cols:int step:vector3',
    'pose': f'/ :pose @relative_to^:frame {ATTRIBUTES_OF_NUMBERS}',
    'position_sensing,velocity_sensing': 'horizontal vertical',
    'position_sensing/horizontal,position_sensing/vertical': 'noise',
    'pressure,vertical_position,vertical_velocity,x,y,z': 'noise',
    'projection': 'p_fx,p_fy,p_cx,p_cy,tx,ty:double',
    'range': 'min!,max!,resolution:double',
    'road': '/ @name! width!:double point+:vector3 material',
    'save': '@enabled!:bool path!',
    'scan': 'horizontal! vertical',
    'scene': '/ ambient!,background!:color sky shadows!:bool fog grid,origin_visual:bool',
    'shader': '@type!:shader_type normal_map:string',
    'simbody': 'min_step_size,accuracy,max_transient_velocity:double contact',
    'simbody/contact': (
        'stiffness,dissipation,plastic_coef_restitution,plastic_impact_velocity,static_friction,'
        'dynamic_friction,viscous_friction,override_impact_capture_velocity,'
        'override_stiction_transition_velocity:double'),
    'skin': 'filename! scale:double',
    'sky': 'time,sunrise,sunset:double clouds cubemap_uri',
    'soft_contact': 'dart',
    'soft_contact/dart': 'bone_attachment!,stiffness!,damping!,flesh_mass_fraction!:double',
    'sonar': '/ geometry:string min!,max!,radius:double',
    'specular': (
        'albedo_map specular_map glossiness_map glossiness environment_map ambient_occlusion_map '
        'normal_map emissive_map light_map'),
    'sphere': '/sphere_shape radius!:double',
    'spherical_coordinates': (
        '/ surface_model!:surface_model world_frame_orientation:world_frame_orientation '
        'latitude_deg!,longitude_deg!,elevation!,surface_axis_equatorial,surface_axis_polar,'
        'heading_deg!:double'),
    'spot': 'inner_angle!,outer_angle!,falloff!:double',
    'state': (
        '/ @world_name! sim_time,wall_time,real_time:time iterations!:uint insertions deletions '
        'model=old_model_state model_state light=light_state light_state joint_state'),
    'submesh': 'name! center:bool',
    'surface': '/ bounce friction contact soft_contact',
    'surface/contact': (
        'collide_without_contact:bool collide_without_contact_bitmask,collide_bitmask,'
        'category_bitmask:uint poissons_ratio,elastic_modulus:double ode=contact_ode '
        'bullet=contact_bullet'),
    'contact_bullet': (
        'soft_cfm,soft_erp,kp,kd:double split_impulse!:bool '
        'split_impulse_penetration_threshold!:double'),
    'contact_ode': 'soft_cfm,soft_erp,kp,kd,max_vel,min_depth:double',
    'texture': 'size!:double diffuse! normal!',
    'torsional': (
        'coefficient:double[0,] use_patch_radius:bool patch_radius,surface_radius:double[0,] ode'),
    'torsional/ode': 'slip:double',
    'track_visual': (
        'name min_dist,max_dist:double static,use_model_frame:bool xyz:vector3 inherit_yaw:bool'),
    'trajectory': '@id!:int @type! @tension:double waypoint',
    'transceiver': '/ essid frequency,min_frequency,max_frequency,gain!,power!,sensitivity:double',
    'velocity_decay': 'linear,angular:double',
    'velocity_sensing/horizontal,velocity_sensing/vertical': 'noise',
    'vertical': 'samples!:uint resolution,min_angle!,max_angle!:double',
    'waypoint': 'time!:double pose!=waypoint_pose',
    'waypoint_pose': '!:pose',
    'wind': 'linear_velocity:vector3',
    'xyz': '!:axis @expressed_in^',
}
"""The content of each element, by its tag, ``parent/tag`` or a name that ``tag=name`` uses. A key
with commas is for several elements."""

_URDF_CONTENTS = {
    'robot': (
        '@name @version link=urdf_link joint=urdf_joint material=urdf_material origin=urdf_origin '
        'bullet=any collision_filter_group=any force_element=any gazebo=any loop_joint=any '
        'mujoco=any ros2_control=any sensor=any transmission=any'),
    'any': '*',
    'urdf_link': (
        '@name @type @concave inertial=urdf_inertial visual=urdf_visual collision=urdf_collision '
        'audio_source=any bullet=any collision_checking=any contact=any '
        'self_collision_checking=any self_filter=any sensor=any'),
    'urdf_inertial': 'origin=urdf_origin mass=urdf_mass inertia=urdf_inertia',
    'urdf_mass': '@value!:double',
    'urdf_inertia': '@ixx!,@ixy!,@ixz!,@iyy!,@iyz!,@izz!:double @iyx @izx @izy',
    'urdf_visual': (
        '@name @group origin=urdf_origin geometry=urdf_geometry material=urdf_material '
        'bullet=any'),
    'urdf_collision': (
        '@name @group @concave @mask origin=urdf_origin geometry=urdf_geometry '
        'material=urdf_material contact_coefficients=any verbose=any'),
    'urdf_geometry': (
        '@name box=urdf_box cylinder=urdf_cylinder capsule=urdf_cylinder sphere=urdf_sphere '
        'mesh=urdf_mesh cdf=any plane=any'),
    'urdf_box': '@size!:vector3',
    'urdf_cylinder': '@length!,@radius!:double',
    'urdf_sphere': '@radius!:double',
    'urdf_mesh': '@filename! @scale:vector3',
    'urdf_material': '@name color=urdf_color texture=urdf_texture specular=any',
    'urdf_color': '@rgba',
    'urdf_texture': '@filename',
    'urdf_joint': (
        '@name @type @dont_collapse origin=urdf_origin parent=urdf_end child=urdf_end '
        'axis=urdf_axis limit=urdf_limit dynamics=urdf_dynamics mimic=urdf_mimic '
        'calibration=urdf_calibration safety_controller=urdf_safety_controller '
        'controller_gains=any joint_properties=any traits=any'),
    'urdf_origin': '@xyz,@rpy:vector3 @quat_xyzw',
    'urdf_end': '@link',
    'urdf_axis': '@xyz:vector3',
    'urdf_limit': (
        '@lower,@upper,@effort!,@velocity!:double @acceleration @deceleration @jerk '
        '@command_effort @current @gear_velocity'),
    'urdf_dynamics': '@damping,@friction:double @D @K @mu_coulomb @mu_viscous',
    'urdf_mimic': '@joint! @multiplier,@offset:double',
    'urdf_calibration': '@rising,@falling:double @reference_position',
    'urdf_safety_controller': (
        '@soft_lower_limit,@soft_upper_limit,@k_position,@k_velocity!:double'),
}
"""The same for URDF, with additions of Gazebo, ros2_control, Bullet, Drake, MuJoCo and makers of
robots that change no frame. Types are only those of the numbers that urdfdom reads."""

ELEMENTS = {
    identifier: content
    for contents in (_CONTENTS, _URDF_CONTENTS)
    for identifiers, content in contents.items() for identifier in identifiers.split(',')}
"""The same for each element by itself."""
