# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Ask a simulator for the poses of models, by the standard package simulation_interfaces."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
import importlib
import re
import time
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future

from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.ros.cdr import NANOSECONDS, StampedPose
from sdf_pose_bridge.ros.state_messages import Effects, Message, StateSource

LONGEST_CALL_S = 5.0
"""Longest time to wait for an answer; then the simulator is asked again."""

MOST_WAITING = 100
"""Largest number of answers that wait; then new ones replace the oldest."""

_RESULT_OK = 1


class Simulator(StateSource):
    """
    A simulator that is asked for the poses of models, by one call at a time.

    The executor of the node makes the calls; the thread that follows messages takes the answers.

    :param node_name: the name of its node.
    :param wake: called when there is an answer.
    """

    def __init__(self, node: Node, node_name: str, wake: Callable[[], None]) -> None:
        super().__init__(node, node.resolve_service_name(f'{node_name}/get_entities_states'))
        self.node_name = node_name
        self._node, self._wake = node, wake
        self._answers: deque[Any] = deque(maxlen=MOST_WAITING)
        self._problem = ''
        self._client: Any = None
        self._call: Future | None = None
        self._call_ends_at = 0.0
        try:
            # Imported here because not everybody has this package.
            self._type = importlib.import_module('simulation_interfaces.srv').GetEntitiesStates
        except ImportError:
            self._report(
                'the package simulation_interfaces is not installed; install it, for example as '
                'ros-$ROS_DISTRO-simulation-interfaces, and start this node again')
            return
        self._request = self._type.Request()
        self._client = node.create_client(self._type, self.name)
        self._timer = node.create_timer(
            1.0, self._ask, autostart=False, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def follow(self, models: Sequence[str], rate_hz: float) -> None:
        """Ask for the poses of models, by their scoped names, at most with a rate."""
        if self._client is None:
            return
        # All models of the world may be thousands. Names are compared as a whole.
        names = '|'.join(re.sub(r'([][\\^$.|?*+(){}])', r'\\\1', each) for each in models)
        self._request.filters.filter = f'^({names})$'
        self._timer.cancel()
        if rate_hz:
            self._timer.timer_period_ns = round(NANOSECONDS / rate_hz)
            self._timer.reset()

    def end(self) -> None:
        """Make no more calls."""
        if self._client is not None:
            self._node.destroy_timer(self._timer)
            self._node.destroy_client(self._client)
            self._client = None

    @property
    def has_answers(self) -> bool:  # noqa: D102 - as in the base class
        return bool(self._answers)

    def messages(self, effects: Effects) -> Sequence[Message] | None:  # noqa: D102 - as above
        if not self._answers:
            return None
        return self.messages_from_poses(_poses(self._answers.popleft()), effects)

    def _ask(self) -> None:
        now = time.monotonic()
        if self._call is not None and now < self._call_ends_at:
            return
        if self._call is not None:
            self._client.remove_pending_request(self._call)
            self._call = None
            self._report(f'no answer in {LONGEST_CALL_S:g} s; is the simulator running?')
        if not self._client.service_is_ready():
            self._report(
                'there is no such service; start the simulator, or set the parameter simulator to '
                'the name of its node, which "ros2 service list" shows')
            return
        self._call_ends_at = now + LONGEST_CALL_S
        self._call = self._client.call_async(self._request)
        self._call.add_done_callback(self._take_answer)

    def _take_answer(self, future: Future) -> None:
        if self._call is None or future is not self._call:
            return
        self._call = None
        answer: Any = future.result()
        if answer.result.result != _RESULT_OK:
            self._report(
                f'the simulator answers with result {answer.result.result}, which is not OK: '
                f'{answer.result.error_message or "it gives no reason"}',
                f'result {answer.result.result}')
            return
        self._report('')
        self._answers.append(answer)
        self._wake()

    def _report(self, problem: str, about: str = '') -> None:
        """Log a problem, unless the last one was the same, or about the same."""
        about = about or problem
        if not problem or (about != self._problem and self.warn(
                about, lambda: f'no poses of models from {self.name}: {problem}')):
            self._problem = about


def _poses(answer: Any) -> Iterator[StampedPose]:
    for name, state in zip(answer.entities, answer.states, strict=False):
        stamp, position, quat = (
            state.header.stamp, state.pose.position, state.pose.orientation)
        frame_id = state.header.frame_id
        yield StampedPose(
            stamp.sec * NANOSECONDS + stamp.nanosec, '' if frame_id == WORLD_FRAME else frame_id,
            name, (position.x, position.y, position.z, quat.x, quat.y, quat.z, quat.w))
