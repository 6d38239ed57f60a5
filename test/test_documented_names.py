# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Each name that users type or read has its place in the page of the documentation about it."""

from importlib import import_module
import re
import xml.etree.ElementTree as ET

from commands import COMMANDS
from folders import ROOT
import pytest

import sdf_pose_bridge
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.formats import POSE_FORMATS, ROTATION_FORMATS
from sdf_pose_bridge.ros.cdr import POSE_TYPES
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.shape_types import SHAPE_TYPES
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.specification import JOINT_TYPES
from sdf_pose_bridge.sdformat.versions import NEWEST, OLDEST


def text_of(path):
    return (ROOT / path).read_text()


def names_in(page):
    """Return the words between back quotes, also those of commands: the first two."""
    text = text_of(f'docs/{page}')
    return {*re.findall(r'`([^`\n]+)`', text), *re.findall(r'`(\S+)[^`\n]*`', text)}


def text_about(command):
    """Return the section, the rows and the paragraphs of the page that are about a command."""
    options, *sections = re.split('^## ', text_of('docs/command_line.md'), flags=re.MULTILINE)
    named = {text.partition('\n')[0]: text for text in sections}
    rows = [row for row in options.splitlines() if row.startswith('|')
            and f'`{command}`' in (re.findall(r'; for (`.*`) \|', row) or [f'`{command}`'])[0]]
    formats = named['Output for other programs'].split('\n\n')
    return '\n'.join([named[command], *rows, *(each for each in formats if f'`{command}' in each)])


def names_of_policy(tag):
    root = ET.parse(ROOT / 'config/sros2_policy.xml').getroot()
    return {element.text for element in root.iter(tag)}


def all_errors(error):
    return {error.code}.union(*map(all_errors, error.__subclasses__()))


NAMES = {
    'ros_interface.md': sorted(
        name.replace('*/', '<model>/').replace('*', '<frame>')
        for name in names_of_policy('service') | names_of_policy('topic')
        if not re.search('parameter|type_desc|^/(rosout|clock)$', name)),
    'gazebo.md': [each.rpartition('/')[2] for each in POSE_TYPES],
    'pose_formats.md': [*POSE_FORMATS, *ROTATION_FORMATS],
    'joints.md': JOINT_TYPES,
    'what_is_read.md': SHAPE_TYPES,
    'errors.md': sorted(all_errors(SdfError) - {'ERROR'}),
}


@pytest.mark.parametrize('page', [
    'README.md', 'docs/comparison.md', 'docs/errors.md', 'docs/what_is_read.md'])
def test_versions_of_sdformat(page):
    text = text_of(page)
    assert set(re.findall(r'\b1\.\d+ to 1\.\d+\b', text)) == {f'{OLDEST} to {NEWEST}'}


@pytest.mark.parametrize('command', COMMANDS)
def test_command(command):
    text = text_of('docs/command_line.md')
    assert f'sdf_pose {command} ' in text


@pytest.mark.parametrize(('command', 'option'), [
    (command, option) for command, parser in COMMANDS.items()
    for option in parser._option_string_actions if option not in ('-h', '--help')])
def test_option(command, option):
    assert re.search(rf'(?<![\w-]){option}(?![\w-])', text_about(command))


@pytest.mark.parametrize(('page', 'name'), [
    (page, name) for page, names in NAMES.items() for name in names])
def test_name(page, name):
    assert name in names_in(page)


@pytest.mark.parametrize('name', POSE_FORMATS)
def test_format_of_the_service(name):
    text = text_of('sdf_pose_bridge_interfaces/srv/ConvertPoses.srv')
    assert re.search(rf'^#   {name} ', text, re.MULTILINE)


def test_the_page_about_formats_has_their_numbers():
    listed = dict(re.findall(
        r'^\| `(\w+)` \| (\d+) \|', text_of('docs/pose_formats.md'), re.MULTILINE))
    assert 'sdf_rpy' in listed
    assert listed == {name: str(POSE_FORMATS[name].row_length) for name in listed}


@pytest.mark.parametrize('source_format', SourceFormat, ids=lambda each: each.title)
def test_source_format(source_format):
    assert source_format.title in text_of('docs/what_is_read.md')


@pytest.mark.parametrize('kind', [
    kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD, Kind.ACTOR)])
def test_kind(kind):
    text = text_of('docs/ros_interface.md')
    assert kind.label in next(line for line in text.splitlines() if line.startswith('| `kinds`'))


def test_the_page_of_the_api_lists_all_exported_names_and_modules_that_exist():
    text = text_of('docs/python_api.md')
    listed = re.findall(r'auto(?:function|class|exception):: sdf_pose_bridge\.(\w+)$', text, re.M)
    assert sorted(listed) == sorted(sdf_pose_bridge.__all__)
    for module, members in re.findall(r'automodule:: (\S+)\n +:members: *(.*)', text):
        assert all(hasattr(import_module(module), name) for name in re.findall(r'\w+', members))


def test_parameter():
    pytest.importorskip('rclpy', reason='needs ROS 2')
    from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS
    assert DECLARATIONS.keys() <= names_in('ros_interface.md')
