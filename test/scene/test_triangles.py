# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces of shapes: closed, outwards, and as large as the shape."""

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


@pytest.mark.parametrize('shape', [
    ('mesh',), ('heightmap',), ('sphere', 0.0), ('sphere', math.nan), ('box', 1.0, -1.0, 1.0)])
def test_shape_without_a_surface(shape):
    assert surface(*shape) is None


@pytest.mark.parametrize(('shape', 'lowest', 'highest', 'volume'), [
    (('box', 1.0, 2.0, 3.0), (-0.5, -1.0, -1.5), (0.5, 1.0, 1.5), 6.0),
    (('sphere', 2.0), (-2, -2, -2), (2, 2, 2), 32 / 3 * math.pi),
    (('ellipsoid', 1.0, 2.0, 3.0), (-1, -2, -3), (1, 2, 3), 8 * math.pi),
    (('cylinder', 1.0, 4.0), (-1, -1, -2), (1, 1, 2), 4 * math.pi),
    (('cone', 1.0, 4.0), (-1, -1, -2), (1, 1, 2), 4 / 3 * math.pi),
    (('capsule', 1.0, 4.0), (-1, -1, -3), (1, 1, 3), (4 + 4 / 3) * math.pi),
    (('capsule', 1.0, -4.0), (-1, -1, -1), (1, 1, 1), 4 / 3 * math.pi),
])
def test_surface_encloses_the_shape(shape, lowest, highest, volume):
    triangles = surface(*shape)
    assert triangles.points.min(axis=0) == pytest.approx(lowest)
    assert triangles.points.max(axis=0) == pytest.approx(highest)
    assert volume_of(triangles) == pytest.approx(volume, rel=0.04)


def test_cone_ends_above():
    points = surface('cone', 1.0, 4.0).points
    assert points[points[:, 2] > 1.0, :2] == pytest.approx(0.0)


@pytest.mark.parametrize('normal', [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, -2, 3)])
def test_plane_has_its_normal(normal):
    triangles = surface('plane', 2.0, 4.0, normal=normal)
    first, second, third = np.moveaxis(triangles.points[triangles.faces], 1, 0)
    areas = 0.5 * np.cross(second - first, third - first)
    assert areas.sum(axis=0) == pytest.approx(8.0 * np.array(normal) / np.linalg.norm(normal))

