# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Rotations, poses and their formats; independent of SDFormat and of ROS.

- :mod:`~sdf_pose_bridge.geometry.rotations`: convert between roll-pitch-yaw, quaternion, matrix
- :mod:`~sdf_pose_bridge.geometry.sequences`: angles about three axes, one after the other
- :mod:`~sdf_pose_bridge.geometry.poses`: compose and invert poses, and move them about axes
- :mod:`~sdf_pose_bridge.geometry.chains`: follow chains of pointers, multiply poses along them
- :mod:`~sdf_pose_bridge.geometry.formats`: the formats of poses, and conversions between them
- :mod:`~sdf_pose_bridge.geometry.pose_texts`: read poses that are typed or pasted
- :mod:`~sdf_pose_bridge.geometry.units`: units, and doubts about those of numbers
- :mod:`~sdf_pose_bridge.geometry.formulas`: evaluate formulas for floats and for arrays
"""
