# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Ask a simulator for the poses of models, by the standard package simulation_interfaces."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
import importlib
import math
import re
import time
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.task import Future

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.ros.cdr import NANOSECONDS, StampedPose
from sdf_pose_bridge.ros.following.model_poses import messages_from_poses
from sdf_pose_bridge.ros.following.state_messages import KnownStreams, Message, StateSource
from sdf_pose_bridge.ros.log_lines import count_in_words, names_in_line
from sdf_pose_bridge.ros.parameters.declarations import Settings
from sdf_pose_bridge.ros.parameters.rules import MODEL_FIELD, MOST_CHARACTERS
from sdf_pose_bridge.tf.joint_motion import NO_DOF
from sdf_pose_bridge.tf.joint_positions import JointPositions

SECOND_CALL_S = 1.0
"""Time without an answer after which the simulator is called again."""

LONGEST_CALL_S = 5.0
"""Longest time to wait for an answer."""

AFTER_EXCESS = (60.0, 'the next call is in 60 s'), (
    math.inf, 'it is not called again until a parameter is set or the file is read again')
"""Time before the next call, also in words, after the first answer with more entities than were
asked for, and after the second one. Each answer may block the executor."""

MOST_CHARACTERS_OF_FILTER = 1_000_000
"""Largest length of a filter; for more names all entities are asked for."""

LARGEST_SHARE = 0.1
"""Largest share of a core for answers. If they take longer, there are fewer calls."""

MOST_OTHERS = 1000
"""Largest number of entities that the file does not have and that get a frame."""

MOST_WAITING = 100
"""Largest number of answers that wait; then new ones replace the oldest."""

_COSTS = 5
"""Number of answers the cheapest of which counts, as the executor has other work too."""

_RESULT_OK = 1


