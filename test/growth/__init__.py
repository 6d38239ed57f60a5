# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How the time and the memory of a load grow with what is repeated or nested in a file."""
