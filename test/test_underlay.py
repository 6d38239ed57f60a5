# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The environment's script refuses in one sentence; setup.bash behaves well in any shell."""

import os
from pathlib import Path
import platform
import re
import shutil
import subprocess
import sys
import tempfile

from command_line import completed
from folders import ROOT
import needs
import pytest

SHELL_TOOLS = ('bash', 'dirname', 'env', 'head')
DISTRO = os.environ.get('ROS_DISTRO', 'jazzy')
OTHER_DISTRO = 'kilted' if DISTRO == 'jazzy' else 'jazzy'
SUFFIX = '-'.join(['', *(name for name in (DISTRO, os.environ.get('VERSIONS')) if name)])
SUFFIX = SUFFIX.removeprefix('-jazzy')
"""Of the folders of the environment that runs these tests."""

# The interpreter beneath this virtual environment, as the script would be given it.
PYTHON = Path(sys.base_prefix, f'bin/python3.{sys.version_info.minor}')

needs_python_of_jazzy = pytest.mark.skipif(
    sys.version_info >= (3, 14), reason='this Python is refused before')
needs_supported_machine = pytest.mark.skipif(
    platform.machine() != 'x86_64' or sys.version_info >= (3, 14),
    reason='this Python or processor is refused before')
pytestmark = pytest.mark.skipif(sys.platform != 'linux', reason='needs Linux')


@pytest.fixture
def plain_folder():
    """A folder with a plain path: tools of ROS, compilers and the linker refuse some TMPDIR."""
    with tempfile.TemporaryDirectory(dir='/tmp') as folder:
        yield Path(folder)


@pytest.fixture
def checkout(plain_folder):
    """Return a folder that has the environment's scripts but no environment."""
    folder = plain_folder / 'checkout'
    shutil.copytree(ROOT / 'underlay', folder / 'underlay')
    shutil.copy(ROOT / 'setup.cfg', folder)
    return folder


@pytest.fixture
def tools(plain_folder):
    """Return a folder with the few commands that a shell script needs, to be a whole PATH."""
    needs.executables_in(plain_folder)
    folder = plain_folder / 'tools'
    folder.mkdir()
    for name in SHELL_TOOLS:
        (folder / name).symlink_to(needs.program(name))
    return folder


def command(folder, name, text):
    file = folder / name
    file.write_text(f'#!{needs.program("bash")}\n{text}\n')
    file.chmod(0o755)
    return file


def make_underlay(checkout, **environment):
    environment = {
        'PATH': os.environ['PATH'], 'SDF_POSE_BRIDGE_ROS_PREFIX': '', **environment}
    return completed(
        [needs.program('bash'), str(checkout / 'underlay/make_underlay')], env=environment,
        stdin=subprocess.DEVNULL)


def assert_refused_with(result, *words):
    sentence = result.stderr.rstrip('\n')
    assert result.returncode == 1, sentence
    assert '\n' not in sentence
    assert sentence.endswith('.') or 'PYTHON=python3.12' in sentence
    for word in words:
        assert word in sentence


def shell(script, **environment):
    return completed(
        [needs.program('bash'), '-c', script], env={**os.environ, **environment},
        stdin=subprocess.DEVNULL)


@pytest.mark.parametrize(('program', 'environment', 'words'), [
    ('echo "not here" >&2; exit 127', {'PYTHON': 'program'}, ['does not run as a', 'not here']),
    *(
        (f'printf {version}', {'PYTHON': 'program'}, [f'Python {version} ', 'PYTHON='])
        for version in ('2.7.18', '3.9.25', '3.14.0', '4.0.0')),
    ('', {'PYTHON': 'python3.99'}, ["'python3.99'", 'no such']),
    ('', {'PATH': 'tools'}, ['no Python 3', 'python3-venv']),
    ('', {'ROS': 'humble'}, ["'humble'", 'jazzy, kilted and lyrical']),
    ('', {'ROS': 'lyrical'}, ['ROS 2 Lyrical is not on PyPI', '/opt/ros/lyrical']),
    ('', {'VERSIONS': 'jammy'}, ["'jammy'", 'only noble']),
    ('', {'ROS': 'kilted', 'VERSIONS': 'noble'}, ["'noble'", 'only noble']),
    ('printf 3.11.9', {'PYTHON': 'program', 'VERSIONS': 'noble'}, [
        'Python 3.11.9 cannot be used: VERSIONS=noble needs Python 3.12;']),
    pytest.param(
        '', {'PATH': 'tools', 'PYTHON': str(PYTHON)}, ['no C compiler', 'build-essential'],
        marks=needs_supported_machine),
    pytest.param(
        'echo "cannot find crt1.o" >&2; exit 1', {'PYTHON': str(PYTHON), 'CC': 'program'},
        ['cannot find crt1.o'], marks=needs_supported_machine),
    pytest.param(
        '', {'PYTHON': str(PYTHON), 'CXX': 'c++-99'}, ["CXX names 'c++-99'"],
        marks=needs_supported_machine),
])
def test_unusable_machine_is_refused_with_the_reason(
        checkout, tools, program, environment, words):
    paths = {'program': str(command(tools, 'program', program)), 'tools': str(tools)}
    assert_refused_with(
        make_underlay(checkout, **{
            name: paths.get(value, value) for name, value in environment.items()}), *words)


