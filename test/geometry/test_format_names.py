# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Hints with the nearest formats."""

import pytest

from sdf_pose_bridge.geometry.formats import format_from_name, POSE_FORMATS, PoseFormatError


@pytest.mark.parametrize(('wrong', 'hint'), [
    ('sdf_quat_xzyw', ''), ('sdf_quat_wxyzz', 'sdf_quat_wxyz'),
    ('matrix_major', 'matrix_row_major, franka_matrix'),
    ('matrix_row', 'matrix_row_major'), ('sdf_rpy_degree', 'sdf_rpy_degrees'), ('sdf_ypr', ''),
    ('ur_pose_degrees', ''), ('franka_pose', 'franka_matrix, franka_measured'),
    ('kuka_acb', 'kuka_abc'),
    ('yaskava', 'yaskawa')])
def test_a_hint_has_the_order_and_the_unit_of_the_wrong_name(wrong, hint):
    with pytest.raises(PoseFormatError) as error:
        format_from_name(wrong, POSE_FORMATS)
    assert str(error.value).partition('; near: ')[2].partition(';')[0] == hint
