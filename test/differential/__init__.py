# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Random SDFormat files, resolved by this package and by libsdformat, and compared."""
