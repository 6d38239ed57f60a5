# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
What values SDFormat's elements take, as far as they can be wrong.

Facts of the specification of version 1.11. Keys are the tag of the parent and of the element; an
element that is not listed takes any text. Poses are not here:
:mod:`sdf_pose_bridge.sdformat.pose_text` reads those.
"""

from __future__ import annotations

import enum


class ValueType(enum.Enum):
    """Type of an element's value."""

    BOOLEAN = 'a boolean (true, false, 1 or 0)'
    INTEGER = 'an integer'
    NUMBER = 'a number'
    TWO_NUMBERS = 'two numbers'
    THREE_NUMBERS = 'three numbers'
    COLOR = 'a color of three or four numbers from 0 to 1'


_BOOLEANS = {
    'animation': 'interpolate_x',
    'audio_source': 'loop',
    'bullet': 'split_impulse',
    'camera': 'triggered',
    'constraints': 'split_impulse',
    'contact': 'collide_without_contact',
    'heightmap': 'use_terrain_paging',
    'imu': 'enable_orientation',
    'lens': 'scale_to_hfov',
    'light': 'cast_shadows light_on visualize',
    'link': 'enable_wind gravity kinematic must_be_base_link self_collide',
    'material': 'double_sided lighting',
    'model': 'allow_auto_disable enable_wind self_collide',
    'ode': 'cfm_damping implicit_spring_damper',
    'particle_emitter': 'emitting',
    'physics': 'provide_feedback',
    'scene': 'grid origin_visual shadows',
    'script': 'auto_start loop',
    'sensor': 'always_on enable_metrics visualize',
    'simbody': 'must_be_loop_joint',
    'solver': 'thread_position_correction use_dynamic_moi_rescaling',
    'submesh': 'center',
    'torsional': 'use_patch_radius',
    'track_visual': 'inherit_yaw static use_model_frame',
    'visual': 'cast_shadows',
}

_INTEGERS = {
    'camera': 'visibility_mask',
    'collision': 'max_contacts',
    'contact': 'category_bitmask collide_bitmask collide_without_contact_bitmask',
    'convex_decomposition': 'max_convex_hulls voxel_resolution',
    'distribution': 'cols rows',
    'grasp_check': 'attach_steps detach_steps min_contact_count',
    'heightmap': 'sampling',
    'horizontal': 'samples',
    'image': 'anti_aliasing width',
    'lens': 'env_texture_size',
    'lidar': 'visibility_mask',
    'meta': 'layer',
    'physics': 'max_contacts',
    'population': 'model_count',
    'projector': 'visibility_flags',
    'ray': 'visibility_mask',
    'solver': 'island_threads iters precon_iters',
    'state': 'iterations',
    'vertical': 'samples',
    'visual': 'visibility_flags',
}

