# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
What parameters of an include may say about which element.

Facts of the specification of version 1.11, as far as libsdformat judges parameters by them.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType


def _sets(table: dict[str, str]) -> Mapping[str, frozenset[str]]:
    return MappingProxyType({tag: frozenset(words.split()) for tag, words in table.items()})


DEFINED = frozenset(
    'actor air_pressure air_speed altimeter atmosphere audio_sink audio_source battery box_shape '
    'camera capsule_shape collision cone_shape contact cylinder_shape ellipsoid_shape forcetorque '
    'frame geometry gps gripper gui heightmap_shape image_shape imu inertial joint lidar light '
    'light_state link link_state logical_camera magnetometer material mesh_shape mimic model '
    'model_state navsat noise particle_emitter physics plane_shape plugin polyline_shape '
    'population pose projector ray rfid rfidtag road root scene sensor sonar sphere_shape '
    'spherical_coordinates state surface transceiver visual world'.split())
"""Tags that parameters can add, replace or change part by part: each has a file of the
specification to itself."""

CHILDREN = _sets({
    'battery': 'voltage',
    'camera': 'box_type camera_info_topic clip depth_camera distortion horizontal_fov image lens '
              'noise optical_frame_id pose save segmentation_type trigger_topic triggered '
              'visibility_mask',
    'collision': 'auto_inertia_params density geometry laser_retro max_contacts pose surface',
    'frame': 'pose',
    'gripper': 'grasp_check gripper_link palm_link',
    'joint': 'axis axis2 child gearbox_ratio gearbox_reference_body parent physics pose '
             'screw_thread_pitch sensor thread_pitch',
    'light': 'attenuation cast_shadows diffuse direction intensity light_on pose specular spot '
             'visualize',
    'link': 'audio_sink audio_source battery collision enable_wind gravity inertial kinematic '
            'light must_be_base_link particle_emitter pose projector self_collide sensor '
            'velocity_decay visual',
    'model': 'allow_auto_disable enable_wind frame gripper include joint link model plugin pose '
             'self_collide static',
    'particle_emitter': 'color_end color_range_image color_start duration emitting lifetime '
                        'material max_velocity min_velocity particle_scatter_ratio particle_size '
                        'pose rate scale_rate size topic',
    'projector': 'far_clip fov near_clip plugin pose texture visibility_flags',
    'sensor': 'air_pressure air_speed altimeter always_on camera contact enable_metrics '
              'force_torque gps imu lidar logical_camera magnetometer navsat plugin pose ray rfid '
              'rfidtag sonar topic transceiver update_rate visualize',
    'visual': 'cast_shadows geometry laser_retro material meta plugin pose transparency '
              'visibility_flags',
})
"""What can be put into each element that has a name."""

ATTRIBUTES = _sets({
    'actor': 'name',
    'battery': 'name',
    'camera': 'name',
    'collision': 'name',
    'custom_rpy': 'parent_frame',
    'frame': 'attached_to name',
    'grav_dir_x': 'parent_frame',
    'gripper': 'name',
    'inertial': 'auto',
    'inertial/pose': 'degrees rotation_format',
    'joint': 'name type',
    'light': 'name type',
    'light_map': 'uv_set',
    'link': 'name',
    'mesh': 'optimization',
    'mimic': 'axis joint',
    'model': 'canonical_link name placement_frame',
    'noise': 'type',
    'normal_map': 'type',
    'particle_emitter': 'name type',
    'plugin': 'filename name',
    'pose': 'degrees relative_to rotation_format',
    'projector': 'name',
    'save': 'enabled',
    'sensor': 'name type',
    'shader': 'type',
    'trajectory': 'id tension type',
    'visual': 'name',
    'waypoint/pose': '',
    'xyz': 'expressed_in',
})
"""Attributes of each element that has some, by its tag or by the parent's tag and its own."""

