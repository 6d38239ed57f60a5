# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Markers of visuals: which there are, in which frame, and what they look like."""

from pathlib import Path

import pytest
from sdf_texts import link_with, model_file, world_file
from tf_checks import model

from sdf_pose_bridge import load_text
from sdf_pose_bridge.errors import UnknownFrameError
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.tf import visual_markers
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.loaded_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.tf.loading import loaded_scene_from_request
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions
from sdf_pose_bridge.tf.visual_markers import markers_from_text, visual_markers_from_scene

BOX = '<box><size>1 2 3</size></box>'
MESH = '<mesh><uri>{}</uri>{}</mesh>'


def visual(geometry, extra='', name='v'):
    return f'<visual name="{name}"><geometry>{geometry}</geometry>{extra}</visual>'


def material(*rgba):
    return f'<material><diffuse>{" ".join(map(str, rgba))}</diffuse></material>'


def markers_and_warnings(text, *, file='m.sdf', resource_paths=(), **options):
    scene = load_text(text, str(file), shapes=True)
    tree = tf_tree_from_scene(scene, TfOptions(**options))
    return visual_markers_from_scene(
        scene, tree, options.get('model', ''), resource_finder(resource_paths, {}))


def markers_of(text, **options):
    markers, warnings = markers_and_warnings(text, **options)
    assert warnings == ()
    return markers


def only_marker(content, **options):
    (marker,) = markers_of(link_with(content), **options)
    return marker


@pytest.mark.parametrize(('geometry', 'reason'), [
    (MESH.format('none.stl', ''), 'the mesh "none.stl" is not found: it is not in "."; '),
    (MESH.format('model://none/a.stl', ''), 'the mesh "model://none/a.stl" is not found: '),
    (MESH.format('https://none.org/a.stl', ''), 'the mesh "https://none.org/a.stl" is not found'),
    (MESH.format('/dev', ''), 'the mesh "/dev" is not found'),
    ('<sphere><radius>0</radius></sphere>', 'its sizes are not positive'),
    ('<capsule><radius>-1</radius><length>1</length></capsule>', 'its sizes are not positive'),
    ('<heightmap><uri>h.png</uri></heightmap>', 'a heightmap is not supported'),
])
def test_visual_that_cannot_be_shown_has_a_warning(geometry, reason):
    markers, (warning,) = markers_and_warnings(link_with(visual(geometry)))
    assert markers == []
    assert str(warning).startswith(
        f'm.sdf:1: WARNING: the visual "m::l::v" is not shown: {reason}')


def test_visual_of_many_instances_has_one_warning():
    models = ''.join(
        model(name, f'<link name="l">{visual(MESH.format("none.stl", ""))}</link>')
        for name in 'abc')
    _, (warning,) = markers_and_warnings(world_file(models))
    assert warning.message.startswith(
        'the visual "a::l::v" is not shown, like 2 more: the mesh "none.stl" is not found: ')


def test_visual_without_a_geometry_has_no_marker():
    assert markers_of(link_with('<visual name="v"/>')) == []


def test_unknown_model_is_an_error():
    scene = load_text(link_with(''), shapes=True)
    with pytest.raises(UnknownFrameError):
        visual_markers_from_scene(scene, tf_tree_from_scene(scene), 'n', resource_finder((), {}))


def test_visual_whose_link_has_no_frame_has_a_warning():
    markers, (warning,) = markers_and_warnings(
        link_with(visual(BOX)), kinds=frozenset({Kind.MODEL}), anchor_models=AnchorModels.NONE)
    assert markers == []
    assert 'neither its link nor a frame above that in TF is published' in str(warning)


def test_number_of_markers_is_limited(monkeypatch):
    monkeypatch.setattr(visual_markers, 'MOST_MARKERS', 2)
    content = ''.join(visual(BOX, name=name) for name in 'abcd')
    markers, (warning,) = markers_and_warnings(link_with(content))
    assert len(markers) == 2
    assert 'the visual "m::l::c" and all that follow are not shown' in str(warning)


