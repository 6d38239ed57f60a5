# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The values that parameters can have.

Each function makes the setting of a value. If the value is not allowed, it raises ValueError with
the words that follow "parameter <name>" in a sentence.
"""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence
import enum
from pathlib import Path
from typing import TypeVar

from sdf_pose_bridge.names import printable
from sdf_pose_bridge.sdformat.grammar import Kind

Choice = TypeVar('Choice', bound=enum.Enum)

PUBLISHED_KINDS = {
    kind.label: kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD, Kind.ACTOR)}
"""The kinds of element that can become frames, by their names."""

LOWEST_RATE, HIGHEST_RATE = 0.001, 100.0
"""The limits of ``publish_rate`` in Hz."""

MOST_PATTERNS = 1000
"""How many patterns a parameter may have."""


def root_frame_setting(value: str) -> str:
    """Refuse what cannot be the frame id of the root."""
    if not value:
        raise _refusal(value, 'a frame id, which is not empty')
    return prefix_setting(value)


def prefix_setting(value: str) -> str:
    """Refuse what frame ids cannot begin with."""
    if value.startswith('/'):
        raise _refusal(value, 'without a leading slash, which TF does not allow')
    return _without_control_characters(value)


def separator_setting(value: str) -> str:
    """Refuse what cannot separate the parts of frame ids."""
    if not value:
        raise _refusal(value, 'at least one character, or names run together')
    return _without_control_characters(value)


def rate_setting(value: float) -> float:
    """Refuse rates that are too low, too high or not a number; 0.0 is for never."""
    if value and not LOWEST_RATE <= value <= HIGHEST_RATE:
        raise _refusal(value, f'0.0 for never, or from {LOWEST_RATE} to {HIGHEST_RATE}')
    return value


def choice_setting(choices: type[Choice]) -> Callable[[str], Choice]:
    """Return a function that makes members of an enumeration."""
    def convert(value: str) -> Choice:
        known = [choice.value for choice in choices]
        if value not in known:
            raise _refusal(value, f'one of {", ".join(known)}')
        return choices(value)
    return convert


def kinds_setting(values: Sequence[str]) -> frozenset[Kind]:
    """Make kinds of element of their names."""
    known = ', '.join(PUBLISHED_KINDS)
    if not values:
        raise _refusal([], f'at least one of {known}')
    for value in values:
        if value not in PUBLISHED_KINDS:
            raise _refusal(value, f'made of {known}')
    return frozenset(PUBLISHED_KINDS[value] for value in values)


def patterns_setting(values: Sequence[str]) -> tuple[str, ...]:
    """Refuse too many patterns."""
    if len(values) > MOST_PATTERNS:
        # Each is compared with each frame, while other changes wait.
        msg = f'has {len(values)} patterns; it must have at most {MOST_PATTERNS}'
        raise ValueError(msg)
    return tuple(values)


def directories_setting(values: Sequence[str]) -> tuple[Path, ...]:
    """Make paths, without those that are empty."""
    return tuple(Path(value).expanduser() for value in values if value)


def _without_control_characters(value: str) -> str:
    if not value.isprintable():
        raise _refusal(value, 'without control characters')
    return value


def _refusal(value: object, rule: str) -> ValueError:
    shown = f'"{printable(value)}"' if isinstance(value, str) else value
    return ValueError(f'is {shown}; it must be {rule}')