_NUMBERS = {
    'air_pressure': 'reference_altitude',
    'animation': 'scale',
    'atmosphere': 'pressure temperature temperature_gradient',
    'attenuation': 'constant linear quadratic range',
    'audio_source': 'gain pitch',
    'battery': 'voltage',
    'blend': 'fade_dist min_height',
    'bounce': 'restitution_coefficient threshold',
    'bullet': 'friction friction2 kd kp rolling_friction soft_cfm soft_erp '
              'split_impulse_penetration_threshold',
    'camera': 'horizontal_fov',
    'capsule': 'length radius',
    'clip': 'far near',
    'clouds': 'direction humidity mean_size speed',
    'collision': 'density laser_retro',
    'cone': 'length radius',
    'constraints': 'cfm contact_max_correcting_vel contact_surface_layer erp '
                   'split_impulse_penetration_threshold',
    'contact': 'dissipation dynamic_friction elastic_modulus override_impact_capture_velocity '
               'override_stiction_transition_velocity plastic_coef_restitution '
               'plastic_impact_velocity poissons_ratio static_friction stiffness viscous_friction',
    'custom_function': 'c1 c2 c3 f',
    'cylinder': 'length radius',
    'dart': 'bone_attachment damping flesh_mass_fraction stiffness',
    'distortion': 'k1 k2 k3 p1 p2',
    'dynamics': 'damping friction spring_reference spring_stiffness',
    'fluid_added_mass': 'pp pq pr qq qr rr xp xq xr xx xy xz yp yq yr yy yz zp zq zr zz',
    'fog': 'density end start',
    'horizontal': 'max_angle min_angle resolution',
    'inertia': 'ixx ixy ixz iyy iyz izz',
    'inertial': 'density mass',
    'intrinsics': 'cx cy fx fy s',
    'joint': 'gearbox_ratio screw_thread_pitch thread_pitch',
    'lens': 'cutoff_angle',
    'light': 'intensity',
    'limit': 'cfm dissipation effort erp lower stiffness upper velocity',
    'logical_camera': 'aspect_ratio far horizontal_fov near',
    'material': 'render_order shininess',
    'mimic': 'multiplier offset reference',
    'noise': 'bias_mean bias_stddev dynamic_bias_correlation_time dynamic_bias_stddev mean '
             'precision stddev',
    'ode': 'bounce cfm erp fudge_factor kd kp max_force max_vel min_depth mu mu2 slip slip1 slip2 '
           'soft_cfm soft_erp velocity',
    'particle_emitter': 'duration lifetime max_velocity min_velocity particle_scatter_ratio rate '
                        'scale_rate',
    'physics': 'max_step_size real_time_factor real_time_update_rate',
    'polyline': 'height',
    'projection': 'p_cx p_cy p_fx p_fy tx ty',
    'projector': 'far_clip fov near_clip',
    'range': 'max min resolution',
    'road': 'width',
    'script': 'delay_start',
    'sensor': 'update_rate',
    'simbody': 'accuracy max_transient_velocity min_step_size',
    'skin': 'scale',
    'sky': 'sunrise sunset time',
    'solver': 'min_step_size sor',
    'sonar': 'max min radius',
    'sphere': 'radius',
    'spherical_coordinates': 'elevation heading_deg latitude_deg longitude_deg '
                             'surface_axis_equatorial surface_axis_polar',
    'spot': 'falloff inner_angle outer_angle',
    'suspension': 'cfm erp',
    'texture': 'size',
    'torsional': 'coefficient patch_radius surface_radius',
    'track_visual': 'max_dist min_dist',
    'transceiver': 'frequency gain max_frequency min_frequency power sensitivity',
    'velocity_decay': 'angular linear',
    'vertical': 'max_angle min_angle resolution',
    'visual': 'laser_retro transparency',
    'waypoint': 'time',
}

_PAIRS = {
    'distortion': 'center',
    'plane': 'size',
    'polyline': 'point',
}

_TRIPLES = {
    'axis': 'xyz',
    'axis2': 'xyz',
    'box': 'size',
    'bullet': 'fdir1',
    'distribution': 'step',
    'ellipsoid': 'radii',
    'heightmap': 'pos size',
    'light': 'direction',
    'mesh': 'scale',
    'model': 'scale',
    'ode': 'fdir1',
    'orientation_reference_frame': 'custom_rpy grav_dir_x',
    'particle_emitter': 'particle_size size',
    'plane': 'normal',
    'road': 'point',
    'track_visual': 'xyz',
    'wind': 'linear_velocity',
    'world': 'gravity magnetic_field',
}

_COLORS = {
    'clouds': 'ambient',
    'fog': 'color',
    'light': 'diffuse specular',
    'material': 'ambient diffuse emissive specular',
    'particle_emitter': 'color_end color_start',
    'scene': 'ambient background',
}

