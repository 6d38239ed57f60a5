# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The clients in Python and in C++ that users copy from: both log what the bridge answers."""

import signal
import sys

from command_line import completed
from folders import EXAMPLES
import needs
import pytest


@pytest.fixture(scope='module')
def cpp_client(tmp_path_factory):
    """The command of the client in C++, which is compiled here."""
    from ament_index_python.packages import get_package_prefix, PackageNotFoundError
    try:
        get_package_prefix('rclcpp')
    except PackageNotFoundError:
        pytest.skip('needs rclcpp, which is not installed')
    cmake = needs.program('cmake')
    needs.program('c++', 'g++')
    build = tmp_path_factory.mktemp('cpp_client')
    source = ['-S', EXAMPLES / 'cpp_client', '-DCMAKE_COMPILE_WARNING_AS_ERROR=ON']
    for options in ([*source, '-B', build], ['--build', build]):
        done = completed([cmake, *options], timeout=600)
        assert done.returncode == 0, done.stdout + done.stderr
    return [build / 'client']


@pytest.fixture(scope='module')
def python_client():
    return [sys.executable, EXAMPLES / 'python_client.py']


@pytest.fixture(params=['python_client', 'cpp_client'])
def start_client(request, start_program):
    """Starts a client; ``start_client(**parameters)``."""
    command = request.getfixturevalue(request.param)

    def start(**parameters):
        words = [word for key, value in parameters.items() for word in ('-p', f'{key}:={value}')]
        # Where the tests run in the background, SIGINT may be ignored.
        return start_program(['env', '--default-signal=INT', *command, '--ros-args', *words])
    return start


@pytest.fixture(scope='module')
def bridge(start_shared_bridge):
    # With a rate a client asks again where the middleware has lost the first answer to it.
    return start_shared_bridge(
        sdf_file=EXAMPLES / 'work_cell.sdf', publish_rate=1.0).wait_until_started()


def test_it_logs_pose_lookup_and_rotation(bridge, start_client):
    client = start_client(frame='fixture', relative_to='table')
    client.wait_for_line(': fixture in world: xyz ')
    client.wait_for_line(': fixture in table: xyz ')
    client.wait_for_line(': roll pitch yaw: ')
    client.send(signal.SIGINT)
    assert client.wait_for_end() == 0


def test_it_logs_why_a_lookup_was_refused(bridge, start_client):
    start_client(frame='fixture', relative_to='tabel').wait_for_line('"tabel"')


def test_it_ends_while_it_waits_for_the_bridge(start_client):
    client = start_client()
    client.wait_for_line(': waiting for ')
    client.send(signal.SIGINT)
    assert client.wait_for_end() == 0
