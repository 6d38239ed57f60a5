# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Declarations of parameters: what settings of them mean together."""

import pytest

from sdf_pose_bridge.ros.given_parameters import settings_from_values
from sdf_pose_bridge.ros.parameters import DECLARATIONS
from sdf_pose_bridge.tf.joint_positions import UnreportedJoints
from sdf_pose_bridge.tf.tree import TfOptions


def test_what_is_read_has_all_that_a_load_needs():
    settings = settings_from_values({
        'sdf_file': 'cell.sdf', 'kinds': ['auto'], 'frame_prefix': 'r/',
        'unreported_joints': 'zero', 'use_joint_states': True})
    request = settings.load_request
    assert request.source == 'cell.sdf'
    assert request.tf_options == TfOptions(kinds=None, frame_prefix='r/', use_joint_states=True)
    assert request.unreported_joints is UnreportedJoints.ZERO


@pytest.mark.parametrize('name', DECLARATIONS)
def test_the_default_is_a_value_that_is_allowed(name):
    DECLARATIONS[name].convert(DECLARATIONS[name].default)
