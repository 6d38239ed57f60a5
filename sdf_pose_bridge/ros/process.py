# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Run the node in a process, from its start to its end by a signal.

Signals are handled here because rclpy's handlers shut ROS down while it is in use, which then
fails in many ways, and do not interrupt the reading of a file.
"""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence
import contextlib
from contextlib import contextmanager
import gc
import os
import signal
import sys
import threading
import traceback

import rclpy
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Task
from rclpy.utilities import remove_ros_args

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.given_parameters import settings_from_node
from sdf_pose_bridge.ros.given_parameters import warnings_about_unknown_parameters
from sdf_pose_bridge.ros.log_lines import lines_from_error
from sdf_pose_bridge.ros.log_lines import lines_from_warnings
from sdf_pose_bridge.ros.middleware import use_profile
from sdf_pose_bridge.ros.parameters import SettingsError
from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers
from sdf_pose_bridge.sdformat.include.uris import AddressError
from sdf_pose_bridge.tf.loaded_scene import loaded_scene_from_request
import sdf_pose_bridge_interfaces  # noqa: F401 - if it is missing, say so before anything else

NODE_NAME = 'sdf_pose_bridge'
STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM)

LONGEST_STOP_S = 10.0
"""How long what is being done may go on after a signal, before the process is ended."""

USAGE = """\
Publish every frame of an SDFormat file on TF and on topics.

usage: ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=cell.sdf [-p name:=value ...]

"ros2 param describe /sdf_pose_bridge <name>" explains each parameter of the running node."""


def run(args: Sequence[str]) -> int:
    """
    Run the node until a signal ends it.

    :param args: the command line with the program's name first.
    :return: exit code: 0 after SIGINT or SIGTERM, 1 if the node could not start.
    """
    # From now on a signal waits until it is unblocked or asked for, and a second one is ignored.
    # Threads that are started later inherit this.
    signal.pthread_sigmask(signal.SIG_BLOCK, STOP_SIGNALS)
    sentence_about_profile = use_profile(os.environ)
    try:
        rclpy.init(args=list(args), signal_handler_options=SignalHandlerOptions.NO)
        words = remove_ros_args(args)[1:]
        if words:
            return _exit_code_from_words(words)
        node = Node(NODE_NAME, start_parameter_services=False)
    except InvalidParameterTypeException as error:
        # Of one that rclpy itself declares, such as use_sim_time. Its name comes last again.
        _complain(str(error).rpartition(': ')[0])
        return 1
    except RuntimeError as error:
        _complain(_sentence_from_ros_error(error))
        return 1
    node.get_logger().debug(sentence_about_profile)
    try:
        exit_code = _exit_code_from_node(node)
    except KeyboardInterrupt:
        exit_code = 0
    node.destroy_node()
    rclpy.try_shutdown()
    return exit_code


def _exit_code_from_words(words: Sequence[str]) -> int:
    if words[0] in ('-h', '--help'):
        print(USAGE)
        return 0
    _complain(f'the argument "{words[0]}" is not understood\n\n{USAGE}')
    return 1


def _exit_code_from_node(node: Node) -> int:
    _log_warnings(node, warnings_about_unknown_parameters(node))
    try:
        settings = settings_from_node(node)
        with _interrupted_by_signals():
            loaded = loaded_scene_from_request(settings.load_request)
    except (SdfError, SettingsError, AddressError) as error:
        _log_warnings(node, error.warnings if isinstance(error, SdfError) else ())
        for line in lines_from_error(error):
            node.get_logger().fatal(line)
        return 1
    frames = PublishedFrames(Publishers(node), loaded.tree, loaded.joint_positions, {})
    frames.publish_tf()
    # Imported here because listeners would wait for /tf_static 5 ms longer.
    from sdf_pose_bridge.ros.node import start_bridge
    gc.enable()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    start = executor.create_task(start_bridge, node, frames, settings, loaded)
    _spin_until_signal(executor, node, start)
    executor.shutdown()
    return 0


@contextmanager
def _interrupted_by_signals() -> Iterator[None]:
    """
    Let signals interrupt what is done meanwhile.

    :raises KeyboardInterrupt: if a signal comes, or came before.
    """
    for number in STOP_SIGNALS:
        signal.signal(number, signal.default_int_handler)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, STOP_SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_BLOCK, STOP_SIGNALS)


def _spin_until_signal(executor: SingleThreadedExecutor, node: Node, start: Task) -> None:
    has_to_stop, has_stopped = threading.Event(), threading.Event()

    def wait_for_signal() -> None:
        signal.sigwait(STOP_SIGNALS)
        has_to_stop.set()
        # Without memory, neither the task can be made nor the executor go on.
        with contextlib.suppress(MemoryError):
            executor.create_task(has_to_stop.set)
        if not has_stopped.wait(LONGEST_STOP_S):
            os._exit(1)

    threading.Thread(target=wait_for_signal, name='signals', daemon=True).start()
    while not has_to_stop.is_set():
        try:
            executor.spin_once()
        except Exception as error:
            if start.exception() is not None:
                raise
            # A defect, or a message that rclpy itself refuses: a negative time on /clock.
            node.get_logger().error(
                f'internal error in a callback: {error}\n{traceback.format_exc()}',
                throttle_duration_sec=60.0)
    has_stopped.set()


def _log_warnings(node: Node, warnings: Sequence[object]) -> None:
    for line in lines_from_warnings(warnings):
        node.get_logger().warning(line)


def _sentence_from_ros_error(error: RuntimeError) -> str:
    # The class cannot be imported by a public name.
    if type(error).__name__ == 'UnknownROSArgsError':
        return f'unknown arguments after --ros-args: {error}'
    # The rest of the message names lines of the source of ROS.
    return str(error).partition(', at /')[0]


def _complain(sentence: str) -> None:
    print(f'{NODE_NAME}: {sentence}', file=sys.stderr)
