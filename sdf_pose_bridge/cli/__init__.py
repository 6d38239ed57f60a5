# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line ``sdf_pose``; needs no ROS."""
