# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Fixtures that start real processes in a ROS domain of the test's own.

Tests share a bridge where they can: those of a module that only read have it as they start it, and
those with the fixture ``bridge`` find a file and parameters of their own.
"""

import contextlib

from bridge_process import BridgeProcess, LoggedProcess
import pytest
from ros_domain import environment_with_domain

pytest.importorskip('rclpy', reason='needs ROS 2')
from changes import listen_to_tf, SharedBridge, wait_for_x, world
from listener import JointPublisher, Listener, TfListener


@contextlib.contextmanager
def ended_later(make):
    """Give a function that makes processes or listeners, which all end with the context."""
    made = []

    def start(*arguments, **options):
        made.append(make(*arguments, **options))
        return made[-1]

    try:
        yield start
    finally:
        for each in made:
            each.end()


@pytest.fixture
def ros_domain(request, tmp_path):
    """Number of the ROS domain of ``bridge``, or of one that the test has to itself."""
    if 'bridge' in request.fixturenames:
        yield request.getfixturevalue('shared_ros_domain')
    else:
        with environment_with_domain(tmp_path / 'ros_log') as domain:
            yield domain


@pytest.fixture
def start_bridge(ros_domain):
    """Starts the installed executable; ``start_bridge(*arguments, **parameters)``."""
    with ended_later(BridgeProcess) as start:
        yield start


@pytest.fixture
def start_program(ros_domain):
    """Starts any program; ``start_program(command)``."""
    with ended_later(LoggedProcess) as start:
        yield start


@pytest.fixture
def file(request, tmp_path):
    """File with ``FILE_TEXT`` of the module, or with a small world; a test may change it."""
    path = tmp_path / 'cell.sdf'
    path.write_text(getattr(request.module, 'FILE_TEXT', world(1)))
    return path


@pytest.fixture(scope='module')
def shared_bridge(start_shared_bridge, start_shared_listener, tmp_path_factory):
    """A bridge that tests of a module use one after the other."""
    path = tmp_path_factory.mktemp('shared') / 'cell.sdf'
    path.write_text(world(1))
    bridge = start_shared_bridge(sdf_file=path).wait_until_started()
    return SharedBridge(bridge, start_shared_listener())


@pytest.fixture
def bridge(shared_bridge, file):
    """Bridge on that file, with the default of every other parameter; it must go on running."""
    return shared_bridge.on(file)


@pytest.fixture
def listener(bridge, start_listener):
    """Listens to ``/tf_static``, where the frames of that file have arrived."""
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    return listener


@pytest.fixture
def start_listener(ros_domain):
    """Starts to listen from this process; ``start_listener()``."""
    with ended_later(lambda: Listener(ros_domain)) as start:
        yield start


@pytest.fixture(scope='module')
def start_shared_bridge(shared_ros_domain):
    """Starts a bridge that all tests of a module use; ``start_shared_bridge(*arguments)``."""
    with ended_later(BridgeProcess) as start:
        yield start


@pytest.fixture(scope='module')
def start_shared_listener(shared_ros_domain):
    """Starts a listener that all tests of a module use; ``start_shared_listener()``."""
    with ended_later(lambda: Listener(shared_ros_domain)) as start:
        yield start


@pytest.fixture
def joints(tf):
    """Publishes joint states; ``joints.send(positions)``."""
    return JointPublisher(tf.listener)


@pytest.fixture
def tf(start_listener):
    """Listens to ``/tf``; ``tf.last`` has the last transform of each frame."""
    return TfListener(start_listener())
