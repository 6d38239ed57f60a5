# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The environment of tests, fixtures with ROS, settings of property tests, parallel processes."""

from functools import partial
from importlib.metadata import version
import importlib.util
import os
from pathlib import Path
import signal
import tempfile
import time

from lxml import etree
from own_environment import environment_of_tests
import pytest
from ros_domain import environment_with_domain
from shared_memory import remove_dead_segments
from sizes import size

try:
    from hypothesis import HealthCheck, settings
except ImportError:  # the tests that need it are skipped
    pass
else:
    # A machine that has other work to do may take long for an example.
    settings.register_profile(
        'all_examples', deadline=None, suppress_health_check=[HealthCheck.too_slow])
    settings.register_profile(
        'few_examples', settings.get_profile('all_examples'), max_examples=20)
    settings.load_profile(size('few_examples', 'all_examples'))


def pytest_configure(config):
    """Give tests an environment of their own, before their modules import ROS."""
    # All that was made is removed, and all processes end, where this is ended from outside; also
    # in the background of a shell, which ignores signals there.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    if not hasattr(config, 'workerinput'):
        config.add_cleanup(partial(remove_dead_segments, time.time()))
    home = tempfile.TemporaryDirectory(prefix='sdf_pose_bridge_home_')
    config.add_cleanup(home.cleanup)
    environment = environment_of_tests(os.environ, home.name)
    os.environ.clear()
    os.environ.update(environment)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers():
    """Return the number of processes for ``-n auto``: most tests wait for other processes."""
    return min(3 * len(os.sched_getaffinity(0)), 16)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """Have one process run all tests of the page, so that one browser is started for them."""
    if config.getoption('dist') != 'loadfile':
        return None
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid):
            file = super()._split_scope(nodeid)
            return 'page' if 'cli/page/' in file else file

    return Scheduling(config, log)


def pytest_collection_modifyitems(items):
    """Begin with the tests that take longest, so that no process has them last."""
    longest = ('cli/page', 'sdformat/test_limits.py', 'integration')
    folder = Path(__file__).parent
    items.sort(key=lambda item: not item.path.relative_to(folder).as_posix().startswith(longest))


def pytest_report_header():
    """Return lines that say what the tests run with."""
    found = importlib.util.find_spec('rclpy')
    names = [f'{name} {version(name)}' for name in ('numpy', 'lxml')]
    return [f'versions: {", ".join(names)}, libxml2 {".".join(map(str, etree.LIBXML_VERSION))}',
            f'rclpy: {Path(found.origin).parent if found else "none"}']


@pytest.fixture
def ros_domain(tmp_path):
    """Number of a ROS domain that this test has to itself, on this machine alone."""
    with environment_with_domain(tmp_path / 'ros_log') as domain:
        yield domain


@pytest.fixture(scope='module')
def shared_ros_domain(tmp_path_factory):
    """Number of a ROS domain for all tests of a module, on this machine alone."""
    with environment_with_domain(tmp_path_factory.mktemp('ros_log')) as domain:
        yield domain


@pytest.fixture
def make_node(ros_domain):
    """Makes nodes in a context of their own; ``make_node(name, *ros_args)``."""
    rclpy = pytest.importorskip('rclpy', reason='needs ROS 2')
    from rclpy.context import Context
    context = Context()
    rclpy.init(args=[], context=context, domain_id=ros_domain)
    nodes = []

    def make(name, *ros_args):
        nodes.append(rclpy.create_node(
            name, context=context, cli_args=['--ros-args', *ros_args] if ros_args else None))
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()
    context.shutdown()
    context.destroy()
