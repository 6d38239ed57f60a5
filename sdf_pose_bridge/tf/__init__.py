# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From a Scene to the frames of TF: ids, parents, transforms; free of ROS."""
