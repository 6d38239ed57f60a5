# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The life of the process around the node: start ROS, spin, and end well whatever comes."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence
from contextlib import contextmanager
import gc
import os
import signal
import sys
import threading

import rclpy
from rclpy.executors import Executor
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.loaded_scene import Content
from sdf_pose_bridge.ros.loaded_scene import content_from_settings
from sdf_pose_bridge.ros.parameters import settings_from_node
from sdf_pose_bridge.ros.settings import Settings
from sdf_pose_bridge.ros.settings import SettingsError
from sdf_pose_bridge.ros.stop_request import StopRequest
from sdf_pose_bridge.ros.tf_static import TfStatic
from sdf_pose_bridge.sdformat.include.uris import AddressError
import sdf_pose_bridge_interfaces  # noqa: F401 - if missing, that comes out before anything is done

NODE_NAME = 'sdf_pose_bridge'

USAGE = """\
Publish every frame of an SDFormat file on TF and on topics.

usage: ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=cell.sdf [-p name:=value ...]

"ros2 param describe /sdf_pose_bridge <name>" explains each parameter of the running node."""


def run(args: Sequence[str], stop: StopRequest) -> int:
    """
    Run the node until it is told to stop.

    :param args: the command line with the program's name first.
    :param stop: takes note of signals.
    :return: exit code: 0 after SIGINT or SIGTERM, 1 if the node could not start.
    """
    try:
        # Signals are left to StopRequest: the handlers of rclpy would shut ROS down under whatever
        # is being done with it, which then fails in many ways.
        rclpy.init(args=list(args), signal_handler_options=SignalHandlerOptions.NO)
        stop.defer()
        words = remove_ros_args(args)[1:]
        if words:
            return _exit_code_from_words(words)
        node = Node(NODE_NAME, start_parameter_services=False)
    except RuntimeError as error:
        _complain(_sentence_from_ros_error(error))
        return 1
    try:
        exit_code = _exit_code_from_node(node, stop)
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


def _exit_code_from_node(node: Node, stop: StopRequest) -> int:
    logger = node.get_logger()

    def load(settings: Settings) -> Content:
        with stop.interrupting():
            return content_from_settings(settings)

    try:
        settings = settings_from_node(node)
        content = load(settings)
    except (SdfError, SettingsError, AddressError) as error:
        from sdf_pose_bridge.ros.log_lines import lines_from_error
        from sdf_pose_bridge.ros.log_lines import lines_from_warnings
        for line in lines_from_warnings(error.warnings if isinstance(error, SdfError) else ()):
            logger.warning(line)
        for line in lines_from_error(error):
            logger.fatal(line)
        return 1
    tf_static = TfStatic(node)
    tf_static.publish(content.tree)
    # What others wait for is out, so there is time for everything else.
    from sdf_pose_bridge.ros.node import SdfPoseBridge
    from sdf_pose_bridge.ros.publishers import Publications
    bridge = SdfPoseBridge(node, Publications(node, tf_static))
    bridge.serve(settings, content)
    gc.enable()
    _spin(node, stop)
    return 0


def _spin(node: Node, stop: StopRequest) -> None:
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        with _woken_by_signals(executor):
            while not stop.is_made():
                executor.spin_once()
    finally:
        executor.shutdown()


@contextmanager
def _woken_by_signals(executor: Executor) -> Iterator[None]:
    # A thread that waits in the middleware runs no handler of Python's before it has something to
    # do; but the byte that Python writes for each signal reaches another thread at once.
    reader, writer = os.pipe()
    os.set_blocking(writer, False)

    def wake() -> None:
        while os.read(reader, 1):
            executor.create_task(_do_nothing)

    thread = threading.Thread(target=wake, name='signals', daemon=True)
    thread.start()
    signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    try:
        yield
    finally:
        signal.set_wakeup_fd(-1)
        os.close(writer)
        thread.join()
        os.close(reader)


def _do_nothing() -> None:
    pass


def _sentence_from_ros_error(error: RuntimeError) -> str:
    if isinstance(error, rclpy_implementation.UnknownROSArgsError):
        return f'unknown arguments after --ros-args: {error}'
    # The rest names lines of the source of ROS.
    return str(error).partition(', at /')[0]


def _complain(sentence: str) -> None:
    print(f'{NODE_NAME}: {sentence}', file=sys.stderr)