class Simulator(StateSource):
    """
    A simulator that is asked for the poses of models.

    A call without an answer is followed by a second one, and the first answer of both counts. The
    executor of the node makes the calls; the thread that follows messages takes the answers. All
    poses are those of the simulator's world, whatever the headers of an answer name.

    :param name: the name of its service.
    :param wake: called when there is an answer.
    """

    is_of_joints = False

    def __init__(self, node: Node, name: str, wake: Callable[[], None]) -> None:
        super().__init__(node, node.resolve_service_name(name))
        self.given_name = name
        self.others: tuple[str, ...] = ()
        """The names of entities that the last answer has and the file has not, in order."""
        self._wake = wake
        self._answers: deque[Any] = deque(maxlen=MOST_WAITING)
        self._problem = ''
        # The time of each call that waits for an answer, and that of the next one.
        self._calls: dict[Future, float] = {}
        self._due = self._begin_of_cost_s = self._cost_of_poses_s = 0.0
        self._costs_s: deque[float] = deque(maxlen=_COSTS)
        # The models that the last answer lacks, the last two answers lack, and that are logged.
        self._missing = self._to_tell = self._told = list[str]()
        self._has_exceeded, self._followed_others = False, list[str]()
        self._kept: set[str] = set()
        self._client: Any = None
        try:
            # Imported here because not everybody has this package.
            services = importlib.import_module('simulation_interfaces.srv')
        except ImportError:
            self._report(
                'the package simulation_interfaces is not installed; install it, for example as '
                'ros-$ROS_DISTRO-simulation-interfaces, and start this node again')
            return
        self._request = services.GetEntitiesStates.Request()
        self._request_of_names = services.GetEntities.Request()
        self._client = node.create_client(services.GetEntitiesStates, self.name)
        self._client_of_names = node.create_client(
            services.GetEntities, self.name.removesuffix('_states'))
        self._timer = node.create_timer(
            1.0, self._ask, autostart=False, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def follow(self, positions: JointPositions, settings: Settings) -> None:
        """Ask for the poses of the free models, and of other entities if they are wanted."""
        if self._client is None:
            return
        self._positions, self._settings = positions, settings
        before, self._followed_others = self._followed_others, [*positions.others]
        if self._followed_others == before:  # else nobody but the simulator is the reason
            self._has_exceeded, self._due = False, 0.0
        self._models, self._known = (
            {settings.simulator_entity.replace(MODEL_FIELD, name): model
             for model in reversed(models) for name in (model.replace(SEPARATOR, '/'), model)}
            for models in (positions.free_models, positions.all_models))
        # All models of the world may be thousands. Names are compared as a whole.
        names = '|'.join(
            re.sub(r'([][\\^$.|?*+(){}])', r'\\\1', each) for each in reversed(self._models))
        self._request.filters.filter = (
            '' if settings.simulator_others or len(names) > MOST_CHARACTERS_OF_FILTER
            else f'^({names})$')
        self._timer.cancel()
        if settings.simulator_rate:
            self._timer.timer_period_ns = round(NANOSECONDS / settings.simulator_rate)
            self._timer.reset()

    def end(self) -> None:
        """Make no more calls."""
        if self._client is not None:
            self._node.destroy_timer(self._timer)
            self._node.destroy_client(self._client)
            self._node.destroy_client(self._client_of_names)
            self._client = None

    # What the executor does

    def _ask(self) -> None:
        if self._to_tell != self._told and self.is_due('names'):
            self._told = self._to_tell
            if self._told:
                self._ask_for_names(self._told)
        now, begins = time.monotonic(), [*self._calls.values()]
        is_slow = self._has_exceeded or len(begins) > 1
        longest_s = LONGEST_CALL_S if is_slow else SECOND_CALL_S
        if now < self._due or (begins and now - begins[0] < longest_s):
            return
        if len(begins) > 1:
            self._forget(next(iter(self._calls)))
            self._report(f'no answer in {LONGEST_CALL_S:g} s; is the simulator running?')
        if not self._client.service_is_ready():
            self._report(
                'there is no such service; start the simulator, or set the parameter simulator to '
                'the name of its node, which "ros2 service list" shows')
            return
        self._begin_of_cost_s = time.thread_time()
        call = self._client.call_async(self._request)
        self._calls[call] = now
        call.add_done_callback(self._receive)

    def _forget(self, call: Future) -> None:
        self._client.remove_pending_request(call)
        del self._calls[call]

    def _receive(self, future: Future) -> None:
        if future not in self._calls:
            return
        begin = max(self._calls.values())
        for call in [*self._calls]:
            self._forget(call)
        answer: Any = future.result()
        names, states, result = len(answer.entities), len(answer.states), answer.result
        if result.result != _RESULT_OK:
            self._report(
                f'the simulator answers with result {result.result}, which is not OK: '
                f'{result.error_message or "it gives no reason"}', f'result {result.result}')
        elif names != states:
            self._report(
                f'the simulator answers with {count_in_words(names, "name")} and '
                f'{count_in_words(states, "state")}')
        else:
            is_too_much = names > (
                len(self._models) if self._request.filters.filter
                else len(self._known) + MOST_OTHERS)
            period_s, when = AFTER_EXCESS[self._has_exceeded] if is_too_much else (
                self._period_s(names), '')
            self._has_exceeded |= is_too_much
            self._report(when and (
                f'it has {names} entities, which are more than were asked for, so that {when}'),
                when, 'few poses')
            self._due = begin + period_s
            self._answers.append(answer)
            self._wake()

    def _report(self, problem: str, about: str = '', what: str = 'no poses') -> None:
        """Log a problem, unless the last one was the same, or about the same."""
        about = problem and (about or problem)
        if not about or (about != self._problem and self.warn(
                about, lambda: f'{what} of models from {self.name}: {problem}')):
            self._problem = about

    def _period_s(self, count: int) -> float:
        """Return the shortest period of calls after an answer about a number of entities."""
        self._costs_s.append(time.thread_time() - self._begin_of_cost_s + self._cost_of_poses_s)
        cost_s, rate_hz = min(self._costs_s), self._settings.simulator_rate
        period_s = cost_s / LARGEST_SHARE
        if len(self._costs_s) == _COSTS and period_s * rate_hz > 1.5:
            self.warn_once('rate', ['rate'], lambda: (
                f'{self.name} is called {1.0 / period_s:.2g} times a second instead of '
                f'{rate_hz:g}, as an answer with {count_in_words(count, "pose")} takes '
                f'{1e3 * cost_s:.2g} ms of a core'))
        return period_s

    def _ask_for_names(self, missing: Sequence[str]) -> None:
        """Log that the simulator lacks models, with the nearest name that it has."""
        def tell(names: Sequence[str]) -> None:
            first = self._settings.simulator_entity.replace(MODEL_FIELD, missing[0])
            near = min((each for each in names if missing[0] in each), key=len, default='')
            hint = hint_from_names(first, names[:MOST_OTHERS]) if not near else (
                f'; for "{near}", set simulator_entity to '
                f'"{near.replace(missing[0], MODEL_FIELD)}"')
            self.warn('names', lambda: (
                f'no entity for {names_in_line(missing)} in the answers of {self.name}{hint}'))

        if self._client_of_names.service_is_ready():
            self._client_of_names.call_async(self._request_of_names).add_done_callback(
                lambda future: tell(future.result().entities))
        else:
            tell(())

    # What the thread that follows messages does

    @property
    def has_answers(self) -> bool:  # noqa: D102 - as in the base class
        return bool(self._answers)

    def messages(self, streams: KnownStreams) -> Sequence[Message] | None:  # noqa: D102 - as above
        if not self._answers:
            return None
        begin_s = time.thread_time()
        poses = self._poses(self._answers.popleft(), streams)
        self._add_nested(poses, streams)
        messages = messages_from_poses(poses.values(), self, streams)
        self._cost_of_poses_s = time.thread_time() - begin_s
        return messages

    def _poses(self, answer: Any, streams: KnownStreams) -> dict[str, StampedPose]:
        """Return the poses of free models and other bodies by their names."""
        poses, others = {}, []
        for entity, state in zip(answer.entities, answer.states, strict=True):
            name = self._models.get(entity, '')
            if not entity:
                self.warn_once('unnamed', [''], lambda: (
                    f'{self.name} has an entity without a name, which is left out'))
            elif not name and entity not in self._known and len(entity) <= MOST_CHARACTERS:
                others.append(entity)
                is_body = streams.models.get(entity) == self._positions.others.get(entity, NO_DOF)
                name = entity if is_body else ''
            if name:
                stamp, position, quat = (
                    state.header.stamp, state.pose.position, state.pose.orientation)
                poses[name] = StampedPose(
                    stamp.sec * NANOSECONDS + stamp.nanosec, '', name,
                    (position.x, position.y, position.z, quat.x, quat.y, quat.z, quat.w))
        self.others = tuple(sorted(others)[:MOST_OTHERS])
        return poses

    def _add_nested(self, poses: dict[str, StampedPose], streams: KnownStreams) -> None:
        """Add nested models without a pose, which keep their places; note what else is missing."""
        positions, kept = self._positions, []
        stamp_ns = max((each.stamp_ns for each in poses.values()), default=0)
        given = streams.dofs_of_others(self)
        missing = [
            each for each in positions.free_models
            if each not in poses and streams.models.get(each) not in given]
        for model in missing:
            outer, place = positions.nested_models.get(model, ('', Pose()))
            if outer in poses or (outer and outer not in positions.free_models):
                poses[model] = StampedPose(stamp_ns, outer, model, place)
                kept.append(model)
        missing = [each for each in missing if each not in poses]
        if not self._kept.issuperset(kept):
            self._kept.update(kept)
            self._logger.info(
                f'{self.name} does not give the poses of {names_in_line(kept)}, which keep their '
                'places in the models around them, as in the file')
        self._to_tell = missing if missing == self._missing else []
        self._missing = missing
