#!/usr/bin/env python3
# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Demonstrate the bridge: start it on an example, and print what another process receives.

The exit code is 0 if everything arrived, otherwise 1.
"""

import argparse
import os
from pathlib import Path
import random
import signal
import socket
import subprocess
import sys
import time

from ament_index_python.packages import get_package_prefix, PackageNotFoundError

PACKAGE = 'sdf_pose_bridge'
HERE = Path(__file__).resolve().parent
LISTENER_SECONDS = 30.0
STOP_SECONDS = 10.0


class DemoError(Exception):
    """The demonstration did not work."""


def free_domain() -> tuple[int, socket.socket]:
    """
    Find a ROS domain that no other demonstration uses.

    Each domain has 250 UDP ports from 7400 + 250 * domain. The middleware does not use the sixth
    of them, so a program that binds it reserves the domain among programs that do the same.

    :return: the number of the domain, and the socket that reserves it.
    """
    for domain in random.sample(range(1, 101), 100):
        port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            port.bind(('127.0.0.1', 7405 + 250 * domain))
        except OSError:
            port.close()
        else:
            return domain, port
    msg = 'all ROS domains from 1 to 100 are taken'
    raise DemoError(msg)


def bridge_executable() -> Path:
    """Return the executable that "ros2 run sdf_pose_bridge bridge" starts."""
    try:
        prefix = Path(get_package_prefix(PACKAGE))
    except PackageNotFoundError as error:
        msg = f'{PACKAGE} is not installed; build it and source install/setup.bash first'
        raise DemoError(msg) from error
    return prefix / 'lib' / PACKAGE / 'bridge'


def await_listener(listener: subprocess.Popen, bridge: subprocess.Popen) -> None:
    deadline = time.monotonic() + LISTENER_SECONDS + STOP_SECONDS
    while time.monotonic() < deadline:
        try:
            code = listener.wait(timeout=0.1)
        except subprocess.TimeoutExpired:
            if bridge.poll() is not None:
                msg = f'the bridge ended with exit code {bridge.returncode}'
                raise DemoError(msg) from None
        else:
            if code:
                msg = f'the listener ended with exit code {code}'
                raise DemoError(msg)
            return
    msg = 'the listener did not end'
    raise DemoError(msg)


def stop(bridge: subprocess.Popen) -> None:
    bridge.send_signal(signal.SIGINT)
    try:
        code = bridge.wait(timeout=STOP_SECONDS)
    except subprocess.TimeoutExpired:
        msg = f'the bridge did not end within {STOP_SECONDS:g} s of SIGINT'
        raise DemoError(msg) from None
    if code:
        msg = f'the bridge ended with exit code {code} after SIGINT'
        raise DemoError(msg)
    print('\nThe bridge ended well after SIGINT.')


def demonstrate(file: Path) -> None:
    domain, port = free_domain()
    environment = dict(
        os.environ, ROS_DOMAIN_ID=str(domain), ROS_AUTOMATIC_DISCOVERY_RANGE='LOCALHOST')
    processes = []
    with port:
        try:
            command = [str(bridge_executable()), '--ros-args', '-p', f'sdf_file:={file}']
            print(f'Starting {" ".join(command)} in ROS domain {domain}', flush=True)
            bridge = subprocess.Popen(command, env=environment)
            processes.append(bridge)
            listener = subprocess.Popen(
                [sys.executable, str(HERE / 'listen_to_frames.py'),
                 '--timeout', str(LISTENER_SECONDS)],
                env=environment)
            processes.append(listener)
            await_listener(listener, bridge)
            stop(bridge)
        finally:
            for process in processes:
                if process.poll() is None:
                    process.kill()
                    process.wait()


def main() -> int:
    parser = argparse.ArgumentParser(description='Start the bridge and listen to it.')
    parser.add_argument(
        'file', nargs='?', type=Path, default=HERE / 'work_cell.sdf',
        help='an SDFormat file (%(default)s)')
    arguments = parser.parse_args()
    # make and systemd send SIGTERM; the processes started here must end before this one.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        demonstrate(arguments.file.absolute())
    except DemoError as reason:
        print(f'\nThe demonstration failed: {reason}.', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == '__main__':
    sys.exit(main())
