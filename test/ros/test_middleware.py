# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The profile of Fast DDS is used where the user has chosen nothing else."""

from pathlib import Path
import xml.etree.ElementTree as ET

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from sdf_pose_bridge.ros.middleware import LOCAL_PROFILES
from sdf_pose_bridge.ros.middleware import NEW_PROFILES_VARIABLE
from sdf_pose_bridge.ros.middleware import PROFILE
from sdf_pose_bridge.ros.middleware import PROFILES_VARIABLE
from sdf_pose_bridge.ros.middleware import use_profile

ROOT = Path(__file__).resolve().parents[2]
JAZZY = {'ROS_DISTRO': 'jazzy'}


@pytest.mark.parametrize(('chosen', 'reason'), [
    ({PROFILES_VARIABLE: 'mine.xml'}, f'{PROFILES_VARIABLE} is set'),
    ({PROFILES_VARIABLE: ''}, f'{PROFILES_VARIABLE} is set'),
    ({NEW_PROFILES_VARIABLE: 'mine.xml'}, f'{NEW_PROFILES_VARIABLE} is set'),
    ({NEW_PROFILES_VARIABLE: ''}, f'{NEW_PROFILES_VARIABLE} is set'),
    ({'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp'}, 'the middleware is rmw_cyclonedds_cpp'),
    ({'ROS_DISTRO': 'kilted'}, 'it is for ROS 2 jazzy, and ROS_DISTRO is "kilted"'),
])
def test_a_choice_of_the_user_is_left_alone(chosen, reason):
    environment = {**JAZZY, **chosen}
    assert use_profile(environment).endswith(f'is not used: {reason}')
    assert environment == {**JAZZY, **chosen}


def test_profiles_in_the_working_directory_are_left_alone(tmp_path, monkeypatch):
    (tmp_path / LOCAL_PROFILES).touch()
    monkeypatch.chdir(tmp_path)
    environment = dict(JAZZY)
    assert f'{LOCAL_PROFILES} is in the working directory' in use_profile(environment)
    assert environment == JAZZY


@pytest.mark.parametrize('prefixes', ['', '/nonexistent'])
def test_without_an_installed_package_there_is_no_profile(monkeypatch, prefixes):
    monkeypatch.setenv('AMENT_PREFIX_PATH', prefixes)
    environment = dict(JAZZY)
    assert 'the package is not installed' in use_profile(environment)
    assert environment == JAZZY


@pytest.mark.parametrize('chosen', [
    {}, {'RMW_IMPLEMENTATION': ''}, {'RMW_IMPLEMENTATION': 'rmw_fastrtps_cpp'},
    {'RMW_IMPLEMENTATION': 'rmw_fastrtps_dynamic_cpp'},
])
def test_with_fast_dds_and_no_other_choice_it_is_used(tmp_path, monkeypatch, chosen):
    monkeypatch.chdir(tmp_path)
    environment = {**JAZZY, **chosen}
    sentence = use_profile(environment)
    profile = Path(environment[PROFILES_VARIABLE])
    assert profile.parts[-2:] == Path(PROFILE).parts
    assert profile.is_file()
    assert str(profile) in sentence
    assert f'{NEW_PROFILES_VARIABLE} to an empty string' in sentence


def test_the_profile_is_the_default_of_participants():
    profiles = ET.parse(ROOT / PROFILE).getroot()
    (participant,) = profiles
    assert participant.get('is_default_profile') == 'true'


def test_the_thread_of_the_throughput_controller_sleeps_long():
    (period,) = ET.parse(ROOT / PROFILE).getroot().findall('.//{*}periodMillisecs')
    assert int(period.text) >= 1000  # with 1 ms an idle node takes 4 % of a core
