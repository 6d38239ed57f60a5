# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the policy for SROS 2 allows what a running bridge offers."""

from fnmatch import fnmatchcase
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from changes import BRIDGE, world
from lxml import etree
import pytest


@pytest.fixture(scope='module')
def listener(start_shared_bridge, start_shared_listener, tmp_path_factory):
    """Start a bridge, and a listener beside it."""
    path = tmp_path_factory.mktemp('policy') / 'cell.sdf'
    path.write_text(world(1))
    start_shared_bridge(
        sdf_file=path, use_sim_time=True, allow_set_pose=True).wait_until_started()
    return start_shared_listener()


@pytest.mark.parametrize(('what', 'action', 'kind', 'last'), [
    ('topic', 'publish', 'publisher', '/diagnostics'),
    ('topic', 'subscribe', 'subscriber', '/clock'),
    ('service', 'reply', 'service', f'{BRIDGE}/set_parameters_atomically'),
])
def test_the_policy_allows_what_the_node_offers(listener, what, action, kind, last):
    def names():
        return listener.names_and_types(kind, BRIDGE).keys()

    listener.wait(lambda: last in names(), names)
    policy = etree.parse(Path(
        get_package_share_directory('sdf_pose_bridge'), 'config/sros2_policy.xml'))
    allowed = policy.xpath(
        f'//enclave[@path="{BRIDGE}"]//{what}s[@{action}="ALLOW"]/{what}/text()')
    refused = [name for name in names() if not any(
        fnmatchcase(name, each.replace('~', BRIDGE)) for each in allowed)]
    assert not refused
