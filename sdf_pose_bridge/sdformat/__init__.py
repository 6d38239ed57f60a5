# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From files to the table of their elements: XML, versions, includes, grammar."""
