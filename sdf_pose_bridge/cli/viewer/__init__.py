# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Show a scene in a browser, by viser; and the meshes in it, by trimesh."""
