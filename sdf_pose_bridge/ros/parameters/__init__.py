# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the node: declarations, the values that are given, and rules for them."""
