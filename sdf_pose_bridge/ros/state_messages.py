# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Messages about joints and models: their sources, and what each of them changes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
import re
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.subscription import Subscription

from sdf_pose_bridge.geometry.poses import pose_products
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.ros.cdr import NANOSECONDS, SerializedNames
from sdf_pose_bridge.ros.log_lines import names_in_line, RareWarnings
from sdf_pose_bridge.ros.message_counts import MessageCounts
from sdf_pose_bridge.ros.other_publishers import names_of_nodes, publishers_of_topic
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.setting_rules import MOST_CHARACTERS
from sdf_pose_bridge.tf.joint_motion import NO_DOF
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION, Selection
from sdf_pose_bridge.tf.lookup import PoseLookup

MOST_BYTES = 4_000_000
"""Largest size of all names and rows that are kept. A message has a quarter of it at most."""

BYTES_OF_OBJECTS = 2_000
"""Size that is counted for the objects of an effect, in addition to its names and rows."""

_BYTES_OF_MODEL = 200
"""Size that is counted for each model of an effect, and for each frame id."""

LATE_S = 1.0
"""Time in s after which messages with old stamps are reported, if they still move nothing."""

_LEAST_AGE_NS = 1_000_000
"""Smallest difference that makes a stamp old. Stamps are the same while a simulation pauses, and
one nanosecond newer after a reload."""



@dataclass(eq=False)
class Effect:
    """The degrees of freedom and the transforms that messages with the same names change."""

    source: StateSource
    selection: Selection
    """The degrees of freedom."""
    names: SerializedNames | None = None
    """The names of joints; None for poses of models."""
    rows: NDArray[np.intp] = field(default_factory=lambda: np.array([], np.intp))
    """The moving transforms to publish."""
    reported_count: int = -1
    """Number of reported degrees of freedom when these were found; -1 if they were not."""
    late_after_ns: int = 0
    """The oldest last stamp of the transforms when a message moved none, as its own is older."""
    late_since: float = 0.0
    """Monotonic time in s since which there have been only such messages and this stamp."""
    counts: MessageCounts = field(default_factory=MessageCounts)
    """The messages, to find several publishers."""


class Message(NamedTuple):
    """The fields of a message that are read, and its effect."""

    effect: Effect
    values: NDArray[np.float64]
    """A position for each name; or the poses of models, shape (k, 7)."""
    stamp_ns: int
    """Its stamp in nanoseconds; 0 if it has none."""
    frame_id: str = ''
    """The frame in which the poses of models are given; empty for the root frame."""
    placed: str = ''
    """The frame of a single model whose pose is given; empty for model frames."""


class Lateness(NamedTuple):
    """Messages of a source that move nothing, as their stamps are old."""

    line: str
    rows: NDArray[np.intp]
    """The transforms that have waited longest for a newer stamp."""
    last_ns: int
    """Their last stamp."""


class StateSource(RareWarnings):
    """
    A source of messages about joints or models.

    :param name: its full name, for messages.
    :param model: the model that all messages are about; empty for any.
    """

    subscription: Subscription | None = None
    """The subscription for whose messages to wait."""

    def __init__(self, node: Node, name: str, model: str = '') -> None:
        self.name = name
        self.model = model
        self.last_ns = 0
        """Time of the node when the last message was used; the caller sets it."""
        self.number: int | None = None
        """The number that its publisher has given the last message, if messages have numbers."""
        self._node = node
        super().__init__(node.get_logger())

    @property
    def has_answers(self) -> bool:
        """Whether messages wait that no subscription has."""
        return False

    def messages(self, effects: Effects) -> Sequence[Message] | None:
        """Take a message; return what it has for each of its effects, or None if there is none."""
        raise NotImplementedError

    def take(self, effects: Effects, newest: dict[Effect, Message]) -> bool:
        """
        Take a message.

        :param newest: gets it, unless the one with the same effect there is newer.
        :return: whether there was one.
        """
        messages = self.messages(effects)
        for message in messages or ():
            effect = message.effect
            effect.counts.add(message.stamp_ns, message.values, self.number)
            known = newest.get(effect, message)
            if not 0 < message.stamp_ns < known.stamp_ns:
                newest[effect] = message
        return messages is not None

    def publishers(self) -> list[str]:
        """Return the full name of the node of each publisher."""
        return names_of_nodes(publishers_of_topic(self._node, self.name))

    def warn_about_invalid(self, names: Sequence[str]) -> None:
        """Log the joints or models whose values cannot be used, if there are any."""
        if names:
            self.warn('values', lambda: (
                f'{self.name} has values for {names_in_line(names)} that are not finite or '
                f'beyond {LARGEST_POSITION:g}; the last ones are kept'))

    def tell_of_root(self, frame_id: str) -> None:
        """Log a frame that counts as the root frame by a parameter, the first time."""
        self._logger.info(
            f'{self.name} has poses in {names_in_line([frame_id])}, which counts as the root '
            'frame by model_pose_frames; no plugin in the file says where it is', once=True)


