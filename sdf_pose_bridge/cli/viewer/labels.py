# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts in the scene: the names of frames, placed without overlaps in the picture."""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np
import viser

from sdf_pose_bridge.cli.viewer.view_point import FIELD_OF_VIEW_RAD
from sdf_pose_bridge.geometry.rotations import Floats

_LINE_HEIGHT, _CHARACTER_WIDTH = 0.018, 0.008
"""Size of a name, as a part of the height of a window of 720 pixels."""
_MOST_IN_A_LABEL = 4


class _Label(NamedTuple):
    """Names in a rectangle of the picture, in parts of its height."""

    top: float
    left: float
    point: Floats
    names: list[str]

    @property
    def lines(self) -> list[str]:
        """Return the lines of the text."""
        more = len(self.names) - _MOST_IN_A_LABEL
        names = self.names[:_MOST_IN_A_LABEL] + ([f'and {more} more'] if more > 0 else [])
        return '\n'.join(names).split('\n')

    def is_at(self, other: _Label) -> bool:
        """Return whether the points of both are at one place."""
        return math.hypot(self.top - other.top, self.left - other.left) < _LINE_HEIGHT

    def is_on(self, other: _Label) -> bool:
        """Return whether both would overlap."""
        higher, lower = sorted((self, other), key=lambda each: each.top)
        first, second = sorted((self, other), key=lambda each: each.left)
        return (lower.top < higher.top + _LINE_HEIGHT * len(higher.lines)
                and second.left < first.left + _CHARACTER_WIDTH * max(map(len, first.lines)))


def labels_from_names(
    names: Sequence[str], points: Floats, eye: Floats, look_at: Floats, first: int = 0,
) -> list[tuple[str, Floats]]:
    """
    Place the names of frames without overlaps.

    Names of frames at one place are lines of one text. Of other names that would overlap, only the
    one nearest to the camera is shown.

    :param names: the names of frames, or other texts, which may have several lines.
    :param first: the number of texts at the beginning that names nearer to the camera do not hide.
    :param points: shape (n, 3), their origins.
    :param eye: shape (3,), the position of the camera.
    :param look_at: shape (3,), the point in the middle of the picture, not above or below the eye.
    :return: the texts, and their points: each text is right of its point and below it.
    """
    forward = np.asarray(look_at) - eye
    right = np.cross(forward, (0.0, 0.0, 1.0))
    axes = np.array([
        axis / np.linalg.norm(axis) for axis in (right, np.cross(forward, right), forward)])
    x, y, depth = ((points - eye) @ axes.T).T
    seen = np.flatnonzero(depth > 0.0)
    scale = 0.5 / (math.tan(0.5 * FIELD_OF_VIEW_RAD) * depth[seen])
    labels: list[_Label] = []
    for index, place in sorted(
            enumerate(seen.tolist()), key=lambda each: (each[1] >= first, depth[each[1]])):
        top, left = (scale[index] * np.array([y[place], x[place]])).tolist()
        label = _Label(top, left, points[place], [names[place]])
        covered = [other for other in labels if label.is_on(other)]
        if not covered:
            labels.append(label)
        elif label.is_at(covered[0]):
            grown = covered[0]._replace(names=covered[0].names + label.names)
            others = [other for other in labels if other is not covered[0]]
            if not any(map(grown.is_on, others)):
                labels = [*others, grown]
    return [('\n'.join(label.lines), label.point) for label in labels]


class Labels:
    """
    Texts in the scene.

    :param nodes: the nodes of the page.
    """

    def __init__(self, nodes: viser.SceneApi) -> None:
        self._nodes = nodes
        self._labels: list[viser.LabelHandle] = []

    def show(self, texts: Sequence[tuple[str, Floats]]) -> None:
        """Show texts at points instead of those before."""
        # A browser does not move a label that is removed and added again at once.
        while len(self._labels) < len(texts):
            self._labels.append(self._nodes.add_label(f'/names/{len(self._labels)}', ''))
        for number, label in enumerate(self._labels):
            label.visible = number < len(texts)
            if label.visible:
                label.text, label.position = texts[number]
