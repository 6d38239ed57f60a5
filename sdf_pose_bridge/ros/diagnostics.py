# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Say on ``/diagnostics`` what is served, and whether the last load went well."""

from __future__ import annotations

from collections.abc import Sequence
import datetime
from typing import NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_msgs.msg import KeyValue
from rclpy.node import Node

from sdf_pose_bridge.ros.loaded_scene import Content

PERIOD_S = 2.0
"""
Seconds between two messages.

Monitors call a state stale after five. To wake the executor is most of what an idle node costs.
"""


class State(NamedTuple):
    """What there is to say."""

    content: Content
    """What is served."""
    transforms: int
    """How many transforms are published."""
    loaded_at: datetime.datetime
    """When it was loaded."""
    failure: Sequence[str] = ()
    """What was wrong at the last load, a line for each thing; empty if it went well."""


class Diagnostics:
    """
    The publisher of a node's diagnostics.

    :param node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publisher = node.create_publisher(DiagnosticArray, '/diagnostics', 10)
        self._state: State | None = None
        self._message = DiagnosticArray()

    def publish(self, state: State) -> None:
        """
        Publish the state of the node.

        :param state: what there is to say.
        """
        # It is the same for hours, and to put it into words costs more than to publish it.
        if state is not self._state:
            name = self._node.get_fully_qualified_name().lstrip('/')
            self._message.status = [status_from_state(state, name)]
            self._state = state
        self._message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(self._message)


def status_from_state(state: State, name: str) -> DiagnosticStatus:
    """
    Put the state of the node into a status.

    :param state: what there is to say.
    :param name: the node's name.
    :return: ERROR if the last load failed, while what was loaded before is still served; WARN if
        what is served has warnings; else OK.
    """
    content = state.content
    values = {
        'file': str(content.path),
        'root frame': content.tree.root_frame,
        'frames': str(len(content.tree.frame_ids)),
        'transforms': str(state.transforms),
        'files read': str(len(content.files)),
        'last good load': state.loaded_at.isoformat(timespec='seconds'),
        'time to load': f'{1e3 * content.seconds:.0f} ms',
        'warnings': str(len(content.warnings)),
        'first warning': str(content.warnings[0]) if content.warnings else '',
        'last error': '\n'.join(state.failure),
    }
    if state.failure:
        level = DiagnosticStatus.ERROR
        text = f'the last load failed, what was loaded before is served: {state.failure[0]}'
    elif content.warnings:
        level = DiagnosticStatus.WARN
        number = len(content.warnings)
        text = f'serving {content.path.name} with {number} warning{"s" if number > 1 else ""}'
    else:
        level = DiagnosticStatus.OK
        text = f'serving {content.path.name}'
    return DiagnosticStatus(
        level=level, name=f'{name}: file', message=text, hardware_id='',
        values=[KeyValue(key=key, value=value) for key, value in values.items()])
