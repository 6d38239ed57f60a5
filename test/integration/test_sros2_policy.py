# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the policy for SROS 2 allows what a running bridge offers."""

from fnmatch import fnmatchcase
from pathlib import Path

from lxml import etree
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from ament_index_python.packages import get_package_share_directory
from changes import BRIDGE
from changes import world


@pytest.mark.parametrize(('what', 'action', 'kind', 'last'), [
    ('topic', 'publish', 'publisher', '/diagnostics'),
    ('topic', 'subscribe', 'subscriber', '/clock'),
    ('service', 'reply', 'service', f'{BRIDGE}/set_parameters_atomically'),
])
def test_the_policy_allows_what_the_node_offers(
        start_bridge, start_listener, tmp_path, what, action, kind, last):
    path = tmp_path / 'cell.sdf'
    path.write_text(world(1), encoding='utf-8')
    start_bridge('--ros-args', '-p', f'sdf_file:={path}', '-p', 'use_sim_time:=true'
                 ).wait_until_started()
    listener = start_listener()
    names_and_types = getattr(listener.node, f'get_{kind}_names_and_types_by_node')

    def names():
        try:
            return [name for name, _ in names_and_types(BRIDGE[1:], '/')]
        except RuntimeError:  # the node is not known yet
            return []

    listener.wait(lambda: last in names(), names)
    policy = etree.parse(Path(
        get_package_share_directory('sdf_pose_bridge'), 'config/sros2_policy.xml'))
    allowed = policy.xpath(
        f'//enclave[@path="{BRIDGE}"]//{what}s[@{action}="ALLOW"]/{what}/text()')
    refused = [name for name in names() if not any(
        fnmatchcase(name, each.replace('~', BRIDGE)) for each in allowed)]
    assert not refused
