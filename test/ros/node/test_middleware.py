# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The profile of Fast DDS is used where the user has chosen nothing else."""

from pathlib import Path
import re
import xml.etree.ElementTree as ET

from folders import ROOT
import pytest

from sdf_pose_bridge.ros.node import middleware
from sdf_pose_bridge.ros.node.middleware import Profile, PROFILES, use_profile

JAZZY = {'ROS_DISTRO': 'jazzy'}
FAST_DDS = [profile for profile in PROFILES if '' in profile.middlewares]
BY_DISTRO = {distro: profile for profile in FAST_DDS for distro in profile.distros}
BOTH = pytest.mark.parametrize('distro', BY_DISTRO)
OLD, NEW = (profile.variable for profile in FAST_DDS)
CASES = [
    pytest.param(profile, {'ROS_DISTRO': distro, **chosen}, id=f'{profile.file}-{distro}-{name}')
    for profile in PROFILES for distro in profile.distros for name in profile.middlewares
    for chosen in ({'RMW_IMPLEMENTATION': name}, {})[:1 if name else 2]]
"""Each profile with each environment in which it is used."""
IN_THE_PIPELINE = re.findall(
    r'rmw: \[?(\w+)', (ROOT / '.github/workflows/pipeline.yml').read_text())


@BOTH
@pytest.mark.parametrize(('chosen', 'reason'), [
    ({OLD: 'mine.xml'}, f'{OLD} is set'),
    ({OLD: ''}, f'{OLD} is set'),
    ({NEW: ''}, f'{NEW} is set'),
    ({'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp'}, 'the middleware is rmw_cyclonedds_cpp'),
    ({'ROS_DISTRO': 'humble'}, 'there is none for ROS_DISTRO "humble"'),
])
def test_a_choice_of_the_user_is_left_alone(distro, chosen, reason):
    environment = {'ROS_DISTRO': distro, **chosen}
    before = dict(environment)
    assert use_profile(environment).endswith(f'is used: {reason}')
    assert environment == before


@pytest.mark.parametrize('name', sorted(
    {*IN_THE_PIPELINE, *(name for each in PROFILES for name in each.middlewares)} - {''}))
def test_the_page_about_middlewares_names_it(name):
    page = (ROOT / 'docs/middlewares.md').read_text()
    assert re.match('rmw_[a-z]+', name)[0] in re.findall('rmw_[a-z]+', page)


@pytest.mark.parametrize('profile', PROFILES, ids=lambda each: each.file)
def test_the_file_of_a_profile_is_in_the_package(profile):
    assert (ROOT / profile.file).is_file()


@pytest.mark.parametrize(
    ('profile', 'environment'), [each for each in CASES if each.values[0].local_file])
def test_profiles_in_the_working_directory_are_left_alone(
        tmp_path, monkeypatch, profile, environment):
    (tmp_path / profile.local_file).touch()
    monkeypatch.chdir(tmp_path)
    given = dict(environment)
    assert f'{profile.local_file} is in the working directory' in use_profile(given)
    assert given == environment


@pytest.mark.parametrize('prefixes', ['', '/nonexistent'])
def test_without_an_installed_package_there_is_no_profile(monkeypatch, prefixes):
    monkeypatch.setenv('AMENT_PREFIX_PATH', prefixes)
    environment = dict(JAZZY)
    assert 'the package is not installed' in use_profile(environment)
    assert environment == JAZZY


@pytest.mark.parametrize(('profile', 'environment'), CASES)
def test_with_its_middleware_and_no_other_choice_it_is_used(
        tmp_path, monkeypatch, profile, environment):
    monkeypatch.chdir(tmp_path)
    given = dict(environment)
    sentence = use_profile(given)
    path = Path(given[profile.variable])
    assert path.parts[-2:] == Path(profile.file).parts
    assert path.is_file()
    assert str(path) in sentence
    assert f'set {profile.variable} to use your own' in sentence


@BOTH
def test_the_profile_is_the_default_of_participants(distro):
    profiles = ET.parse(ROOT / BY_DISTRO[distro].file).getroot()
    (participant,) = profiles
    assert participant.get('is_default_profile') == 'true'


@BOTH
def test_the_thread_that_sends_announcements_sleeps_long(distro):
    root = ET.parse(ROOT / BY_DISTRO[distro].file).getroot()
    (period,) = [*root.findall('.//{*}periodMillisecs'), *root.findall('.//{*}period_ms')]
    assert int(period.text) >= 1000  # with 1 ms an idle node takes 4 % of a core


def test_a_profile_of_another_middleware_is_one_line(monkeypatch):
    cyclone = Profile(
        ('rmw_cyclonedds_cpp',), ('jazzy',), 'config/c.xml', 'CYCLONEDDS_URI', 'c.xml')
    monkeypatch.setattr(middleware, 'PROFILES', (*PROFILES, cyclone))
    environment = {'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp', **JAZZY, OLD: 'mine.xml'}
    assert use_profile(environment).endswith('set CYCLONEDDS_URI to use your own')
    assert environment['CYCLONEDDS_URI'].endswith('config/c.xml')
    assert f'{OLD} is set' in use_profile({**JAZZY, OLD: 'mine.xml'})


def test_the_profile_of_a_middleware_without_a_local_file_is_used(monkeypatch):
    cyclone = Profile(('rmw_cyclonedds_cpp',), ('jazzy',), 'config/c.xml', 'CYCLONEDDS_URI')
    monkeypatch.setattr(middleware, 'PROFILES', (cyclone,))
    environment = {'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp', **JAZZY}
    assert use_profile(environment).endswith('set CYCLONEDDS_URI to use your own')
