# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Limits have the same value in the documentation as in the code."""

import re

from folders import ROOT
import pytest

from sdf_pose_bridge.errors import shortened_message
from sdf_pose_bridge.limited_process import WAITING_S
from sdf_pose_bridge.process_limits import FOR_FILES
from sdf_pose_bridge.sdformat.limits import DEFAULT_LIMITS

pytest.importorskip('rclpy', reason='needs ROS 2')

from sdf_pose_bridge.ros.cdr import MOST_BYTES
from sdf_pose_bridge.ros.following.simulator import MOST_OTHERS
from sdf_pose_bridge.ros.node.services import MOST_NUMBERS
from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS
from sdf_pose_bridge.ros.parameters.rules import (
    LOWEST_RATE,
    MOST_TOPICS,
    MOST_VALUES,
)

MEGABYTE = 1_000_000
UNITS = {
    'bytes_read': lambda number: f'{number >> 20} MB', 'processor_s': '{} s'.format,
    'memory_bytes': lambda number: f'{number // (1000 * MEGABYTE)} GB'}


@pytest.mark.parametrize('name', DEFAULT_LIMITS._fields)
def test_a_limit_of_a_load_is_in_the_table(name):
    text = UNITS.get(name, '{:,}'.format)(getattr(DEFAULT_LIMITS, name))
    table = (ROOT / 'docs/security.md').read_text().partition('| limit | value |')[2]
    assert re.search(rf'(\| |; |at most ){text}( \||;)', table.partition('\n\n')[0]), text


@pytest.mark.parametrize(('page', 'words'), [
    ('security.md',
     f'{FOR_FILES.processor_s:g} s, and {FOR_FILES.seconds_per_megabyte:g} s for each megabyte'),
    ('security.md', f'elapsed time {WAITING_S:g} s more'),
    ('security.md', f'| {FOR_FILES.memory_bytes // MEGABYTE} MB, and '),
    ('security.md', f'{FOR_FILES.memory_bytes_per_megabyte // MEGABYTE} MB for each megabyte'),
    ('security.md', f'parameters set in one call | {MOST_VALUES} |'),
    ('security.md', f'topics of joint states, parameters set in one call | {MOST_TOPICS} |'),
    ('security.md', f'message of `joint_states` | {MOST_NUMBERS:,}; {MOST_BYTES // MEGABYTE} MB'),
    ('joints.md', f'at most {MOST_TOPICS} topics'),
    ('errors.md', f'a world of more than {MOST_TOPICS} frames'),
    ('ros_interface.md', f'with more than {MOST_TOPICS} frames'),
    ('ros_interface.md', f'at most {MOST_NUMBERS:,} numbers'),
    ('ros_interface.md', f'other entity of the simulator, at most {MOST_OTHERS} |'),
])
def test_a_limit_is_in_the_sentence_about_it(page, words):
    assert words in (ROOT / 'docs' / page).read_text()


@pytest.mark.parametrize('name', [
    name for name, declaration in DECLARATIONS.items() if declaration.maximum is not None])
def test_a_range_of_rates_is_on_the_page_and_in_the_params_file(name):
    highest = DECLARATIONS[name].maximum
    page = (ROOT / 'docs/ros_interface.md').read_text()
    assert re.search(rf'\| `{name}` \|.*\({LOWEST_RATE} to {highest:g}\)', page)
    comment = (ROOT / 'config/bridge.yaml').read_text().partition(f'\n    {name}:')[0]
    words = ' '.join(comment.rpartition('\n\n')[2].replace('#', '').split())
    assert f'from {LOWEST_RATE} to {highest}' in words


def test_the_longest_message_is_in_the_sentence_about_it():
    page = (ROOT / 'docs/security.md').read_text()
    message = 'x' * int(re.search(r'escapes and at most (\d+) characters', page)[1])
    assert shortened_message(message) == message
    assert len(shortened_message(f'{message}x')) <= len(message)