DEFAULT_CHILDREN = _sets({
    'attenuation': 'range',
    'audio_source': 'uri',
    'axis': 'limit xyz',
    'axis2': 'limit xyz',
    'battery': 'voltage',
    'box': 'size',
    'camera': 'clip horizontal_fov image',
    'capsule': 'length radius',
    'clip': 'far near',
    'collision': 'geometry',
    'cone': 'length radius',
    'contact': 'collision topic',
    'cylinder': 'length radius',
    'dynamics': 'spring_reference spring_stiffness',
    'ellipsoid': 'radii',
    'gripper': 'gripper_link palm_link',
    'heightmap': 'uri',
    'horizontal': 'max_angle min_angle resolution samples',
    'image': 'granularity height scale threshold uri width',
    'inertia': 'ixx ixy ixz iyy iyz izz',
    'intrinsics': 'cx cy fx fy s',
    'lens': 'scale_to_hfov type',
    'lidar': 'range scan',
    'light': 'direction',
    'limit': 'cfm erp lower upper',
    'logical_camera': 'aspect_ratio far horizontal_fov near',
    'mesh': 'uri',
    'mimic': 'multiplier offset reference',
    'noise': 'type',
    'plane': 'normal size',
    'polyline': 'height point',
    'projector': 'texture',
    'range': 'max min',
    'ray': 'range scan',
    'save': 'path',
    'scan': 'horizontal',
    'script': 'name uri',
    'sonar': 'max min',
    'sphere': 'radius',
    'spot': 'falloff inner_angle outer_angle',
    'submesh': 'name',
    'suspension': 'cfm erp',
    'transceiver': 'gain power',
    'vertical': 'max_angle min_angle samples',
    'visual': 'geometry',
})
"""What each element has even where the file does not write it."""

_HOLDERS = frozenset(
    'actor air_pressure air_speed altimeter angular_velocity animation attenuation audio_sink '
    'audio_source auto_inertia_params axis axis2 battery blend bounce box bullet camera capsule '
    'clip collision cone constraints contact convex_decomposition custom_function cylinder dart '
    'depth_camera distortion dynamics ellipsoid fluid_added_mass force force_torque frame '
    'friction geometry gps grasp_check gripper heightmap horizontal image imu inertia inertial '
    'intrinsics joint lens lidar light limit linear_acceleration link logical_camera magnetometer '
    'material mesh meta metal mimic model navsat noise ode orientation_reference_frame '
    'particle_emitter pbr physics plane plugin polyline position_sensing pressure projection '
    'projector range ray rfid rfidtag save scan script sensor shader simbody skin soft_contact '
    'solver sonar specular sphere spot submesh surface suspension texture torque torsional '
    'trajectory transceiver velocity_decay velocity_sensing vertical vertical_position '
    'vertical_velocity visual waypoint x y z'.split())

_VALUES = frozenset({
    ('attenuation', 'range'), ('bullet', 'friction'), ('contact', 'collision'),
    ('dynamics', 'friction'), ('force_torque', 'frame'), ('light', 'specular'),
    ('material', 'specular'), ('ode', 'bounce'), ('projector', 'texture'), ('sonar', 'geometry'),
})


def has_value(parent: str, tag: str) -> bool:
    """
    Tell whether an element holds a value, such as a number, rather than other elements.

    :param parent: tag of the element that holds it.
    :param tag: its own tag.
    :return: also true for what the specification does not know.
    """
    return tag not in _HOLDERS or (parent, tag) in _VALUES


def has_attribute(parent: str, tag: str, attribute: str) -> bool:
    """
    Tell whether the specification gives an element an attribute.

    :param parent: tag of the element that holds it.
    :param tag: its own tag.
    :param attribute: name of the attribute.
    :return: false also for what the specification does not know.
    """
    return attribute in ATTRIBUTES.get(f'{parent}/{tag}', ATTRIBUTES.get(tag, frozenset()))
