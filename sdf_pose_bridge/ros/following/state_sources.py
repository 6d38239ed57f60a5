# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Subscribe to the topics of joint states and of poses of models, and ask the simulator."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
import contextlib
import functools

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy

from sdf_pose_bridge.ros.background import result_from_executor
from sdf_pose_bridge.ros.cdr import JOINT_STATE, POSE_TYPES
from sdf_pose_bridge.ros.following.simulator import Simulator
from sdf_pose_bridge.ros.following.state_messages import StateSource
from sdf_pose_bridge.ros.following.state_topic import StateTopic, TopicKey
from sdf_pose_bridge.ros.log_lines import line_from_text, names_in_line
from sdf_pose_bridge.ros.parameters.declarations import Settings
from sdf_pose_bridge.ros.publishing.topic_names import StateTopics
from sdf_pose_bridge.tf.joint_positions import JointPositions

SEARCH_PERIOD_S = 1.0
"""Period of the search for publishers of poses, whose type is that of the topic."""


class StateSources:
    """
    The sources of messages that are wanted.

    The loader calls :meth:`follow`, and the executor of the node calls the rest.

    :param changed: called by the executor when it has found other sources, with the topics to
        :meth:`close` when nothing awaits them.
    :param wake: called when the simulator has answered.
    """

    def __init__(
        self, node: Node, changed: Callable[[Sequence[StateTopic]], None],
        wake: Callable[[], None],
    ) -> None:
        self._node = node
        self._logger = node.get_logger()
        self._changed, self._wake = changed, wake
        self._topics: dict[TopicKey, StateTopic] = {}
        self._wanted = StateTopics({})
        self.simulator: Simulator | None = None
        self._reported: set[tuple[str, ...]] = set()
        self._search = node.create_timer(
            SEARCH_PERIOD_S, self._find_publishers, autostart=False,
            clock=Clock(clock_type=ClockType.STEADY_TIME))

    @property
    def sources(self) -> tuple[StateSource, ...]:
        """All sources; those with a subscription come first."""
        return (*self._topics.values(), *([self.simulator] if self.simulator else []))

    def follow(
        self, topics: StateTopics, settings: Settings, positions: JointPositions,
    ) -> list[StateTopic]:
        """
        Change what is wanted.

        :param positions: the free models.
        :return: the topics that are no longer wanted, to :meth:`close` when nothing awaits them.
        """
        if topics.warnings != self._wanted.warnings:
            for line in topics.warnings:
                self._logger.warning(line)
        unwanted = result_from_executor(self._node, lambda: self._want(topics))
        for key in [TopicKey(*each, JOINT_STATE) for each in topics.joint_states.items()]:
            if key not in self._topics:
                # The executor goes on between two of them.
                result_from_executor(self._node, functools.partial(self._open, key))
        result_from_executor(self._node, lambda: self._follow_others(settings, positions))
        return unwanted

    def close(self, topics: Sequence[StateTopic]) -> None:
        """Have the executor destroy subscriptions; any thread may call this."""
        for topic in topics:
            self._node.executor.create_task(self._node.destroy_subscription, topic.subscription)

    def end(self) -> None:
        """Destroy all subscriptions."""
        self._node.destroy_timer(self._search)
        for topic in self._topics.values():
            self._node.destroy_subscription(topic.subscription)
        if self.simulator is not None:
            self.simulator.end()

    def _want(self, topics: StateTopics) -> list[StateTopic]:
        self._wanted = topics
        return [
            self._topics.pop(key) for key in [*self._topics]
            if (topics.joint_states if key.type_name == JOINT_STATE else topics.model_poses).get(
                key.name) != key.model]

    def _follow_others(self, settings: Settings, positions: JointPositions) -> None:
        """Follow topics of poses, and the simulator."""
        self._search.cancel()
        if self._wanted.model_poses:
            self._search.reset()
            self._find_publishers()
        current = self.simulator
        wanted = settings.simulator if positions.free_models or settings.simulator_others else ''
        if current is not None and current.given_name != wanted:
            current.end()
            self.simulator = current = None
        if wanted and current is None:
            with self._failure_told(wanted):
                self.simulator = current = Simulator(self._node, wanted, self._wake)
        if current is not None:
            current.follow(positions, settings)

    def _open(self, key: TopicKey) -> None:
        with self._failure_told(key.name):
            self._topics[key] = StateTopic(self._node, key)

    @contextlib.contextmanager
    def _failure_told(self, name: str) -> Iterator[None]:
        try:
            yield
        except (RuntimeError, ValueError) as error:
            # Security may forbid it, or the name is too long with that of the namespace. The rest
            # of the message names lines of the source of ROS.
            reason = line_from_text(str(error).partition(', at /')[0])
            self._logger.warning(f'no messages from {name}: {reason}')

    def _find_publishers(self) -> None:
        """Subscribe to topics of poses with the types with which they are published."""
        types = dict(self._node.get_topic_names_and_types())
        current = defaultdict[tuple[str, str], list[TopicKey]](list)
        for key in self._topics:
            if key.type_name != JOINT_STATE:
                current[key[:2]].append(key)
        before = self._topics.copy()
        for place in self._wanted.model_poses.items():
            name, keys = self._node.resolve_topic_name(place[0]), current[place]
            known_types = [each.type_name for each in keys[:1]]
            has_messages = any(self._topics[each].last_ns for each in keys)
            if types.get(name, []) == [] or (types[name] == known_types and has_messages):
                continue
            publishers = self._node.get_publishers_info_by_topic(name)
            found = sorted({each.topic_type for each in publishers})
            if len(found) == 1 and found[0] in POSE_TYPES:
                are_latched = {False, *(
                    each.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
                    for each in publishers)}
                # A topic has one type in a process, so subscriptions have to be destroyed before
                # the next search makes some of another type.
                for key in keys if found != known_types else ():
                    del self._topics[key]
                for key in (TopicKey(*place, found[0], each) for each in sorted(are_latched)):
                    if key not in keys and (found == known_types or not keys):
                        self._open(key)
            elif found and (name, *found) not in self._reported:
                self._reported.add((name, *found))
                self._logger.warning(
                    f'{name} has messages of {names_in_line(found)}; topics in model_pose_topics '
                    f'must have one type, which is one of {names_in_line(list(POSE_TYPES))}')
        if self._topics != before:
            self._changed([before[key] for key in before.keys() - self._topics.keys()])
