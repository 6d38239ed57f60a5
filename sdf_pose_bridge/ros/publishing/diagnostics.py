# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Publish on ``/diagnostics`` the state of the node and the result of the last load.

The package diagnostic_updater is not used because it would add parameters to the node.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import datetime

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from sdf_pose_bridge.export.published_scene import LoadedScene
from sdf_pose_bridge.ros.log_lines import count_in_words, line_from_text
from sdf_pose_bridge.ros.publishing.publishers import SwitchedPublisher, Topic
from sdf_pose_bridge.ros.publishing.state_report import StateReport

PERIOD_S = 2.0
"""
Seconds between two messages.

Monitors call a status stale after five seconds. Waking the executor takes most of the processor
time of an idle node.
"""


class Diagnostics:
    """
    The publisher of the diagnostics of a node.

    The topic exists once it is switched on.

    :param state_report: returns the report about joints and models.
    """

    def __init__(self, node: Node, state_report: Callable[[], StateReport]) -> None:
        self._node = node
        self._publisher = SwitchedPublisher(
            node, Topic('/diagnostics', DiagnosticArray, depth=10, is_latched=False))
        self._state_report = state_report
        self._last: tuple[LoadedScene, Sequence[str]] | None = None
        self._message = DiagnosticArray()

    def switch(self, *, on: bool) -> None:
        """Start or stop publishing."""
        self._publisher.switch(on=on)
        self.publish()

    def update(self, loaded: LoadedScene, failure: Sequence[str] = ()) -> None:
        """
        Change the status.

        :param failure: the errors of the last load, one line each; empty if it succeeded.
        """
        self._last = loaded, failure
        self.publish()

    def publish(self) -> None:
        """Publish the status, if there is one and it is switched on."""
        if not self._publisher.is_on:
            return
        if self._last is not None:
            name = self._node.get_fully_qualified_name().lstrip('/')
            self._message.status = [status_from_scene(*self._last, self._state_report(), name)]
        self._message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(self._message)


def status_from_scene(
    loaded: LoadedScene, failure: Sequence[str], states: StateReport, name: str,
) -> DiagnosticStatus:
    """
    Return the status of the node.

    :param failure: the errors of the last load; empty if it succeeded.
    :param states: the report about joints and models.
    :return: ERROR if the last load failed, so that the scene before it is still published, or if
        messages end in internal errors; WARN if the scene has warnings, or joints or models that
        are not reported, or topics have problems; otherwise OK.
    """
    warnings = loaded.warnings
    loaded_at = datetime.datetime.fromtimestamp(
        loaded.read_since_ns // 10**9, datetime.timezone.utc)
    values = {
        'file': loaded.path,
        'root frame': loaded.tree.root_frame,
        'frames': len(loaded.tree.frame_ids),
        'transforms': loaded.tree.transform_count,
        'files read': len(loaded.files),
        'last good load': loaded_at.isoformat(),
        'time to load': f'{1e3 * loaded.seconds:.0f} ms',
        'warnings': len(warnings),
        'first warning': warnings[0] if warnings else '',
        'joints not reported': len(states.joints),
        'first joint not reported': next(iter(states.joints), ''),
        'models not reported': len(states.models),
        'first model not reported': next(iter(states.models), ''),
        'problems of topics': len(states.problems),
    }
    error = '; '.join(states.failures)
    if failure:
        error = f'the last load failed, the scene before it is published: {failure[0]}'
    text = f'serving {loaded.path.name}'
    warning = '; '.join(states.problems) or states.line_about_unreported()
    if warnings and not warning:
        warning = f'{text} with {count_in_words(len(warnings), "warning")}'
    level = DiagnosticStatus.WARN if warning else DiagnosticStatus.OK
    return DiagnosticStatus(
        level=DiagnosticStatus.ERROR if error else level, name=f'{name}: file',
        message=line_from_text(error or warning or text),
        values=[*(KeyValue(key=key, value=line_from_text(value)) for key, value in values.items()),
                KeyValue(key='last error', value='\n'.join(failure))])
