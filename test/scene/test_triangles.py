# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces of cones and planes: outwards, and as large as the shape."""

import math

import numpy as np
import pytest

from sdf_pose_bridge.scene.triangles import triangles_from_shape
from sdf_pose_bridge.sdformat.shapes import Shape


def surface(kind, *sizes_m, normal=(0.0, 0.0, 1.0)):
    shape = Shape(kind, sizes_m, normal, '', '', (1.0, 1.0, 1.0), None)
    return triangles_from_shape(shape)


def volume_of(triangles):
    """Return the volume inside; it is positive if all triangles look outwards."""
    first, second, third = np.moveaxis(triangles.points[triangles.faces], 1, 0)
    return np.einsum('ij,ij->', first, np.cross(second, third)) / 6.0


def test_surface_encloses_a_cone():
    cone = surface('cone', 1.0, 4.0)
    assert cone.points.min(axis=0) == pytest.approx((-1, -1, -2))
    assert cone.points.max(axis=0) == pytest.approx((1, 1, 2))
    assert volume_of(cone) == pytest.approx(4 / 3 * math.pi, rel=0.04)


def test_cone_ends_above():
    points = surface('cone', 1.0, 4.0).points
    assert points[points[:, 2] > 1.0, :2] == pytest.approx(0.0)


@pytest.mark.parametrize('normal', [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, -2, 3)])
def test_plane_has_its_normal(normal):
    triangles = surface('plane', 2.0, 4.0, normal=normal)
    first, second, third = np.moveaxis(triangles.points[triangles.faces], 1, 0)
    areas = 0.5 * np.cross(second - first, third - first)
    assert areas.sum(axis=0) == pytest.approx(8.0 * np.array(normal) / np.linalg.norm(normal))
