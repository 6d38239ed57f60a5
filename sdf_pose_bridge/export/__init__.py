# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames for others: a load of the node, URDF, markers, Gazebo's bridge, changed files."""
