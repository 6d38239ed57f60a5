# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names in SDFormat: scopes and reserved names."""

from __future__ import annotations

SEPARATOR = '::'
"""Separates the parts of a scoped name: ``robot::arm::hand``."""

WORLD_FRAME = 'world'
"""The name of the frame of a world in references."""

ROOT_FRAME = '__root__'
"""The implicit root of a model file. No file may write this name."""

MODEL_FRAME = '__model__'
"""The name of the frame of a model in references inside the model."""

PROXY_START, PROXY_END = '_merged__', '__model__'
"""The beginning and the end of the name of the frame that replaces the frame of a merged model."""

JOINT_SUFFIX = '_joint'
"""Appended to the name of a joint if another element has the name."""


def is_reserved(name: str) -> bool:
    """
    Return whether a name without its scope is reserved (``isReservedName`` of libsdformat).

    :return: True for ``world``, and for four or more characters that begin and end with ``__``.
    """
    return name == WORLD_FRAME or (
        len(name) >= 4 and name.startswith('__') and name.endswith('__'))


def is_name_of_proxy(name: str) -> bool:
    """Return whether a merge may have made a name."""
    return name.startswith(PROXY_START) and name.endswith(PROXY_END)


def scoped_name(scope: str, name: str) -> str:
    """
    Return the absolute name of an element or of the target of a reference.

    :param scope: absolute name of its scope; empty for a world or the implicit root.
    """
    return f'{scope}{SEPARATOR}{name}' if scope else name


def unused_name(name: str, used: dict[str, int], separator: str = '_') -> str:
    """Return a name, numbered if it is used, and add it; ``used`` has the last number of each."""
    unused = name
    while unused in used:
        used[name] += 1
        unused = f'{name}{separator}{used[name]}'
    used[unused] = 0
    return unused
