# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Each command of the documentation that starts the node does so with the files that it names."""

import shlex

import pytest
from test_documentation import commands, folder  # noqa: F401

from sdf_pose_bridge.cli.main import main

BRIDGE = 'ros2 run sdf_pose_bridge bridge '
ENDS_OR_NEEDS_MORE = ('broken.sdf', '--enclave', ' ...')
"""In commands that are tested elsewhere, or that need an environment of their own."""


@pytest.mark.parametrize('command', [
    each.partition(BRIDGE)[2] for each in commands()
    if BRIDGE in each and not any(text in each for text in ENDS_OR_NEEDS_MORE)])
def test_node_starts(command, folder, start_bridge):  # noqa: F811
    main(['gz_bridge', 'examples/work_cell.sdf', '--node', '-o', 'node.yaml'])
    start_bridge(*shlex.split(command)).wait_until_started()
