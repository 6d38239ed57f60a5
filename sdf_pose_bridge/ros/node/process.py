# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Run one of the executables, which are one node with two names and two tables of defaults.

Signals are handled here because rclpy's handlers shut ROS down while it is in use, which then
fails in many ways, and do not interrupt the reading of a file.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
import gc
import os
import re
import signal
import sys
import threading
from typing import NamedTuple

import rclpy
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from sdf_pose_bridge.errors import AddressError, SdfError
from sdf_pose_bridge.ros.background import Worker
from sdf_pose_bridge.ros.file_process import FileProcess, loaded_scene
from sdf_pose_bridge.ros.log_lines import (
    line_from_text,
    lines_from_error,
    lines_from_warnings,
    text_about_defect,
)
from sdf_pose_bridge.ros.node.ending import end_at_failures_of_threads, end_without_memory
from sdf_pose_bridge.ros.node.middleware import use_profile
from sdf_pose_bridge.ros.parameters.declarations import SettingsError, Value
from sdf_pose_bridge.ros.parameters.given import (
    ParameterServices,
    settings_from_node,
    warnings_about_unknown_parameters,
)
from sdf_pose_bridge.ros.parameters.rules import AUTO_KINDS
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames, TF_STATIC
from sdf_pose_bridge.ros.publishing.publishers import Publishers
from sdf_pose_bridge.ros.publishing.topic_names import check_number_of_topics
import sdf_pose_bridge_interfaces  # noqa: F401 - if it is missing, say so before anything else

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM)

LONGEST_STOP_S = 10.0
"""Time in s for the current work to end after a signal, before the process is ended."""

_ENDING_PERIOD_S = 0.02
"""Time in s between two looks whether something has ended."""


class Program(NamedTuple):
    """An executable."""

    node_name: str
    defaults: Mapping[str, Value]
    """The defaults of parameters that differ from the declared defaults."""
    usage: str
    advice: str
    """The message if there is neither a file nor a text."""
    takes_file: bool = False
    """Whether the command line may name a file, before the arguments of ROS."""
    known_elsewhere: Collection[str] = ()
    """Names of parameters of older releases, which cause no warning. If there are any, files of
    parameters may be for other nodes too."""


BRIDGE = Program(
    'sdf_pose_bridge', {}, """\
Publish every frame of an SDFormat file on TF and on topics.

usage: ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=cell.sdf [-p name:=value ...]

"ros2 param describe /sdf_pose_bridge <name>" explains each parameter of the running node.""",
    'parameter sdf_file is not set; name the file to publish: --ros-args -p sdf_file:=cell.sdf '
    'after "ros2 run ...", sdf_file:=cell.sdf after "ros2 launch ..."; or set robot_description '
    'to its text')

ROBOT_STATE_PUBLISHER = Program(
    'robot_state_publisher',
    {
        'use_joint_states': True,
        'joint_states_topics': ['joint_states'],
        'publish_frequency': 20.0,
        'kinds': [AUTO_KINDS],
        'pose_topics': [],
        'publish_transforms': False,
        'publish_visuals': False,
        'publish_diagnostics': False,
    }, """\
Publish the frames of a robot in URDF or SDFormat, as the package robot_state_publisher does.

usage: ros2 run sdf_pose_bridge robot_state_publisher [robot.urdf] [--ros-args -p name:=value ...]

The text is the parameter robot_description. Without it, the file is robot.urdf or the parameter
sdf_file. "ros2 param describe /robot_state_publisher <name>" explains each parameter of
the running node.""",
    'parameter robot_description is not set; set it to the text of URDF or SDFormat, or name a '
    'file: robot.urdf after "ros2 run ...", or the parameter sdf_file',
    takes_file=True, known_elsewhere=('use_tf_static',))

PROGRAMS = {'bridge': BRIDGE, 'robot_state_publisher': ROBOT_STATE_PUBLISHER}
"""The executables by their names."""


