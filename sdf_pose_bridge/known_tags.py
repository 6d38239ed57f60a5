# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The tags of all elements that are looked at many at a time."""

from __future__ import annotations

from sdf_pose_bridge.grammar import CHECKED_TAGS
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.tag_names import TagNames

KNOWN_TAGS = TagNames(tuple(dict.fromkeys((
    'sdf', 'include', *(kind.label for kind in Kind if kind is not Kind.ROOT),
    'pose', 'static', 'parent', 'child', 'axis', 'axis2', 'xyz', 'use_parent_model_frame',
    'gz_frame_id', 'ignition_frame_id', 'optical_frame_id', *CHECKED_TAGS))))
