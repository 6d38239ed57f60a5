# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The params file in config/ has every parameter of the node with its default."""

import re

from folders import ROOT
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')
pytest.importorskip('yaml', reason='PyYAML is not installed')

import yaml

from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS
from sdf_pose_bridge.ros.parameters.given import settings_from_node

FILE = ROOT / 'config/bridge.yaml'
DEFAULTS = {name: declaration.default for name, declaration in DECLARATIONS.items()}


def values_in_file():
    (node, entries), = yaml.safe_load(FILE.read_text()).items()
    assert node == '/**'
    assert entries.keys() == {'ros__parameters'}
    return entries['ros__parameters']


def test_there_is_every_parameter_that_has_a_default_and_no_other():
    # A running node, which takes the file too, cannot be given another value of those.
    only_at_the_start = {
        name for name, declaration in DECLARATIONS.items() if declaration.is_read_only}
    assert values_in_file().keys() == (
        DEFAULTS.keys() - {'sdf_file', 'robot_description'} - only_at_the_start)


def test_a_running_node_keeps_its_file():
    assert '    # sdf_file: ' in FILE.read_text()


@pytest.mark.parametrize('name', values_in_file())
def test_a_value_is_the_default(name):
    value = values_in_file()[name]
    assert value == DEFAULTS[name]
    assert type(value) is type(DEFAULTS[name])


def defaults_on_the_page():
    """Return the text of each default, by the names in the row."""
    _, *tables = (ROOT / 'docs/ros_interface.md').read_text().split('| name | default | meaning |')
    rows = [row.split(' | ') for each in tables for row in each.partition('\n\n')[0].splitlines()]
    return {name: row[1] for row in rows for name in re.findall(r'`(\w+)`', row[0])}


@pytest.mark.parametrize('name', sorted(DEFAULTS.keys() - {'sdf_file', 'robot_description'}))
def test_the_page_about_parameters_has_the_default(name):
    default = DEFAULTS[name]
    words = default if isinstance(default, list) else [
        str(default).lower() if isinstance(default, bool) else str(default)]
    shown = re.sub('[][`\'"]', '', defaults_on_the_page()[name])
    assert shown == (', '.join(words) or 'empty')


def test_a_node_takes_it(make_node, tmp_path):
    copy = tmp_path / 'bridge.yaml'
    text = FILE.read_text()
    text = text.replace('# sdf_file: package://my_robot/worlds/', 'sdf_file: ')
    copy.write_text(text)
    with_file = make_node('with_file', '--params-file', str(copy))
    without = make_node('without', '-p', 'sdf_file:=cell.sdf')
    assert settings_from_node(with_file).values == settings_from_node(without).values
