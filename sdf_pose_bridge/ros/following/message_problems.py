# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Report messages whose stamps are old, and several publishers of one joint or model."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable
from functools import partial
import time

from sdf_pose_bridge.ros.cdr import NANOSECONDS
from sdf_pose_bridge.ros.following.state_messages import MessageStream, StateSource
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.publishing.published_frames import MovingTopics

LATE_S = 1.0
"""Time in s after which messages with old stamps are reported, if they still move nothing."""

_LEAST_AGE_NS = 1_000_000
"""Smallest difference that makes a stamp old. Stamps are the same while a simulation pauses, and
one nanosecond newer after a reload."""


class MessageProblems:
    """
    The problems of messages that move the same frames.

    :param frames: the frames.
    """

    def __init__(self, frames: MovingTopics) -> None:
        self._frames, self._positions = frames, frames.positions
        self._late: dict[StateSource, MessageStream] = {}
        self._lines_about_publishers: list[str] = []

    def note_lateness(self, stream: MessageStream, stamp_ns: int, now_ns: int) -> None:
        """
        Report messages whose stamps are old, if nothing has moved their transforms for a time.

        :param stream: that of a message that moves nothing.
        :param stamp_ns: its stamp, or the time of the node, in nanoseconds.
        :param now_ns: the time of the node; 0 before the first message on ``/clock``.
        """
        source, now = stream.source, time.monotonic()
        last_ns = self._last_ns(stream)
        if last_ns - stamp_ns < _LEAST_AGE_NS or last_ns != stream.late_after_ns:
            # Others may move them, such as a second publisher with newer stamps.
            stream.late_since, stream.late_after_ns, stream.late_line = now, last_ns, ''
        elif now - stream.late_since > LATE_S and not self._is_late(source):
            first = self._positions.names[stream.selection.changed[0]]
            line = (
                f'messages from {source.name} move nothing, for example {names_in_line([first])}: '
                f'their stamps are {(last_ns - stamp_ns) / NANOSECONDS:.3f} s older than the last '
                'one; set the clock of the publisher, and restart this node if that stamp was '
                'wrong, or set ignore_timestamp:=true') if now_ns else (
                'messages move nothing, as their stamps have gone back; with use_sim_time, this '
                'needs /clock, so play the bag with "ros2 bag play --clock"')
            is_new = all(each.late_line != line for each in self._late.values())
            self._late[source], stream.late_line = stream, line
            if is_new:
                source.warn('stamps', lambda: line)

    def lines(self, sources: Iterable[StateSource]) -> list[str]:
        """Return a line for each source that moves nothing, and for publishers of one joint."""
        late = [self._late[each].late_line for each in sources if self._is_late(each)]
        return [*dict.fromkeys(late), *self._lines_about_publishers]

    def _is_late(self, source: StateSource) -> bool:
        late = self._late.get(source)
        return late is not None and late.late_line != '' and (
            self._last_ns(late) == late.late_after_ns)

    def _last_ns(self, stream: MessageStream) -> int:
        return int(self._frames.last_stamps_ns(stream.rows).min())

    def look_at_publishers(self, streams: Collection[MessageStream]) -> None:
        """
        Report joints and models about which several publishers send messages at once.

        These use several topics for two periods, as a publisher may replace another one in the
        first; or their messages contradict each other on one topic, which has several publishers.

        :param streams: those of all messages that are known.
        """
        sources: dict[int, dict[str, StateSource]] = {}
        found: dict[str, tuple[int, StateSource]] = {}
        lists = Counter(each.source for each in streams if each.counts.messages)
        for stream in streams:
            source, dofs, counts = stream.source, stream.selection.dofs.tolist(), stream.counts
            if dofs and counts.have_several_publishers:
                nodes = source.publishers()
                # Values alone prove little, so each list of names may have its own publisher.
                if len(nodes) > (lists[source] if counts.number is None else 1):
                    found[f'{source.name}, among {names_in_line(nodes)}'] = dofs[0], source
            counts.end_period()
            for dof in dofs if counts.periods > 1 else ():
                sources.setdefault(dof, {})[source.name] = source
        for dof, by_name in sources.items():
            if len(by_name) > 1:
                found.setdefault(' and '.join(sorted(by_name)), (dof, by_name.popitem()[1]))
        self._lines_about_publishers = []
        for topics, (dof, source) in found.items():
            what, setting = ('model', 'model_pose_topics') if self._positions.is_model(dof) else (
                'joint', 'joint_states_topics')
            line = (
                f'messages about {what} {names_in_line([self._positions.names[dof]])} come from '
                f'several publishers at once on {topics}; the newest stamp counts, so stop all '
                f'but one, or leave a topic out of {setting}')
            self._lines_about_publishers.append(line)
            source.warn_once('publishers', [topics], partial(str, line))
