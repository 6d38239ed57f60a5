# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From the table of elements to resolved poses: name scopes, frame graph, Scene."""
