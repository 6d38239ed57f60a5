# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Every type of shape, and that all who use one mean the same body."""

from matrices import assert_close
import numpy as np
import pytest
from sdf_texts import link_with

from sdf_pose_bridge import load_text
from sdf_pose_bridge.export.visual_markers import visual_markers_from_scene
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.shape_types import SHAPE_TYPES
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

SIZES_M = (0.7, 1.1, 1.3)
WITH_SURFACE = [name for name, each in SHAPE_TYPES.items() if each.surface is not None]
WITH_SOLID = [name for name, each in SHAPE_TYPES.items() if each.solid is not None]


def sizes_of(name):
    return SIZES_M[:sum(map(len, SHAPE_TYPES[name].sizes_m.values()))]


def surface_of(name, *sizes_m):
    return SHAPE_TYPES[name].surface(*sizes_m or sizes_of(name))


def solid_of(name, *sizes_m):
    return SHAPE_TYPES[name].solid(*sizes_m or sizes_of(name))


def parts_of(name, *sizes_m):
    return SHAPE_TYPES[name].parts(*sizes_m or sizes_of(name))


def scene_with(tag, name):
    sizes = iter(sizes_of(name))
    content = ''.join(
        f'<{size}>{" ".join(str(next(sizes)) for _ in default)}</{size}>'
        for size, default in SHAPE_TYPES[name].sizes_m.items())
    geometry = f'<geometry><{name}>{content}</{name}></geometry>'
    return load_text(link_with(f'<{tag} name="v">{geometry}</{tag}>'), shapes=True)


def tetrahedra_of(points, faces):
    """Return the corners of tetrahedra with the origin, and their volumes, which are signed."""
    corners = points[faces]
    first, second, third = np.moveaxis(corners, 1, 0)
    return corners, np.einsum('ij,ij->i', first, np.cross(second, third)) / 6.0


def extent_of(points):
    return np.array([points.min(axis=0), points.max(axis=0)])


def ends_of(extent_m, z_m):
    return np.outer((-0.5, 0.5), extent_m) + np.array((0.0, 0.0, z_m))


# Types that have nothing

@pytest.mark.parametrize('name', sorted(SHAPE_TYPES.keys() - set(WITH_SURFACE)))
def test_type_without_a_surface_is_supported_by_nobody(name):
    assert SHAPE_TYPES[name] == type(SHAPE_TYPES[name])()


@pytest.mark.parametrize('name', sorted(SHAPE_TYPES.keys() - set(WITH_SURFACE) - {'mesh'}))
def test_marker_is_refused_where_there_is_no_surface(name):
    scene = scene_with('visual', name)
    markers, (warning,) = visual_markers_from_scene(
        scene, tf_tree_from_scene(scene), '', resource_finder((), {}))
    assert markers == []
    assert f'a {name} is not supported' in warning.message


# Surfaces, parts, solids and markers of one type are about the same body

@pytest.mark.parametrize('name', WITH_SOLID)
def test_surface_encloses_the_volume_of_the_solid(name):
    _, volumes = tetrahedra_of(*surface_of(name))
    assert volumes.sum() == pytest.approx(solid_of(name).volume_m3, rel=0.04)
    assert volumes.sum() <= solid_of(name).volume_m3 * (1.0 + 1e-12)


@pytest.mark.parametrize('name', WITH_SOLID)
def test_solid_has_the_center_of_the_surface(name):
    corners, volumes = tetrahedra_of(*surface_of(name))
    center = np.average(corners.sum(axis=1) / 4.0, axis=0, weights=volumes)
    assert center == pytest.approx((0.0, 0.0, solid_of(name).center_z_m), abs=1e-9)


@pytest.mark.parametrize('name', WITH_SOLID)
def test_solid_has_the_moments_of_the_surface(name):
    corners, volumes = tetrahedra_of(*surface_of(name))
    corners = np.append(corners, np.zeros((len(corners), 1, 3)), axis=1)
    corners[..., 2] -= solid_of(name).center_z_m
    # The mean of x squared in a tetrahedron.
    squares = ((corners ** 2).sum(axis=1) + corners.sum(axis=1) ** 2) / 20.0
    x, y, z = np.average(squares, axis=0, weights=volumes)
    assert (y + z, x + z, x + y) == pytest.approx(solid_of(name).moments_m2, rel=0.04)


@pytest.mark.parametrize('name', WITH_SURFACE)
def test_faces_have_an_area_and_use_all_points_within_the_sizes(name):
    points, faces = surface_of(name)
    first, second, third = np.moveaxis(points[faces], 1, 0)
    assert (np.linalg.norm(np.cross(second - first, third - first), axis=1) > 0.0).all()
    assert faces.min() >= 0
    assert faces.max() < len(points)


@pytest.mark.parametrize('name', WITH_SURFACE)
def test_surface_is_centered(name):
    lowest, highest = extent_of(surface_of(name)[0])
    assert lowest == pytest.approx(-highest)


@pytest.mark.parametrize('name', WITH_SURFACE)
def test_marker_extends_as_far_as_the_surface(name):
    scene = scene_with('visual', name)
    markers, warnings = visual_markers_from_scene(
        scene, tf_tree_from_scene(scene), '', resource_finder((), {}))
    assert warnings == ()
    ends = [
        marker.points if len(marker.points) else ends_of(marker.scale, marker.pose.z)
        for marker in markers]
    assert_close(extent_of(np.concatenate(ends)), extent_of(surface_of(name)[0]), 1e-12)


# What is special about one type

def test_cone_ends_above():
    points, _ = surface_of('cone', 1.0, 4.0)
    assert points[points[:, 2] > 1.0, :2] == pytest.approx(0.0)


@pytest.mark.parametrize('length_m', [0.0, -1.0])
def test_capsule_without_a_length_is_a_sphere(length_m):
    assert parts_of('capsule', 2.0, length_m) == parts_of('sphere', 2.0)
    for of in (solid_of, surface_of):
        for ours, others in zip(of('capsule', 2.0, length_m), of('sphere', 2.0), strict=True):
            assert_close(ours, others)