def test_number_of_points_is_limited(monkeypatch):
    monkeypatch.setattr(visual_markers, 'MOST_POINTS', 17)
    content = ''.join(visual('<plane/>', name=name) for name in 'abcd')
    markers, (warning,) = markers_and_warnings(link_with(content))
    assert len(markers) == 2
    assert 'the visual "m::l::c" and all that follow are not shown' in str(warning)


@pytest.mark.parametrize(('geometry', 'kind', 'scale'), [
    (BOX, 'CUBE', (1, 2, 3)),
    ('<sphere><radius>2</radius></sphere>', 'SPHERE', (4, 4, 4)),
    ('<ellipsoid><radii>1 2 3</radii></ellipsoid>', 'SPHERE', (2, 4, 6)),
    ('<cylinder><radius>1</radius><length>5</length></cylinder>', 'CYLINDER', (2, 2, 5)),
    ('<capsule><radius>2</radius><length>0</length></capsule>', 'SPHERE', (4, 4, 4)),
    ('<capsule><radius>2</radius><length>-1</length></capsule>', 'SPHERE', (4, 4, 4)),
])
def test_shape_that_rviz_has(geometry, kind, scale):
    marker = only_marker(visual(geometry))
    assert (marker.type, marker.scale, marker.mesh_resource) == (kind, scale, '')
    assert len(marker.points) == 0


def test_mesh_beside_the_file_is_named_by_its_path(tmp_path):
    folder = tmp_path / 'my robot #1'
    folder.mkdir()
    (folder / 'a.stl').touch()
    marker = only_marker(
        visual(MESH.format('a.stl', '<scale>1 2 -3</scale>')), file=folder / 'm.sdf')
    assert (marker.type, marker.scale) == ('MESH_RESOURCE', (1, 2, -3))
    assert marker.mesh_resource == f'file://{tmp_path}/my%20robot%20%231/a.stl'


