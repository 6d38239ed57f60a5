# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: parameters, publishers, services and the reload. The only room that imports ROS."""
