# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Turn frame ids into names of topics.

A frame id may hold anything that XML may hold; a level of a topic name holds ASCII letters, digits
and underscores, and starts with a letter (one that starts with an underscore is legal but hidden
from ``ros2 topic list``). The rule, one level between slashes after another:

* Letters, digits and single underscores stay: ``robot/arm_2/tool`` is its own topic name.
* A run of anything else becomes ``_x<hex>_``, where ``<hex>`` are the bytes of its UTF-8 text, two
  lower-case digits each: ``left camera`` becomes ``left_x20_camera``, ``link-1`` becomes
  ``link_x2d_1``. Underscores beside such a run, and runs of underscores, belong to it:
  ``a__b`` becomes ``a_x5f5f_b``.
* At the beginning of a level the escape is written without its first underscore, and a digit or an
  underscore there is escaped too: ``3d_map`` becomes ``x33_d_map``.
* An empty level becomes ``x_``.
* What reads as an escape already is escaped at its first character: ``a_x20_b`` becomes
  ``a_x5f_x20_b``.
* A name longer than the limit is cut, and the cut is marked ``_xh<hex>_`` with 32 digits of the
  SHA-256 of the frame id.

So two frame ids never share a name (for names that were cut: as surely as SHA-256), and a name
depends on nothing but its frame id and the limit.
"""

from __future__ import annotations

from collections.abc import Generator
from collections.abc import Iterable
from collections.abc import Sequence
import fnmatch
from itertools import groupby
from operator import itemgetter
import re
import string
from typing import NamedTuple

LONGEST_NAME = 160
"""
Default limit for what :func:`topic_name_from_frame_id` returns, in characters.

ROS allows 247 for a full topic name; the rest is for the node's namespace, its name and ``poses``.
"""

SHORTEST_LIMIT = 48
"""A lower limit leaves no room for a mark and something readable before it."""

_PLAIN = re.compile(r'[A-Za-z](?:_?[A-Za-z0-9])*_?')
_READS_AS_ESCAPE = re.compile(r'(?:^|_)x(?:[0-9a-f]{2})+(?=[^A-Za-z0-9])')
_EMPTY_LEVEL = 'x_'
_KEPT = frozenset(string.ascii_letters + string.digits + '_')
_CUT = re.compile(r'_xh[0-9a-f]{32}_$')
_CUT_LENGTH = len('_xh_') + 32


MOST_BY_DEFAULT = 1000
"""So many topics are made without being asked for; each takes time to start, and memory."""

COST_OF_PATTERN = 250
"""As many frame ids are matched in the time that it takes to compile a pattern."""

COST_OF_STEP = 10_000
"""How many frame ids are matched in one step, if there are so many."""

NAMED_IN_STEP = 1000
"""How many frame ids are turned into names in one step."""


class Topics(NamedTuple):
    """What patterns mean for frame ids."""

    names: dict[str, str]
    """The names of the topics by frame id, in the order of the frame ids."""
    idle: list[str]
    """
    The patterns that choose no frame, which are mostly mistakes.

    ``*`` is none, and neither is an empty one, which stands for no topics.
    """


def topic_name_from_frame_id(frame_id: str, limit: int = LONGEST_NAME) -> str:
    """
    Return the name of a frame's topic, as this module's description lays down.

    :param frame_id: any text.
    :param limit: most characters that the name may have; at least ``SHORTEST_LIMIT``.
    :return: a legal relative topic name, no level of which is hidden.
    :raises ValueError: if the limit is too low.
    """
    if limit < SHORTEST_LIMIT:
        msg = f'the limit is {limit} characters, and at least {SHORTEST_LIMIT} are needed'
        raise ValueError(msg)
    name = '/'.join(_level_from_text(level) for level in frame_id.split('/'))
    if len(name) <= limit and not _CUT.search(name):
        return name
    # Seldom needed, and slow to import.
    import hashlib
    digest = hashlib.sha256(_bytes_from_text(frame_id)).hexdigest()[:32]
    return f'{name[:limit - _CUT_LENGTH].rstrip("_/")}_xh{digest}_'


def is_everything_too_much(frame_ids: Sequence[str], patterns: Sequence[str]) -> bool:
    """
    Tell whether a topic for each frame would be more than was meant by the default pattern.

    :param frame_ids: all frame ids.
    :param patterns: glob patterns.
    :return: true if they are just ``*`` and there are more frames than ``MOST_BY_DEFAULT``.
    """
    return list(patterns) == ['*'] and len(frame_ids) > MOST_BY_DEFAULT


def topics_from_patterns(
    frame_ids: Sequence[str], patterns: Iterable[str], limit: int = LONGEST_NAME,
) -> Generator[None, None, Topics]:
    """
    Choose the frames that get a topic, and name it, in steps of milliseconds.

    :param frame_ids: all frame ids.
    :param patterns: glob patterns; ``*`` stands for any text, slashes included. A frame is chosen
        if any of them matches the whole of its id.
    :param limit: as for :func:`topic_name_from_frame_id`.
    :return: the names.
    :raises ValueError: if the limit is too low.
    """
    chosen: set[str] = set()
    idle = []
    cost = 0
    for pattern in dict.fromkeys(patterns):
        cost += COST_OF_PATTERN + len(frame_ids)
        if cost > COST_OF_STEP:
            cost = 0
            yield
        # fnmatch keeps too few compiled patterns for a long list of them.
        matches = re.compile(fnmatch.translate(pattern)).match
        found = [frame_id for frame_id in frame_ids if matches(frame_id)]
        chosen.update(found)
        if not found and pattern not in ('', '*'):
            idle.append(pattern)
    names = {}
    for number, frame_id in enumerate(frame_ids):
        if not number % NAMED_IN_STEP:
            yield
        if frame_id in chosen:
            names[frame_id] = topic_name_from_frame_id(frame_id, limit)
    return Topics(names, idle)


def _level_from_text(text: str) -> str:
    if not text:
        return _EMPTY_LEVEL
    escapes = [match.start() for match in _READS_AS_ESCAPE.finditer(text)]
    if not escapes and text != _EMPTY_LEVEL and _PLAIN.fullmatch(text):
        return text
    escaped = [character not in _KEPT for character in text]
    for place in escapes:
        escaped[place] = True
    if text[0] in string.digits or text == _EMPTY_LEVEL:
        escaped[0] = True
    for place, character in enumerate(text):
        if character == '_':
            before, after = text[place - 1:place], text[place + 1:place + 2]
            escaped[place] |= (
                before in ('', '_') or after == '_'
                or escaped[place - 1] or (after != '' and escaped[place + 1]))
    runs = groupby(zip(text, escaped, strict=True), key=itemgetter(1))
    parts = [(special, ''.join(character for character, _ in run)) for special, run in runs]
    level = ''.join(
        f'_x{_bytes_from_text(part).hex()}_' if special else part for special, part in parts)
    return level.removeprefix('_')


def _bytes_from_text(text: str) -> bytes:
    return text.encode('utf-8', 'surrogatepass')
