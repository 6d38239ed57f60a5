# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Place a camera so that it shows robots and frames."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sdf_pose_bridge.geometry.rotations import Floats, matrix_from_quaternion

FIELD_OF_VIEW_RAD = 0.8
"""The vertical field of view of the camera."""

DIRECTIONS: Mapping[str, tuple[float, ...]] = {
    # Not exactly along z, because "up" in the picture would be undefined.
    'top': (-1e-3, 0.0, 1.0), 'front': (1.0, 0.0, 0.0), 'side': (0.0, -1.0, 0.0)}
"""Direction from the middle of the picture to the camera for each view; +x is the front."""

_HOME_DIRECTIONS = [(x, y, 0.45) for x in (0.75, -0.75) for y in (-0.5, 0.5)]
_MARGIN = 1.1
_MOST_COMPARED = 300
_OUTLIERS, _FAR = 0.1, 0.5
"""The part of the frames, in each direction, that the first view may leave out; it leaves out
those that are further from the others than this part of the extent of these."""


class View(NamedTuple):
    """The position of a camera, and the point in the middle of its picture."""

    position: Floats
    look_at: Floats


def bounds_of_points(*points: Floats) -> Floats:
    """Return the lowest and the highest corner of points (..., 3), as an array (2, 3)."""
    every = np.concatenate([each.reshape(-1, 3) for each in points])
    return np.array([every.min(axis=0), every.max(axis=0)])


def bounds_of_interest(
    origins: Floats, boxes: Floats, is_part: NDArray[np.bool_], robot: Floats,
) -> Floats:
    """
    Find the bounds of the first view: robots, most other frames, and the bodies at them.

    Bodies that are far from these do not count, nor do those that are larger than all of them
    together and the only link of their model, such as a floor.

    :param origins: shape (n, 3), the origins of frames.
    :param boxes: shape (m, 2, 3), the lowest and the highest corners of bodies.
    :param is_part: shape (m,), whether the model of each body has other links.
    :param robot: shape (k, 3), the origins and the middles of bodies of models that move.
    :return: shape (2, 3): the lowest and the highest corner.
    """
    if not len(origins):
        origins = np.zeros((1, 3))
    left_out = int(_OUTLIERS * (len(origins) - 1))
    inner = np.sort(origins, axis=0)[[left_out, -1 - left_out]]
    distances_m = np.linalg.norm(origins - origins.clip(*inner), axis=1)
    bounds = bounds_of_points(inner, origins[distances_m <= _FAR * math.dist(*inner)], robot)
    extent_m = math.dist(*bounds)
    sizes_m, middles = np.linalg.norm(boxes[:, 1] - boxes[:, 0], axis=1), boxes.mean(axis=1)
    is_near = (np.abs(middles - bounds.mean(axis=0)) <= 0.6 * np.ptp(bounds, axis=0) + 1e-6
               + 0.1 * extent_m).all(axis=1)
    chosen = boxes[is_near & (is_part | (sizes_m <= extent_m))]
    if not len(chosen) and extent_m < 0.3 * sizes_m.max(initial=0.0):
        chosen = boxes
    return bounds_of_points(bounds, chosen)


def bounds_with_axes(bounds: Floats, poses: Floats, length_m: float) -> Floats:
    """
    Return bounds that contain the axes of the frames in given bounds.

    :param bounds: shape (2, 3): the lowest and the highest corner.
    :param poses: shape (n, 7), the poses of frames.
    """
    poses = poses[_are_inside(bounds, poses[:, :3])]
    axes = length_m * matrix_from_quaternion(poses[:, 3:])
    return bounds_of_points(bounds, poses[:, np.newaxis, :3] + axes.transpose(0, 2, 1))


def view_of_bounds(bounds: Floats, direction: ArrayLike) -> View:
    """
    Place a camera so that a box fills its picture.

    :param bounds: shape (2, 3): the lowest and the highest corner of the box.
    :param direction: from the middle of the box to the camera.
    """
    middle = bounds.mean(axis=0)
    backward = np.asarray(direction) / np.linalg.norm(direction)
    right = np.cross((0.0, 0.0, 1.0), backward)
    right /= np.linalg.norm(right)
    corners = np.array([*product(*(bounds - middle).T)])
    across = np.abs(corners @ np.array([right, np.cross(backward, right)]).T).max(axis=1)
    distance_m = float((_MARGIN * across / math.tan(0.5 * FIELD_OF_VIEW_RAD)
                        + corners @ backward).max())
    return View(middle + (distance_m or 1.0) * backward, middle)


def view_in_window(view: View, aspect: float) -> View:
    """Move a camera back if a window is narrow, so that it shows as much from left to right."""
    return View(view.look_at + (view.position - view.look_at) / min(aspect, 1.0), view.look_at)


def home_view(bounds: Floats, origins: Floats, boxes: Floats) -> View:
    """
    Choose the first view: the side from which bodies hide the fewest frames.

    :param bounds: the bounds of the view, shape (2, 3).
    :param origins: shape (n, 3), the origins of frames.
    :param boxes: shape (m, 2, 3), the lowest and the highest corners of bodies.
    """
    sizes_m = np.linalg.norm(boxes[:, 1] - boxes[:, 0], axis=1)
    large = boxes[sizes_m >= 0.5 * math.dist(*bounds)]
    seen = origins[_are_inside(bounds, origins)]
    views = [view_of_bounds(bounds, direction) for direction in _HOME_DIRECTIONS]
    return min(views, key=lambda view: int(_are_hidden(
        view.position, seen[:_MOST_COMPARED], large[:_MOST_COMPARED]).sum()))


def grid_spacing_m(size_m: float) -> float:
    """Return the distance of lines on the ground, 1, 2 or 5 times a power of ten, in metres."""
    power = 10.0 ** math.floor(math.log10(size_m / 10.0))
    return power * max(factor for factor in (1.0, 2.0, 5.0) if factor * power <= size_m / 10.0)


def _are_inside(bounds: Floats, points: Floats) -> NDArray[np.bool_]:
    return np.asarray(((bounds[0] <= points) & (points <= bounds[1])).all(axis=1))


def _are_hidden(eye: Floats, points: Floats, boxes: Floats) -> NDArray[np.bool_]:
    """Return for each point (n, 3) whether a box (m, 2, 3) is between the eye and it."""
    ways = points - eye
    # A line along an axis never leaves the slab of a box, or never enters it.
    ways = np.where(np.abs(ways) < 1e-9, 1e-9, ways)[:, np.newaxis]
    near, far = np.sort((boxes.swapaxes(0, 1)[:, np.newaxis] - eye) / ways, axis=0)
    enters, leaves = near.max(axis=2), far.min(axis=2)
    return np.asarray(((enters < leaves) & (leaves > 0.0) & (enters < 0.99)).any(axis=1))
