# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The list of the commands, and arguments of each."""

import argparse

from sdf_pose_bridge.cli.main import new_parser

COMMANDS = next(
    each.choices for each in new_parser()._actions
    if isinstance(each, argparse._SubParsersAction))

ARGUMENTS = {
    **{name: ['m.sdf'] for name in ('check', 'poses', 'tree', 'graph', 'urdf', 'gz_bridge')},
    'view': ['m.sdf', '-o', 'page.html'], 'diff': ['m.sdf', 'm.sdf'],
    'convert': ['--from', 'sdf_rpy', '--to', 'sdf_quat_xyzw'],
    'set': ['m.sdf', 'm::l', '1', '0', '0', '0', '0', '0', '--dry-run'],
}
"""Arguments of each command; it reads nothing else."""