def test_mesh_beside_a_file_with_a_relative_path_is_named_by_its_absolute_path(
        tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path('a.stl').touch()
    marker = only_marker(visual(MESH.format('a.stl', '')), file='m.sdf')
    assert marker.mesh_resource == (tmp_path / 'a.stl').as_uri()


@pytest.mark.parametrize('uri', ['model://arm/meshes/a.dae', 'package:///arm/meshes/a.dae'])
def test_mesh_of_a_model_is_found_in_the_resource_paths(uri, tmp_path):
    mesh = tmp_path / 'arm/meshes/a.dae'
    mesh.parent.mkdir(parents=True)
    mesh.touch()
    marker = only_marker(
        visual(MESH.format(uri, '')), resource_paths=[tmp_path])
    assert marker.mesh_resource == mesh.as_uri()


def test_mesh_of_a_package_keeps_its_uri():
    marker = only_marker(visual(MESH.format('package://none/a.stl', '')))
    assert marker.mesh_resource == 'package://none/a.stl'


def test_part_of_a_mesh_is_shown_whole_with_a_warning():
    submesh = '<submesh><name>lid</name></submesh>'
    (marker,), (warning,) = markers_and_warnings(
        link_with(visual(MESH.format('package://a/a.dae', submesh))))
    assert marker.type == 'MESH_RESOURCE'
    assert 'instead of its part "lid"' in str(warning)


@pytest.mark.parametrize('geometry', [
    BOX, MESH.format('package://a/a.stl', ''), MESH.format('package://a/a.STL', '')])
def test_what_has_no_material_is_gray(geometry):
    red, green, blue, alpha = only_marker(visual(geometry)).rgba
    assert 0 < red == green == blue < 1
    assert alpha == 1


def test_mesh_keeps_its_own_materials():
    assert only_marker(visual(MESH.format('package://a/a.dae', ''))).rgba is None


@pytest.mark.parametrize('geometry', [BOX, MESH.format('package://a/a.dae', '')])
def test_transparency_without_a_material_is_that_of_a_gray(geometry):
    rgba = only_marker(visual(geometry, '<transparency>.75</transparency>')).rgba
    assert rgba[3] == 0.25


@pytest.mark.parametrize('extra', ['', material(1, 0, 0)])
def test_transparent_visual_has_no_marker(extra):
    content = visual(BOX, f'<transparency>1</transparency>{extra}')
    assert markers_of(link_with(content)) == []


def test_collision_has_no_marker():
    content = f'<collision name="c"><geometry>{BOX}</geometry></collision>'
    assert markers_of(link_with(content)) == []


def test_marker_is_in_the_frame_of_its_link():
    text = world_file(
        '<model name="a"><pose>1 0 0 0 0 0</pose><model name="b"><link name="l">'
        f'<pose>0 5 0 0 0 0</pose>{visual(BOX, "<pose>0 0 2 0 0 0</pose>")}'
        '</link></model></model>')
    (marker,) = markers_of(text, frame_prefix='p/')
    assert (marker.namespace, marker.frame_id) == ('a::b', 'p/a/b/l')
    assert marker.pose == pytest.approx((0, 0, 2, 0, 0, 0, 1))


def test_marker_is_in_the_root_frame_if_links_have_none():
    text = model_file(
        f'<link name="a"/><link name="b"><pose>0 0 2 0 0 0</pose>{visual(BOX)}</link>'
        '<joint name="j" type="revolute"><parent>a</parent><child>b</child>'
        '<axis><xyz>0 0 1</xyz></axis></joint>'
        '<frame name="f"/>')
    (marker,) = markers_of(
        text, kinds=frozenset({Kind.FRAME}), root_frame='map', anchor_models=AnchorModels.ALL)
    assert (marker.frame_id, marker.pose[:3]) == ('map', pytest.approx((0, 0, 2)))


def test_only_the_chosen_model_of_the_first_world_is_shown():
    model = '<model name="{}"><link name="l">' + visual(BOX) + '</link></model>'
    text = (
        f'<sdf version="1.10"><world name="w">{model.format("a")}{model.format("b")}</world>'
        f'<world name="x">{model.format("c")}</world></sdf>')
    assert [each.namespace for each in markers_of(text)] == ['a', 'b']
    assert [each.namespace for each in markers_of(text, model='b')] == ['b']


# From the text of a loaded scene


WITH_SHAPE = model_file(f'<link name="l">{visual(BOX)}</link>')


@pytest.fixture(name='reread')
def make_reread(tmp_path):
    """Loads a file, changes what it includes and makes markers; ``reread(text)``."""
    models = tmp_path / 'models'
    models.mkdir()
    included = models / 'included.sdf'
    included.write_text(WITH_SHAPE, encoding='utf-8')
    path = tmp_path / 'cell.sdf'
    path.write_text(world_file('<include><uri>included.sdf</uri></include>'), encoding='utf-8')
    loaded = loaded_scene_from_request(LoadRequest(str(path), '', (models,)))
    assert not loaded.scene.shapes

    def reread(text):
        path.write_text('something else', encoding='utf-8')
        included.write_text(text, encoding='utf-8')
        return markers_from_text(
            loaded.text, loaded.path, loaded.request, fingerprint_of_scene(loaded.scene))

    return reread


@pytest.mark.parametrize('text', [
    '', model_file('<link name="l"><pose relative_to="x"/></link>'),
    model_file('<link name="k"/>'),
    WITH_SHAPE.replace('"l">', '"l"><pose>1 0 0 0 0 0</pose>'),
    WITH_SHAPE.replace('"v"', '"w"'),
], ids=['empty', 'bad', 'other elements', 'other pose', 'other name'])
def test_shapes_with_an_include_that_has_changed_are_refused(reread, text):
    assert reread(text) is None


def test_shapes_are_those_of_the_text_that_was_read(reread):
    (marker,), warnings = reread(WITH_SHAPE)
    assert (marker.type, marker.frame_id, warnings) == ('CUBE', 'm/l', ())
