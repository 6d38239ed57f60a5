# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The life of the process around the node: start ROS, spin, and end well whatever comes."""

from __future__ import annotations

from collections.abc import Sequence
import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.signals import SignalHandlerOptions
from rclpy.signals import uninstall_signal_handlers
from rclpy.utilities import remove_ros_args

from sdf_pose_bridge.bridge import StopRequest
from sdf_pose_bridge.bridge import USAGE
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.file_address import AddressError
from sdf_pose_bridge.log_lines import lines_from_error
from sdf_pose_bridge.log_lines import lines_from_warnings
from sdf_pose_bridge.node import content_from_settings
from sdf_pose_bridge.node import NODE_NAME
from sdf_pose_bridge.node import SdfPoseBridge
from sdf_pose_bridge.parameters import settings_from_node
from sdf_pose_bridge.settings import SettingsError


def run(args: Sequence[str], stop: StopRequest) -> int:
    """
    Run the node until it is told to stop.

    :param args: the command line with the program's name first.
    :param stop: takes note of signals.
    :return: exit code: 0 after SIGINT or SIGTERM, 1 if the node could not start.
    """
    node: SdfPoseBridge | None = None
    try:
        rclpy.init(args=list(args), signal_handler_options=SignalHandlerOptions.ALL)
        stop.defer()
        exit_code = _exit_code_from_words(remove_ros_args(args)[1:])
        if exit_code is None:
            node = SdfPoseBridge()
            exit_code = _exit_code_from_node(node, stop)
    except (ExternalShutdownException, KeyboardInterrupt):
        exit_code = 0
    except Exception as error:
        # A signal shuts ROS down under whatever is being done with it.
        if stop.is_made():
            exit_code = 0
        elif node is None and isinstance(error, RuntimeError):
            _complain(_sentence_from_ros_error(error))
            exit_code = 1
        else:
            raise
    finally:
        _shut_down(node, stop)
    return exit_code


def _exit_code_from_words(words: Sequence[str]) -> int | None:
    if not words:
        return None
    if words[0] in ('-h', '--help'):
        print(USAGE)
        return 0
    _complain(f'the argument "{words[0]}" is not understood\n\n{USAGE}')
    return 1


def _exit_code_from_node(node: SdfPoseBridge, stop: StopRequest) -> int:
    logger = node.get_logger()
    try:
        settings = settings_from_node(node)
        with stop.interrupting():
            content = content_from_settings(settings)
    except (SdfError, SettingsError, AddressError) as error:
        for line in lines_from_warnings(error.warnings if isinstance(error, SdfError) else ()):
            logger.warning(line)
        for line in lines_from_error(error):
            logger.fatal(line)
        return 1
    node.serve(settings, content)
    rclpy.spin(node)
    return 0


def _shut_down(node: SdfPoseBridge | None, stop: StopRequest) -> None:
    try:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    except RuntimeError:
        # The signal handler's thread may be shutting the same things down.
        if not stop.is_made():
            raise
    finally:
        uninstall_signal_handlers()
        stop.ignore_further()


def _sentence_from_ros_error(error: RuntimeError) -> str:
    if isinstance(error, rclpy_implementation.UnknownROSArgsError):
        return f'unknown arguments after --ros-args: {error}'
    # The rest names lines of the source of ROS.
    return str(error).partition(', at /')[0]


def _complain(sentence: str) -> None:
    print(f'{NODE_NAME}: {sentence}', file=sys.stderr)
