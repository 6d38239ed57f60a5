# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the top-level models that get a transform from the root frame."""

from __future__ import annotations

import enum
from fnmatch import fnmatchcase
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.parents import TfParents


class AnchorModels(enum.Enum):
    """The top-level models that get a transform from the root frame, by a word."""

    AUTO = 'auto'
    """All models of a world; for a model file or URDF, like ``STATIC``."""
    ALL = 'all'
    STATIC = 'static'
    """Static models, and models that a joint connects to the world."""
    NONE = 'none'


class AnchorPatterns(NamedTuple):
    """The top-level models that get a transform from the root frame, by their names."""

    patterns: tuple[str, ...]
    """Glob patterns of the names of top-level models, not empty."""
    has_static: bool = False
    """Whether the models of :attr:`AnchorModels.STATIC` get one too."""


def anchors_from_text(text: str) -> AnchorModels | AnchorPatterns:
    """
    Read a value of the parameter ``anchor_models``.

    :param text: a value of :class:`AnchorModels`, or glob patterns of names, separated by commas,
        such as ``table*,fence``; ``static`` may be one of them.
    :raises ValueError: with the rule, if a pattern is empty, or another word is among patterns.
    """
    words = [each.value for each in AnchorModels]
    if text in words:
        return AnchorModels(text)
    patterns = [pattern.strip() for pattern in text.split(',')]
    if '' in patterns or not {*patterns}.isdisjoint({*words} - {AnchorModels.STATIC.value}):
        msg = (f'one of {", ".join(words)}, or patterns of names of models with commas between '
               'them, none of which is empty or auto, all or none')
        raise ValueError(msg)
    return AnchorPatterns(
        tuple(pattern for pattern in patterns if pattern != AnchorModels.STATIC.value),
        AnchorModels.STATIC.value in patterns)


def detached_bodies(
    scene: Scene, tf_parents: TfParents, anchors: AnchorModels | AnchorPatterns,
    problems: Problems,
) -> NDArray[np.bool_]:
    """
    Find the bodies that get no transform although their parent is the root.

    :param problems: takes warnings of patterns that no top-level model matches.
    :return: for each element whether it is such a body; for the root, whether the link "world" of
        a URDF gets none.
    """
    is_detached = np.zeros(len(scene.names), np.bool_)
    if anchors is AnchorModels.AUTO:
        anchors = AnchorModels.ALL if 0 in scene.world_names else AnchorModels.STATIC
    if anchors is AnchorModels.ALL:
        return is_detached
    if not isinstance(anchors, AnchorPatterns):
        anchors = AnchorPatterns((), anchors is AnchorModels.STATIC)
    anchored = _matching_models(scene, anchors.patterns, problems)
    # Children of the link "world" of a URDF keep their parent.
    keeps_static = anchors.has_static or scene.urdf_root == WORLD_FRAME
    is_detached[:1] = True  # a file may have no elements
    is_body = np.isin(scene.kinds, (Kind.LINK, Kind.MODEL))
    for body in np.flatnonzero(is_body & (scene.parents < 0)[tf_parents.parents]).tolist():
        model = scene.top_level_element(body)
        is_static = body in tf_parents.joints or model in scene.static_models
        is_detached[body] = not (model in anchored or (is_static and keeps_static))
    return is_detached


def _matching_models(scene: Scene, patterns: tuple[str, ...], problems: Problems) -> set[int]:
    """Return the top-level models whose names match a pattern."""
    models: list[int] = np.flatnonzero(
        (scene.kinds == Kind.MODEL) & (scene.parents == scene.roots)).tolist()
    matching: set[int] = set()
    for pattern in patterns:
        found = [model for model in models if fnmatchcase(scene.own_name(model), pattern)]
        matching.update(found)
        if not found:
            words = [each.value for each in AnchorModels]
            hint = hint_from_names(pattern, [*words, *map(scene.own_name, models)])
            msg = f'anchor_models: no top-level model has a name like "{pattern}"{hint}'
            problems.warning(msg, scene.place(0))
    return matching