SMALLEST_VALUES = {
    ('bounce', 'restitution_coefficient'): 0.0,
    ('bullet', 'friction'): 0.0,
    ('bullet', 'friction2'): 0.0,
    ('camera', 'horizontal_fov'): 0.1,
    ('clip', 'far'): 0.1,
    ('clip', 'near'): 0.0,
    ('clouds', 'direction'): 0.0,
    ('clouds', 'humidity'): 0.0,
    ('clouds', 'mean_size'): 0.0,
    ('clouds', 'speed'): 0.0,
    ('fog', 'density'): 0.0,
    ('fog', 'end'): 0.0,
    ('fog', 'start'): 0.0,
    ('lens', 'cutoff_angle'): 0.0,
    ('lens', 'env_texture_size'): 4.0,
    ('noise', 'bias_stddev'): 0.0,
    ('noise', 'dynamic_bias_stddev'): 0.0,
    ('noise', 'stddev'): 0.0,
    ('ode', 'mu'): 0.0,
    ('ode', 'mu2'): 0.0,
    ('particle_emitter', 'max_velocity'): 0.0,
    ('particle_emitter', 'min_velocity'): 0.0,
    ('particle_emitter', 'rate'): 0.0,
    ('particle_emitter', 'scale_rate'): 0.0,
    ('torsional', 'coefficient'): 0.0,
    ('torsional', 'patch_radius'): 0.0,
    ('torsional', 'surface_radius'): 0.0,
}
"""The least value of elements that have one, by the parent's tag and their own."""

LARGEST_VALUES = {
    ('bounce', 'restitution_coefficient'): 1.0,
    ('camera', 'horizontal_fov'): 6.283186,
    ('clouds', 'direction'): 3.1456,
    ('clouds', 'humidity'): 1.0,
    ('clouds', 'mean_size'): 1.0,
    ('lens', 'cutoff_angle'): 3.141592653,
    ('lens', 'env_texture_size'): 2048.0,
}
"""The greatest value of elements that have one, by the parent's tag and their own."""

VALUE_TYPES: dict[str, dict[str, ValueType]] = {}
"""Type of the value of each element, by the parent's tag and its own."""

for _value_type, _table in (
    (ValueType.BOOLEAN, _BOOLEANS),
    (ValueType.INTEGER, _INTEGERS),
    (ValueType.NUMBER, _NUMBERS),
    (ValueType.TWO_NUMBERS, _PAIRS),
    (ValueType.THREE_NUMBERS, _TRIPLES),
    (ValueType.COLOR, _COLORS),
):
    for _parent, _tags in _table.items():
        VALUE_TYPES.setdefault(_parent, {}).update(dict.fromkeys(_tags.split(), _value_type))

VALUE_TAGS = tuple(dict.fromkeys(_tag for _types in VALUE_TYPES.values() for _tag in _types))
"""Tags of elements whose value has a type, at least in some parents."""

COUNTS_OF_NUMBERS = {ValueType.TWO_NUMBERS: 2, ValueType.THREE_NUMBERS: 3}
"""How many numbers a value has, where that is more than one."""

AXES = frozenset({('axis', 'xyz'), ('axis2', 'xyz')})
"""Elements that hold a direction, by the parent's tag and their own."""

MATERIAL_TAGS = ('script', 'shader')
"""Tags of what has to be whole in a material."""

HOLDERS_OF_POSES = ('waypoint', 'camera', 'audio_source', 'population')
"""Tags of elements whose poses are no frames' poses."""

REQUIRED_ATTRIBUTES = {
    'actor': 'name',
    'battery': 'name',
    'gripper': 'name',
    'light': 'type',
    'mimic': 'joint',
    'particle_emitter': 'type',
    'plugin': 'filename',
    'population': 'name',
    'road': 'name',
    'sensor': 'type',
    'shader': 'type',
}
"""Attributes that must be there, besides the names of elements that have a pose."""

CHECKED_TAGS = tuple(dict.fromkeys((
    *VALUE_TAGS, *REQUIRED_ATTRIBUTES, *MATERIAL_TAGS, *HOLDERS_OF_POSES, 'state')))
"""Tags of all elements with values that are listed here."""
