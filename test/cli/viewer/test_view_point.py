# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the camera shows, and from where."""

import math

import numpy as np
import pytest

from sdf_pose_bridge.cli.viewer.view_point import (
    bounds_of_interest,
    bounds_with_axes,
    DIRECTIONS,
    FIELD_OF_VIEW_RAD,
    grid_spacing_m,
    home_view,
    View,
    view_in_window,
    view_of_bounds,
)

NO_BOXES = np.zeros((0, 2, 3))
CUBE = np.array([(-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)])


BODY = [(-0.5, -0.5, 0), (0.5, 0.5, 1)]
FLOOR = [(-10, -10, -0.1), (10, 10, 0)]
DISTANT = [(5, 0, 0), (5.5, 0.5, 0.5)]
WHEELS = [[(-0.1, y - 0.5, 0), (0.1, y + 0.5, 1)] for y in (-3, 3)]
ROW = [(x, 0, 0) for x in (*range(20), 100)]


@pytest.mark.parametrize(('origins', 'boxes', 'are_parts', 'robot', 'bounds'), [
    ([], [], False, [], [[0, 0, 0], [0, 0, 0]]),
    ([(0, 0, 0), (1, 2, 3)], [], False, [], [[0, 0, 0], [1, 2, 3]]),
    ([(0, 0, 0)], [CUBE], False, [], CUBE.tolist()),
    (ROW, [], False, [], [[0, 0, 0], [19, 0, 0]]),
    (ROW, [], False, [(100, 0, 0)], [[0, 0, 0], [100, 0, 0]]),
    ([(0, 0, 0), (0.5, 0.5, 2)], [FLOOR, BODY], False, [],
                 [[-0.5, -0.5, 0], [0.5, 0.5, 2]]),
    ([(0, 0, 0), (0.5, 0.5, 2)], [DISTANT, BODY], True, [],
                 [[-0.5, -0.5, 0], [0.5, 0.5, 2]]),
    ([(0, 0, 0)], WHEELS, False, [(0, 0, 0), (0, -3, 0.5), (0, 3, 0.5)],
                 [[-0.1, -3.5, 0], [0.1, 3.5, 1]]),
    ([(0, 0, 0), (0.1, 0, 0)], [BODY], True, [], [[-0.5, -0.5, 0], [0.5, 0.5, 1]]),
], ids=[
    'nothing', 'few frames', 'the body of a single frame', 'a frame far from many',
    'such a frame of a robot', 'a large body', 'a distant body',
    'bodies of a robot with one frame', 'a large part of a model'])
def test_first_view(origins, boxes, are_parts, robot, bounds):
    origins, robot = (np.array(points, float).reshape(-1, 3) for points in (origins, robot))
    assert bounds_of_interest(
        origins, np.array(boxes, float).reshape(-1, 2, 3), np.full(len(boxes), are_parts),
        robot).tolist() == bounds


def test_axes_of_frames_that_are_seen_are_in_the_view():
    turned_about_z = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    poses = np.array([(1, 1, 1, 0, 0, 0, 1), (-1, 0, 0, *turned_about_z), (5, 0, 0, 0, 0, 0, 1)])
    assert bounds_with_axes(CUBE, poses, 0.5) == pytest.approx(
        np.array([(-1.5, -1, -1), (1.5, 1.5, 1.5)]))


@pytest.mark.parametrize('direction', [*DIRECTIONS.values(), (1, 2, -3)])
def test_view_contains_a_box_and_no_more(direction):
    view = view_of_bounds(CUBE + 5.0, direction)
    assert view.look_at.tolist() == [5, 5, 5]
    forward = view.look_at - view.position
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    corners = np.array(np.meshgrid(*(CUBE + 5.0).T)).reshape(3, -1).T - view.position
    ratios = np.abs(corners @ np.array([right, np.cross(right, forward)]).T) / (
        corners @ forward)[:, np.newaxis]
    assert 0.8 < ratios.max() / math.tan(0.5 * FIELD_OF_VIEW_RAD) < 1.0


@pytest.mark.parametrize(('aspect', 'distance'), [(0.5, 8.0), (1.0, 4.0), (1.8, 4.0)])
def test_camera_is_further_away_from_a_narrow_window_only(aspect, distance):
    view = view_in_window(View(np.array((1.0, 6.0, 3.0)), np.array((1.0, 2.0, 3.0))), aspect)
    assert view.position.tolist() == [1.0, 2.0 + distance, 3.0]
    assert view.look_at.tolist() == [1.0, 2.0, 3.0]


def test_camera_does_not_stand_behind_a_wall():
    wall = np.array([[(2.0, -5.0, -5.0), (2.1, 5.0, 5.0)]])
    assert home_view(CUBE, np.zeros((1, 3)), NO_BOXES).position[0] > 2.1
    assert home_view(CUBE, np.zeros((1, 3)), wall).position[0] < 2.0


@pytest.mark.parametrize(('size_m', 'spacing_m'), [
    (0.5, 0.05), (10.0, 1.0), (19.0, 1.0), (20.0, 2.0), (60.0, 5.0)])
def test_grid_spacing(size_m, spacing_m):
    assert grid_spacing_m(size_m) == pytest.approx(spacing_m)