@pytest.mark.parametrize(('version', 'is_refused'), [('3.11.9', True), ('3.14.0', False)])
def test_lyrical_has_its_own_range_of_pythons(checkout, tools, tmp_path, version, is_refused):
    (tmp_path / 'setup.bash').touch()
    python = command(tools, 'python', f'[[ $* == *-S* ]] && printf {version}')
    result = make_underlay(
        checkout, ROS='lyrical', PYTHON=str(python), SDF_POSE_BRIDGE_ROS_PREFIX=str(tmp_path))
    assert ('ROS 2 Lyrical needs Python 3.12 to 3.14' in result.stderr) is is_refused


@needs_python_of_jazzy
def test_checkout_in_a_path_with_a_space_is_refused(checkout):
    moved = checkout.rename(checkout.with_name('check out'))
    assert_refused_with(make_underlay(moved, PYTHON=str(PYTHON)), "' '", 'move it')


@needs_python_of_jazzy
def test_ros_installation_that_lacks_packages_is_refused_with_their_names(checkout, tmp_path):
    (tmp_path / 'jazzy').mkdir()
    (tmp_path / 'jazzy/setup.bash').touch()
    result = make_underlay(
        checkout, PYTHON=str(PYTHON), SDF_POSE_BRIDGE_ROS_PREFIX=str(tmp_path / 'jazzy'))
    assert_refused_with(result, 'tf2_msgs', 'ros-jazzy-tf2-msgs')


@pytest.mark.parametrize(('environment', 'words'), [
    ({}, 'make setup'), ({'ROS': 'humble'}, 'humble')])
def test_setup_bash_without_environment_or_with_another_ros_says_so(checkout, environment, words):
    result = shell(f'. {checkout}/underlay/setup.bash', **environment)
    assert (result.returncode, result.stderr.count('\n')) == (1, 1)
    assert words in result.stderr


def test_lock_files_name_no_index():
    locks = sorted((ROOT / 'underlay').glob('*.txt'))
    assert locks
    assert [lock.name for lock in locks if re.search('://|--index-url', lock.read_text())] == []


@pytest.fixture
def built():
    if not (ROOT / f'install{SUFFIX}/local_setup.bash').exists():
        pytest.skip('the environment is not made here')
    return f'. {ROOT}/underlay/setup.bash'


def test_setup_bash_puts_the_environment_first_once_and_silently(built):
    paths = '$PATH $PYTHONPATH $LD_LIBRARY_PATH $AMENT_PREFIX_PATH $CMAKE_PREFIX_PATH'
    result = shell(f"""
        cd /; PATH=/usr/bin:$PATH; set -u  # an unset variable is an error
        {built}; set +u; first="{paths}"; {built}; [[ $first == "{paths}" ]] || echo more
        type -P python; sdf_pose convert --from rpy --to quaternion 0 0 0""")
    assert (result.returncode, result.stderr) == (0, '')
    assert result.stdout.splitlines() == [
        str(ROOT / f'.underlay{SUFFIX}/bin/python'), '0.0 0.0 0.0 1.0']


def test_a_shell_with_the_workspace_alone_has_the_command_line(built):
    workspace = ROOT / f'install{SUFFIX}'
    script = (
        f'. {workspace}/local_setup.bash; type -P sdf_pose; '
        'sdf_pose convert --from rpy --to quaternion 0 0 0')
    result = completed([needs.program('bash'), '-c', script], env={'PATH': os.defpath}, cwd='/')
    assert (result.returncode, result.stderr) == (0, '')
    assert result.stdout.splitlines() == [
        str(workspace / 'sdf_pose_bridge/bin/sdf_pose'), '0.0 0.0 0.0 1.0']


def test_the_node_is_started_with_words_for_a_second_shell(built):
    result = shell(f'{built}; python {ROOT}/underlay/run.py . missing.sdf')
    assert result.returncode == 1
    assert f'\n  . {ROOT}/underlay/setup.bash\n' in result.stderr
    assert 'ask_bridge.py topics' in result.stderr or 'ros2 topic list' in result.stderr


@pytest.mark.parametrize(('environment', 'words'), [
    ({'ROS_DISTRO': OTHER_DISTRO, 'ROS': DISTRO}, f'already has ROS 2 {OTHER_DISTRO}'),
    ({'RCLPY': '/nowhere'}, 'no rclpy'),
    ({'RMW': 'rmw_x', 'RMW_FOLDER': '/nowhere'}, 'no lib/librmw_x.so'),
])
def test_setup_bash_refuses_another_ros_and_an_empty_folder(built, environment, words):
    result = shell(built, **environment)
    assert (result.returncode, result.stderr.count('\n')) == (1, 1)
    assert words in result.stderr


def test_setup_bash_uses_a_given_middleware(built, plain_folder):
    (plain_folder / 'lib').mkdir()
    (plain_folder / 'lib/librmw_x.so').touch()
    result = shell(
        f'{built}; for name in RMW_IMPLEMENTATION LD_PRELOAD AMENT_PREFIX_PATH LD_LIBRARY_PATH; '
        'do echo ${!name%%:*}; done', RMW='rmw_x', RMW_FOLDER=str(plain_folder))
    assert result.stdout.split() == [
        'rmw_x', f'{plain_folder}/lib/librmw_x.so', str(plain_folder), f'{plain_folder}/lib']


def test_setup_bash_puts_a_given_rclpy_before_the_one_of_ros(built, tmp_path):
    (tmp_path / 'rclpy').mkdir()
    (tmp_path / 'rclpy/__init__.py').touch()
    result = shell(
        f'{built}; {built}; python -c "import rclpy; print(rclpy.__file__)"; echo "$PYTHONPATH"',
        RCLPY=str(tmp_path))
    file, paths = result.stdout.splitlines()
    assert file == str(tmp_path / 'rclpy/__init__.py')
    assert paths.split(':').count(str(tmp_path)) == 1
    assert '' not in paths.split(':')
