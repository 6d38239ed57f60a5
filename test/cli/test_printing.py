# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses in the units that a command prints, and tables on terminals."""

import math
from pathlib import Path
import re

import pytest

from sdf_pose_bridge.cli.printing import DEGREES, MILLIMETRES, Units
from sdf_pose_bridge.geometry.poses import Pose


def test_pose_is_written_in_units():
    pose = Pose(1.25, -0.00001, 3.0, 0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    assert Units().texts(pose) == [
        '1.2500', '0.0000', '3.0000', '0.0000', '0.0000', '1.5708']
    assert Units(MILLIMETRES, DEGREES).texts(pose) == [
        '1250.0', '0.0', '3000.0', '0.00', '0.00', '90.00']


COMMANDS = ('check', 'poses', 'tree', 'graph', 'view', 'urdf', 'convert', 'diff', 'set')


TABLES = [
    ('tree', '{cell}'), ('tree', '--scope', '{cell}'), ('poses', '{cell}', '--radians'),
    ('poses', '--mm', '{cell}'), ('diff', '{moved}', '{cell}')]
HELP = [(command, '--help') for command in COMMANDS]


@pytest.mark.parametrize(('columns', 'arguments'), [
    *((80, arguments) for arguments in (*TABLES, *HELP)), (120, TABLES[0]), (120, HELP[0])])
def test_lines_are_as_long_as_those_of_the_terminal(on_terminal, files, columns, arguments):
    cell = Path(__file__).resolve().parents[2] / 'examples/work_cell.sdf'
    moved = files / 'moved.sdf'
    moved.write_text(cell.read_text().replace('<pose>-1.2 -1.5 0', '<pose>-1.2 -1.6 0'))
    text = on_terminal(columns, *(each.format(cell=cell, moved=moved) for each in arguments))
    lines = re.sub('\x1b\\[[0-9]*m', '', text).splitlines()
    assert len(lines) > 2
    assert max(map(len, lines)) <= columns
