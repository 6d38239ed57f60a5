# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Messages about joints and models: their sources, and streams with the same names."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
import re
import time
from typing import NamedTuple

import numpy as np
from rclpy.node import Node
from rclpy.subscription import Subscription

from sdf_pose_bridge.geometry.poses import pose_products
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.names import scoped_name, SEPARATOR
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.ros.cdr import NO_ROWS, Rows, SerializedNames
from sdf_pose_bridge.ros.following.message_counts import MessageCounts
from sdf_pose_bridge.ros.following.other_publishers import names_of_nodes, publishers_of_topic
from sdf_pose_bridge.ros.log_lines import line_from_text, names_in_line
from sdf_pose_bridge.ros.parameters.rules import MOST_CHARACTERS
from sdf_pose_bridge.ros.publishing.published_frames import MovingTopics
from sdf_pose_bridge.tf.joint_motion import NO_DOF
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION, Selection
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.odometry import Odometry

MOST_BYTES = 4_000_000
"""Largest size of all names and rows that are kept. A message has a quarter of it at most."""

BYTES_OF_OBJECTS = 2_000
"""Size that is counted for the objects of a stream, in addition to its names and rows."""

WARNING_PERIOD_S = 10.0
"""Shortest period in s of warnings about the same thing."""

MOST_REPORTED = 1000
"""Largest number of names that are kept because they were reported."""

_BYTES_OF_MODEL = 200
"""Size that is counted for each model of a stream, and for each frame id."""

@dataclass(eq=False)
class MessageStream:
    """Messages of one source with the same names, and what they change."""

    source: StateSource
    selection: Selection
    """The degrees of freedom."""
    names: SerializedNames | None = None
    """The names of joints; None for poses of models."""
    rows: Rows = field(default_factory=lambda: NO_ROWS)
    """The moving transforms to publish."""
    reported_count: int = -1
    """Number of reported degrees of freedom when these were found; -1 if they were not."""
    late_after_ns: int = 0
    """The oldest last stamp of the transforms when a message moved none, as its own is older."""
    late_since: float = 0.0
    """Monotonic time in s since which there have been only such messages and this stamp."""
    late_line: str = ''
    """The report about these messages; empty if there is none."""
    counts: MessageCounts = field(default_factory=MessageCounts)
    """The messages, to find several publishers."""


class Message(NamedTuple):
    """The fields of a message that are read, and its stream."""

    stream: MessageStream
    values: Floats
    """A position for each name; or the poses of models, shape (k, 7)."""
    stamp_ns: int
    """Its stamp in nanoseconds; 0 if it has none."""
    frame_id: str = ''
    """The frame in which the poses of models are given; empty for the root frame."""
    placed: str = ''
    """The frame of a single model whose pose is given; empty for model frames."""


class StateSource:
    """
    A source of messages about joints or models; logs each warning about them rarely.

    :param name: its full name, for messages.
    :param model: the model that all messages are about; empty for any.
    """

    subscription: Subscription | None = None
    """The subscription for whose messages to wait."""
    is_of_joints: bool
    """Whether it has positions of joints, and not poses of models."""

    def __init__(self, node: Node, name: str, model: str = '') -> None:
        self.name = name
        self.model = model
        self.last_ns = 0
        """Time of the node when the last message was used; the caller sets it."""
        self.number: int | None = None
        """The number that its publisher has given the last message, if messages have numbers."""
        self.carried = set[tuple[int, str]]()
        """The free models without a pose of their own since those of frames that they carry, with
        the names of these."""
        self._node = node
        self._logger = node.get_logger()
        self._warnings_due: dict[str, float] = {}
        self._reported_names: set[str] = set()

    @property
    def has_answers(self) -> bool:
        """Whether messages wait that no subscription has."""
        return False

    def messages(self, streams: KnownStreams) -> Sequence[Message] | None:
        """Take a message; return its part of each stream, or None if there is none."""
        raise NotImplementedError

    def take(self, streams: KnownStreams, newest: dict[MessageStream, Message]) -> bool:
        """
        Take a message.

        :param newest: gets it, unless the one of the same stream there is newer.
        :return: whether there was one.
        """
        messages = self.messages(streams)
        for message in messages or ():
            stream = message.stream
            stream.counts.add(message.stamp_ns, message.values, self.number)
            known = newest.get(stream, message)
            if not 0 < message.stamp_ns < known.stamp_ns:
                newest[stream] = message
        return messages is not None

    def publishers(self) -> list[str]:
        """Return the full name of the node of each publisher."""
        return names_of_nodes(publishers_of_topic(self._node, self.name))

    def is_due(self, about: str) -> bool:
        """Return whether the last warning about the same was long ago."""
        return time.monotonic() >= self._warnings_due.get(about, 0.0)

    def warn(self, about: str, text: Callable[[], str]) -> bool:
        """Log a warning, unless the last one about the same was not long ago."""
        is_due = self.is_due(about)
        if is_due:
            self._warnings_due[about] = time.monotonic() + WARNING_PERIOD_S
            self._logger.warning(line_from_text(text()))
        return is_due

    def warn_once(self, about: str, names: Sequence[str], text: Callable[[], str]) -> None:
        """Log a warning about names, unless all of them have been reported before."""
        if not self._reported_names.issuperset(names) and self.warn(about, text):
            self._reported_names.update(names[:MOST_REPORTED - len(self._reported_names)])

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


