# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Tests have the same environment whatever the caller's shell has."""

import os
from pathlib import Path
import sys

from command_line import completed
from own_environment import environment_of_tests
import pytest

HOSTILE = {
    'GIT_DIR': '/nowhere', 'HOME': '/nowhere', 'PIP_USER': '1', 'http_proxy': 'http://nobody:9',
    'ROS_LOCALHOST_ONLY': '1', 'RCUTILS_COLORIZED_OUTPUT': '1', 'COLUMNS': '40', 'LC_ALL': 'de_DE',
    'FASTRTPS_DEFAULT_PROFILES_FILE': '/nowhere', 'GZ_SIM_RESOURCE_PATH': '/nowhere'}


@pytest.mark.parametrize('name', [*HOSTILE, 'XPATH', 'PATHX'])
def test_other_variables_do_not_come_in(name):
    assert environment_of_tests({name: 'hostile'}, 'home') == environment_of_tests({}, 'home')


@pytest.mark.parametrize('name', ['PATH', 'ROS_DISTRO', 'RMW_FOLDER', 'LONG', 'COVERAGE_FILE'])
def test_variables_of_make_and_of_the_environment_come_in(name):
    assert environment_of_tests({name: 'value'}, 'home')[name] == 'value'


def test_environment_is_the_one_of_tests():
    assert [name for name, value in HOSTILE.items() if os.environ.get(name) == value] == []
    assert Path.home().name.startswith('sdf_pose_bridge_home_')


def test_run_of_tests_has_it_in_each_process(tmp_path):
    name = test_environment_is_the_one_of_tests.__name__
    done = completed(
        [sys.executable, '-m', 'pytest', '-p', 'no:cacheprovider', f'{__file__}::{name}'],
        env={**os.environ, **HOSTILE, 'TMPDIR': str(tmp_path)}, cwd='/')
    assert done.returncode == 0, done.stdout
    # The folder HOME has been removed.
    assert [path.name for path in tmp_path.iterdir()] in ([], [f'pytest-of-{tmp_path.owner()}'])