class Effects:
    """
    The effects of messages from all sources, kept for messages with the same names.

    :param frames: the frames that messages move.
    :param lookup: looks up frames in which poses of models are given.
    :param root_patterns: patterns of frame ids that mean the root frame.
    :param placement: the name of a frame in each model that poses on topics are of.
    """

    def __init__(
        self, frames: PublishedMovingFrames, lookup: PoseLookup,
        root_patterns: Sequence[re.Pattern[str]] = (), placement: str = '',
    ) -> None:
        self.lookup = lookup
        self._positions = frames.positions
        self._frames = frames
        self._root_patterns = root_patterns
        self._pose_frames: dict[str, tuple[str | None, int]] = {}
        # By the source, and the names of joints or the degrees of freedom of models.
        self._effects: dict[tuple[StateSource, tuple[object, ...]], Effect] = {}
        tree, motion = frames.tree, frames.frames.motion
        self._roots = ('', tree.root_frame, tree.world)
        count, free_models = len(motion.dofs), frames.positions.free_models
        self._scoped_names = dict(enumerate(free_models, count))
        ids = dict(zip(tree.elements.tolist(), tree.frame_ids, strict=True))
        self.models = frames.positions.others | {
            each: dof for dof, scoped in self._scoped_names.items()
            for name in [motion.names[dof]]
            for each in (name, scoped, ids.get(motion.elements[dof], name))}
        """The degrees of freedom of free models by their names and frame ids, and of others."""
        self.only_model = count if len(free_models) == 1 else None
        """The degree of freedom of the only free model; None if there is not exactly one."""
        self.odometry = tree.odometry
        self.placements = {
            dof: frame for dof, name in self._scoped_names.items()
            if placement and lookup.knows(frame := scoped_name(name, placement))}
        """The frames that poses on topics are of, if not model frames, by the free models."""
        doubted = [
            frame_id for (_, frame_id), each in self.odometry.items()
            if each.is_of_wheels and any(pattern.match(frame_id) for pattern in root_patterns)]
        self.doubts: list[str] = []
        """Warnings about parameters, for the first message."""
        if doubted:
            self.doubts.append(
                f'model_pose_frames has no effect on {names_in_line(doubted)}: the odometry of '
                'wheels counts from where the file puts the model')
        if placement and not self.placements:
            self.doubts.append(
                f'model_pose_placement: no model that can move has {names_in_line([placement])}')
        self.last: dict[StateSource, Effect] = {}
        """The effect of the last message on each topic of joint states, as far as it is kept."""
        self._late: dict[StateSource, Lateness] = {}
        self._lines_about_publishers: list[str] = []
        self._size = 0

    def of_joints(self, names: SerializedNames, source: StateSource) -> Effect:
        """Return the effect of positions of joints; log unknown and ambiguous names."""
        found = self._effects.get((source, names.names))
        if found is None:
            model = source.model
            found = Effect(source, self._positions.selection(names.names, model), names)
            self._make_room(BYTES_OF_OBJECTS + len(names.data) + 16 * len(names.names))
            self._effects[source, names.names] = found
            unknown = self._positions.unknown(names.names, model)
            if unknown:
                where = f' in model "{model}"' if model else ''
                source.warn('names', lambda: (
                    f'{source.name} has {names_in_line(unknown)}, not the name of one moving '
                    f'joint{where}{self._positions.hint(unknown[0], model)}'))
        self.last[source] = found
        return found

    def of_models(self, dofs: tuple[int, ...], source: StateSource) -> Effect:
        """Return the effect of poses of free models."""
        found = self._effects.get((source, dofs))
        if found is None:
            self._make_room(BYTES_OF_OBJECTS + _BYTES_OF_MODEL * len(dofs))
            found = self._effects[source, dofs] = Effect(
                source, self._positions.selection_of_models(dofs))
        return found

    def dofs_of_others(self, source: StateSource) -> set[int]:
        """Return the degrees of freedom about which other sources have sent messages."""
        return {
            dof for effect in self._effects.values() if effect.source is not source
            for dof in effect.selection.changed}

    def rows(self, effect: Effect) -> NDArray[np.intp]:
        """Return the transforms that a message moves, and those of what is where the file is."""
        reported_count = self._positions.reported_count
        if effect.reported_count != reported_count and effect.selection.changed:
            effect.reported_count = reported_count
            effect.rows = self._frames.rows_from_dofs(effect.selection.changed)
            self._make_room(effect.rows.nbytes)
        return effect.rows

    def placed_frame(self, child: str, dof: int | None) -> tuple[int | None, str]:
        """
        Find the frame whose pose is given.

        :param child: the child frame id of the pose; empty for none.
        :param dof: the free model that it has to be in, if it is known; None for any.
        :return: the free model that it moves with, or None if there is no such frame; and its
            name, which is empty for the model frame.
        """
        model, name = self.models.get(child), ''
        if model is None and child and self.lookup.knows(child):
            model, name = self.lookup.first_dof(child), child
            if model not in self._scoped_names:
                return None, ''
        if model is None:
            model = dof
        if model is None or dof not in (None, model):
            return None, ''
        return model, name

    def pose_frame(
        self, frame_id: str, ends_at: float, source: StateSource,
    ) -> tuple[str | None, int] | None:
        """
        Look up a frame id in the header of a pose, and keep what is found.

        :param ends_at: the monotonic time in s from which nothing is looked up.
        :param source: logs that a pattern makes it the root frame, if this is the first one.
        :return: the name of the frame, which is empty for the root frame, or None if there is no
            such frame; and its :meth:`PoseLookup.first_dof`. None if it was not looked up.
        """
        found = self._pose_frames.get(frame_id)
        if found is None and time.monotonic() < ends_at:
            name = frame_id if self.lookup.knows(frame_id) else None
            if frame_id in self._roots:
                name = ''
            elif len(frame_id) <= MOST_CHARACTERS and any(
                    pattern.match(frame_id) for pattern in self._root_patterns):
                name = ''
                source.tell_of_root(frame_id)
            found = name, self.lookup.first_dof(frame_id) if name else NO_DOF
            self._make_room(_BYTES_OF_MODEL + len(frame_id))
            self._pose_frames[frame_id] = found
        return found

    def values(self, message: Message) -> NDArray[np.float64]:
        """
        Return the positions, or the poses in the root frame, that a message has.

        :raises SdfError: if its poses are given in a frame whose pose is not known, or of one.
        """
        values = message.values
        if message.placed:
            model = self._scoped_names[message.effect.selection.changed[0]]
            values = pose_products(
                values, np.array([self.lookup.pose(model, message.placed).pose]))
        if message.frame_id:
            values = pose_products(np.array(self.lookup.pose(message.frame_id).pose), values)
        return values

    def note_lateness(self, effect: Effect, stamp_ns: int, now_ns: int) -> None:
        """
        Report messages whose stamps are old, if nothing has moved their transforms for a time.

        :param effect: that of one that moves nothing.
        :param stamp_ns: its stamp, or the time of the node, in nanoseconds.
        :param now_ns: the time of the node; 0 before the first message on ``/clock``.
        """
        source, now = effect.source, time.monotonic()
        stamps_ns = self._frames.last_stamps_ns(effect.rows)
        last_ns = int(stamps_ns.min())
        if last_ns - stamp_ns < _LEAST_AGE_NS or last_ns != effect.late_after_ns:
            # Others may move them, such as a second publisher with newer stamps.
            effect.late_since, effect.late_after_ns = now, last_ns
        elif now - effect.late_since > LATE_S and not self._is_late(source):
            first = self._positions.names[effect.selection.changed[0]]
            line = (
                f'messages from {source.name} move nothing, for example {names_in_line([first])}: '
                f'their stamps are {(last_ns - stamp_ns) / NANOSECONDS:.3f} s older than the last '
                'one; set the clock of the publisher, and restart this node if that stamp was '
                'wrong, or set ignore_timestamp:=true') if now_ns else (
                'messages move nothing, as their stamps have gone back; with use_sim_time, this '
                'needs /clock, so play the bag with "ros2 bag play --clock"')
            is_new = all(each.line != line for each in self._late.values())
            self._late[source] = Lateness(line, effect.rows[stamps_ns == last_ns], last_ns)
            if is_new:
                source.warn('stamps', lambda: line)

    def problems(self, sources: Iterable[StateSource]) -> list[str]:
        """Return a line for each source that moves nothing, and for publishers of one joint."""
        late = [each for each in sources if self._is_late(each)]
        lines = dict.fromkeys(self._late[each].line for each in late)
        return [*lines, *self._lines_about_publishers]

    def _is_late(self, source: StateSource) -> bool:
        late = self._late.get(source)
        return late is not None and bool(
            (self._frames.last_stamps_ns(late.rows) == late.last_ns).all())

    def look_at_publishers(self) -> None:
        """
        Report joints and models about which several publishers send messages at once.

        These use several topics for two periods, as a publisher may replace another one in the
        first; or their messages contradict each other on one topic, which has several publishers.
        """
        sources: dict[int, dict[str, StateSource]] = {}
        found: dict[str, tuple[str, int, StateSource]] = {}
        lists = Counter(each.source for each in self._effects.values() if each.counts.messages)
        for effect in self._effects.values():
            source, dofs, counts = effect.source, effect.selection.dofs.tolist(), effect.counts
            if dofs and counts.have_several_publishers:
                nodes = source.publishers()
                # Values alone prove little, so each list of names may have its own publisher.
                if len(nodes) > (lists[source] if counts.number is None else 1):
                    found[source.name] = f', among {names_in_line(nodes)}', dofs[0], source
            counts.end_period()
            for dof in dofs if counts.periods > 1 else ():
                sources.setdefault(dof, {})[source.name] = source
        for dof, by_name in sources.items():
            if len(by_name) > 1:
                found.setdefault(' and '.join(sorted(by_name)), ('', dof, by_name.popitem()[1]))
        self._lines_about_publishers = []
        for topics, (nodes_of_topic, dof, source) in found.items():
            what, setting = ('model', 'model_pose_topics') if self._positions.is_model(dof) else (
                'joint', 'joint_states_topics')
            line = (
                f'messages about {what} {names_in_line([self._positions.names[dof]])} come from '
                f'several publishers at once on {topics}{nodes_of_topic}; the newest stamp '
                f'counts, so stop all but one, or leave a topic out of {setting}')
            self._lines_about_publishers.append(line)
            source.warn_once('publishers', [topics], partial(str, line))

    def _make_room(self, size: int) -> None:
        """Forget everything if it would be too much."""
        self._size += size
        if self._size > MOST_BYTES:
            self._effects.clear()
            self._pose_frames.clear()
            self.last.clear()
            self._size = size