class KnownStreams:
    """
    The streams of messages from all sources.

    :param frames: the frames that messages move.
    :param lookup: looks up frames in which poses of models are given.
    :param root_patterns: patterns of frame ids that mean the root frame.
    :param placement: the name of a frame in each model that poses on topics are of.
    """

    def __init__(
        self, frames: MovingTopics, lookup: PoseLookup,
        root_patterns: Sequence[re.Pattern[str]] = (), placement: str = '',
    ) -> None:
        self.lookup = lookup
        self._positions = frames.positions
        self._frames = frames
        self._root_patterns = root_patterns
        self._pose_frames: dict[str, tuple[str | None, int]] = {}
        # By the source, and the names of joints or the degrees of freedom of models.
        self._streams: dict[tuple[StateSource, tuple[object, ...]], MessageStream] = {}
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
        self._odometry = tree.odometry
        models = defaultdict[tuple[str, str], set[int]](set)
        self._meanings = defaultdict[tuple[int, str], dict[Odometry, str]](dict)
        for (dof, frame_id, topic), odometry in tree.odometry.items():
            models[topic, frame_id].add(dof)
            if topic:
                self._meanings[dof, frame_id].setdefault(odometry, topic)
        self.models_of_odometry = {
            key: dofs.pop() for key, dofs in models.items() if len(dofs) == 1}
        """The degrees of freedom of free models by topics and frames of their odometry."""
        self.placements = {
            dof: frame for dof, name in self._scoped_names.items()
            if placement and lookup.knows(frame := scoped_name(name, placement))}
        """The frames that poses on topics are of, if not model frames, by the free models."""
        doubted = [
            frame_id for (_, frame_id, topic), each in self._odometry.items()
            if not topic and each.is_of_wheels
            and any(pattern.match(frame_id) for pattern in root_patterns)]
        self.doubts: list[str] = []
        """Warnings about parameters, for the first message."""
        if doubted:
            self.doubts.append(
                f'model_pose_frames has no effect on {names_in_line(doubted)}: the odometry of '
                'wheels counts from where the file puts the model')
        if placement and not self.placements:
            self.doubts.append(
                f'model_pose_placement: no model that can move has {names_in_line([placement])}')
        self.last: dict[StateSource, MessageStream] = {}
        """The stream of the last message on each topic of joint states, while cached."""
        self._size = 0

    def of_joints(self, names: SerializedNames, source: StateSource) -> MessageStream:
        """Return the stream of positions of joints; log unknown and ambiguous names."""
        found = self._streams.get((source, names.names))
        if found is None:
            model = source.model
            found = MessageStream(source, self._positions.selection(names.names, model), names)
            self._make_room(BYTES_OF_OBJECTS + len(names.data) + 16 * len(names.names))
            self._streams[source, names.names] = found
            unknown = [each for each in self._positions.unknown(names.names, model)
                       if each not in self._positions.fixed_joints]
            if unknown:
                where = f' in model "{model}"' if model else ''
                source.warn('names', lambda: (
                    f'{source.name} has {names_in_line(unknown)}, not the name of one moving '
                    f'joint{where}{self._positions.hint(unknown[0], model)}'))
        self.last[source] = found
        return found

    def of_models(self, dofs: tuple[int, ...], source: StateSource) -> MessageStream:
        """Return the stream of poses of free models."""
        found = self._streams.get((source, dofs))
        if found is None:
            self._make_room(BYTES_OF_OBJECTS + _BYTES_OF_MODEL * len(dofs))
            found = self._streams[source, dofs] = MessageStream(
                source, self._positions.selection_of_models(dofs))
        return found

    @property
    def known(self) -> Collection[MessageStream]:
        """The streams that are kept."""
        return self._streams.values()

    def dofs_of_others(self, source: StateSource) -> set[int]:
        """Return the degrees of freedom about which other sources have sent messages."""
        return {
            dof for stream in self._streams.values() if stream.source is not source
            for dof in stream.selection.changed}

    def rows(self, stream: MessageStream) -> Rows:
        """Return the transforms that a message moves, and those of what is where the file is."""
        reported_count = self._positions.reported_count
        if stream.reported_count != reported_count and stream.selection.changed:
            stream.reported_count = reported_count
            stream.rows = self._frames.rows_from_dofs(stream.selection.changed)
            self._make_room(stream.rows.nbytes)
        return stream.rows

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
        if child and not name and child not in self.models:
            # As in the file of the model, without its name.
            in_model = scoped_name(self._scoped_names[model], child.replace('/', SEPARATOR))
            name = in_model if self.lookup.knows(in_model) else ''
        return model, name

    def hint(self, child: str) -> str:
        """Return the end of a message about a child frame id that names no model."""
        for frame_id in self._frames.tree.frame_ids if child else ():
            if frame_id.endswith(f'/{child}'):
                return f'; did you mean "{frame_id}"?'
        return hint_from_names(child, self.models)

    def odometry_in(self, frame_id: str, dof: int, source: StateSource) -> Odometry | None:
        """Find the odometry of a free model in a frame: that of the topic, or else the first."""
        topics = self._meanings.get((dof, frame_id), {})
        found = self._odometry.get((dof, frame_id, source.name))
        if found is None and len(topics) > 1:
            source.warn_once('odometry', [frame_id], lambda: (
                f'{source.name} has poses in {names_in_line([frame_id])}, the frame of the '
                'odometry of several plugins, and is none of their topics '
                f'{names_in_line([*topics.values()])}; its poses count as on the first of these; '
                'give each plugin a frame of its own in the file'))
        return found or self._odometry.get((dof, frame_id, ''))

    def pose_frame(
        self, frame_id: str, ends_at: float, source: StateSource,
    ) -> tuple[str | None, int] | None:
        """
        Look up a frame id in the header of a pose, and keep what is found.

        :param ends_at: the processor time of this thread in s from which nothing is looked up.
        :param source: logs that a pattern makes it the root frame, if this is the first one.
        :return: the name of the frame, which is empty for the root frame, or None if there is no
            such frame; and its :meth:`PoseLookup.first_dof`. None if it was not looked up.
        """
        found = self._pose_frames.get(frame_id)
        if found is None and time.thread_time() < ends_at:
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

    def values(self, message: Message) -> Floats:
        """
        Return the positions, or the poses in the root frame, that a message has.

        :raises SdfError: if its poses are given in a frame whose pose is not known, or of one.
        """
        values = message.values
        if message.placed:
            model = self._scoped_names[message.stream.selection.changed[0]]
            values = pose_products(
                values, np.array([self.lookup.pose(model, message.placed).pose]))
        if message.frame_id:
            values = pose_products(np.array(self.lookup.pose(message.frame_id).pose), values)
        return values

    def _make_room(self, size: int) -> None:
        """Forget everything if it would be too much."""
        self._size += size
        if self._size > MOST_BYTES:
            self._streams.clear()
            self._pose_frames.clear()
            self.last.clear()
            self._size = size
