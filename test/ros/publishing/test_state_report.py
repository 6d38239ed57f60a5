# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The line about joints that are not reported."""

from sdf_pose_bridge.ros.publishing.state_report import StateReport


def test_joints_that_nobody_reports_are_counted():
    line = StateReport(['j0', 'j1', 'j2'], topics=('/a', '/b')).line_about_unreported()
    assert line.startswith('no message has named 3 joints yet, for example "j0";')
    assert line.endswith(
        ' until a message on /a or /b names the joint, or with unreported_joints:=zero')