def run(args: Sequence[str], program_name: str, reader: FileProcess) -> int:
    """
    Run the node until a signal ends it.

    :param args: the command line with the program's name first.
    :param program_name: a key of :data:`PROGRAMS`.
    :param reader: reads the file.
    :return: exit code: 0 after SIGINT or SIGTERM, 1 if the node could not start.
    """
    # From now on, a signal stays pending until it is unblocked or waited for, and a second one is
    # ignored. Threads that are started later inherit this.
    signal.pthread_sigmask(signal.SIG_BLOCK, STOP_SIGNALS)
    end_at_failures_of_threads()
    program = PROGRAMS[program_name]
    sentence_about_profile = use_profile(os.environ)
    try:
        rclpy.init(args=list(args), signal_handler_options=SignalHandlerOptions.NO)
        words = remove_ros_args(args)[1:]
        if {'-h', '--help'}.intersection(words):
            print(program.usage)
            return 0
        if len(words) > program.takes_file:
            word = words[program.takes_file]
            _complain(program, f'the argument "{word}" is not understood{_hint(word)}')
            print(f'\n{program.usage}', file=sys.stderr)
            return 1
        node = Node(program.node_name)
        parameter_services = ParameterServices(node)
    except InvalidParameterTypeException as error:
        # A parameter of rclpy, such as use_sim_time. Its name comes last again.
        _complain(program, str(error).rpartition(': ')[0])
        return 1
    except RuntimeError as error:
        _complain(program, _sentence_from_ros_error(error))
        return 1
    node.get_logger().debug(line_from_text(sentence_about_profile))
    exit_code = _exit_code_from_node(node, program, reader, parameter_services, *words)
    node.destroy_node()
    rclpy.try_shutdown()
    return exit_code


def _exit_code_from_node(
    node: Node, program: Program, reader: FileProcess, parameter_services: ParameterServices,
    file: str = '',
) -> int:
    _log_warnings(node, warnings_about_unknown_parameters(node, program.known_elsewhere))
    try:
        settings = settings_from_node(node, program.defaults, file, program.advice)
        publishers, request = Publishers(node), settings.load_request
        with reader.calling(request, loaded_scene, request) as call:
            publishers.opened(TF_STATIC)
            while not call.has_ended(_ENDING_PERIOD_S):
                if signal.sigpending().intersection(STOP_SIGNALS):
                    return 0
            loaded = call.result()
        check_number_of_topics(settings, loaded.joint_positions)
    except (SdfError, SettingsError, AddressError) as error:
        _log_warnings(node, [
            warning for warning in (error.warnings if isinstance(error, SdfError) else ())
            if not warning.is_for_gazebo])
        for line in lines_from_error(error):
            node.get_logger().fatal(line)
        return 1
    frames = PublishedFrames(publishers, loaded.tree, loaded.joint_positions, {})
    frames.publish_tf_static()
    # Imported here because it is slow to import, and listeners wait for /tf_static.
    from sdf_pose_bridge.ros.node.node import SdfPoseBridge
    # Modules and the first scene are not garbage. Searching them would stop all threads.
    gc.freeze()
    gc.enable()
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    loader = Worker(node, 'loader')
    start = loader.run(lambda: SdfPoseBridge(
        node, loader, frames, settings, loaded, reader, parameter_services))
    if program is ROBOT_STATE_PUBLISHER:
        # Scripts wait for this line of the package robot_state_publisher.
        start.add_done_callback(lambda _: node.get_logger().info('Robot initialized'))
    _spin_until_signal(executor, node, loader)
    executor.shutdown()
    return 0


def _spin_until_signal(executor: SingleThreadedExecutor, node: Node, loader: Worker) -> None:
    has_to_stop, has_stopped = threading.Event(), threading.Event()

    def wait_for_signal() -> None:
        signal.sigwait(STOP_SIGNALS)
        has_to_stop.set()
        loader.end()
        executor.create_task(lambda: None)
        if not has_stopped.wait(LONGEST_STOP_S):
            os._exit(1)

    threading.Thread(target=wait_for_signal, name='signals', daemon=True).start()
    while not has_to_stop.is_set():
        _spin_once(executor, node)
    # It may wait for the executor.
    while loader.is_alive:
        _spin_once(executor, node, _ENDING_PERIOD_S)
    has_stopped.set()


def _spin_once(
    executor: SingleThreadedExecutor, node: Node, longest_s: float | None = None,
) -> None:
    try:
        executor.spin_once(longest_s)
    except MemoryError:
        end_without_memory()
    except Exception:  # noqa: BLE001
        # A defect, or a message that rclpy rejects: a negative time on /clock.
        node.get_logger().error(text_about_defect('a callback'), throttle_duration_sec=60.0)


def _log_warnings(node: Node, warnings: Sequence[object]) -> None:
    for line in lines_from_warnings(warnings):
        node.get_logger().warning(line)


def _sentence_from_ros_error(error: RuntimeError) -> str:
    # The class cannot be imported by a public name.
    if type(error).__name__ == 'UnknownROSArgsError':
        return f'unknown arguments after --ros-args: {error}{_hint(str(error))}'
    # The rest of the message names source lines of ROS.
    return str(error).partition(', at /')[0]


def _hint(text: str) -> str:
    """Return the end of a message about an argument that is a parameter without its option."""
    found = re.search(r'\w+:=[^\s\'"\]]*', text)
    return f'; did you mean "--ros-args -p {found[0]}"?' if found else ''


def _complain(program: Program, sentence: str) -> None:
    print(f'{program.node_name}: {line_from_text(sentence)}', file=sys.stderr)
