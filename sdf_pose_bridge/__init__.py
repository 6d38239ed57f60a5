# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Resolve every pose of an SDFormat file as libsdformat does."""
