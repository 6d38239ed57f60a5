# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""URDF files: robots, and their conversion to SDFormat."""
