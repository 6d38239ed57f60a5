# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations, poses and their formats; independent of SDFormat and of ROS."""
