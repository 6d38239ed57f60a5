# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Markers of visuals: which there are, in which frame, and what they look like."""

import re

import pytest
from sdf_texts import link_with, model_file, world_file
from tf_checks import model

from sdf_pose_bridge import load_text
from sdf_pose_bridge.export import visual_markers
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.export.visual_markers import (
    markers_from_text,
    MOST_PROBLEMS,
    visual_markers_from_scene,
)
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.limits import MissingInclude
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

BOX = '<box><size>1 2 3</size></box>'
CAPSULE = '<capsule><radius>1</radius><length>4</length></capsule>'
LYING = '<pose degrees="true">0 0 2 0 90 0</pose>'
MESH = '<mesh><uri>{}</uri>{}</mesh>'


def visual(geometry, extra='', name='v'):
    return f'<visual name="{name}"><geometry>{geometry}</geometry>{extra}</visual>'


def material(*rgba):
    return f'<material><diffuse>{" ".join(map(str, rgba))}</diffuse></material>'


def markers_and_warnings(text, *, file='m.sdf', **options):
    scene = load_text(text, str(file), shapes=True)
    tree = tf_tree_from_scene(scene, TfOptions(**options))
    return visual_markers_from_scene(
        scene, tree, options.get('model', ''), resource_finder((), {}))


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
    models = [
        model(name, f'<link name="l">{visual("<sphere><radius>0</radius></sphere>")}</link>')
        for name in ('a', 'b', 'c', '\nd')]
    _, (warning, _) = markers_and_warnings(world_file(''.join(models)))
    assert warning.message.startswith(
        'the visual "a::l::v" is not shown, like 2 more: its sizes are not positive')


@pytest.mark.parametrize(('uri', 'count', 'lines'), [
    ('model://none/{}.stl', 12, 1), ('none/{}.stl', 3 * MOST_PROBLEMS, 2),
    ('https://none.org/me/models/{}/files/a.stl', 3, 3),
    ('https://none.org/me/models/a/files/{}.stl', 3, 1)])
def test_meshes_that_are_missing_for_one_reason_have_one_warning(uri, count, lines):
    content = ''.join(visual(MESH.format(uri.format(number), ''), name=f'v{number}')
                      for number in range(count))
    _, warnings = markers_and_warnings(link_with(content))
    assert len(warnings) == lines
    others = re.findall(r'is not shown, like (\d+) more: the mesh ', ' '.join(map(str, warnings)))
    assert lines + sum(map(int, others)) == count


def test_visual_whose_link_has_no_frame_has_a_warning():
    content = visual(BOX) + visual(MESH.format('none.stl', ''), name='w')
    markers, warnings = markers_and_warnings(
        link_with(content), kinds=frozenset({Kind.MODEL}), anchor_models=AnchorModels.NONE)
    assert markers == []
    for warning, reason in zip(warnings, (
            'neither its link nor a frame above that in TF is published',
            'the mesh "none.stl" is not found'), strict=True):
        assert reason in str(warning)


@pytest.mark.parametrize(('limit', 'most', 'geometry'), [
    ('MOST_MARKERS', 2, BOX), ('MOST_POINTS', 12, '<plane/>')])
def test_number_of_markers_is_limited(monkeypatch, limit, most, geometry):
    monkeypatch.setattr(visual_markers, limit, most)
    content = ''.join(visual(geometry, name=name) for name in 'abcd')
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


@pytest.mark.parametrize('is_relative', [False, True])
def test_mesh_beside_the_file_is_named_by_its_path(tmp_path, monkeypatch, is_relative):
    folder = tmp_path / 'my robot #1'
    folder.mkdir()
    (folder / 'a.stl').touch()
    monkeypatch.chdir(folder)
    marker = only_marker(
        visual(MESH.format('a.stl', '<scale>1 2 -3</scale>')),
        file='m.sdf' if is_relative else folder / 'm.sdf')
    assert (marker.type, marker.scale) == ('MESH_RESOURCE', (1, 2, -3))
    assert marker.mesh_resource == (folder / 'a.stl').as_uri()


def test_part_of_a_mesh_is_shown_whole_with_a_warning():
    submesh = '<submesh><name>lid</name></submesh>'
    (marker,), (warning,) = markers_and_warnings(
        link_with(visual(MESH.format('package://a/a.dae', submesh))))
    assert (marker.type, marker.mesh_resource) == ('MESH_RESOURCE', 'package://a/a.dae')
    assert 'instead of its part "lid"' in str(warning)


TRANSPARENT = '<transparency>{}</transparency>'


@pytest.mark.parametrize(('geometry', 'extra', 'rgba'), [
    (BOX, '', (0.7, 0.7, 0.7, 1.0)), (MESH.format('package://a/a.dae', ''), '', None),
    (MESH.format('package://a/a.STL', ''), '', (0.7, 0.7, 0.7, 1.0)),
    (BOX, TRANSPARENT.format(0.75), (0.7, 0.7, 0.7, 0.25)),
    (MESH.format('package://a/a.dae', ''), TRANSPARENT.format(0.75), (0.7, 0.7, 0.7, 0.25))])
def test_what_has_no_material_is_gray_unless_its_mesh_can_have_some(geometry, extra, rgba):
    assert only_marker(visual(geometry, extra)).rgba == rgba


@pytest.mark.parametrize('content', [
    '<visual name="v"/>', f'<collision name="c"><geometry>{BOX}</geometry></collision>',
    visual(BOX, TRANSPARENT.format(1)), visual(BOX, TRANSPARENT.format(1) + material(1, 0, 0))])
def test_what_has_no_marker(content):
    assert markers_of(link_with(content)) == []


def test_marker_is_in_the_frame_of_its_link():
    text = world_file(
        '<model name="a"><pose>1 0 0 0 0 0</pose><model name="b"><link name="l">'
        f'<pose>0 5 0 0 0 0</pose>{visual(CAPSULE, LYING)}</link></model></model>')
    markers = markers_of(text, frame_prefix='p/')
    assert [marker.pose[:3] for marker in markers] == [
        pytest.approx(place) for place in ((0, 0, 2), (-2, 0, 2), (2, 0, 2))]
    assert {(marker.namespace, marker.frame_id) for marker in markers} == {('a::b', 'p/a/b/l')}


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


WITH_SHAPE = link_with(visual(MESH.format('model://arm/a.stl', '')))


@pytest.fixture(name='reread')
def make_reread(tmp_path):
    """Loads a file, changes what it includes and makes markers; ``reread(text)``."""
    models = tmp_path / 'models'
    models.mkdir()
    (models / 'arm').mkdir()
    (models / 'arm/a.stl').touch()
    included = models / 'included.sdf'
    included.write_text(WITH_SHAPE, encoding='utf-8')
    path = tmp_path / 'cell.sdf'
    path.write_text(model_file(''.join(
        f'<include><uri>{uri}</uri><name>{name}</name></include>'
        for uri, name in (('included.sdf', 'm'), ('included.sdf', 'n'), ('none.sdf', 'o')))),
        encoding='utf-8')
    loaded = loaded_scene_from_request(LoadRequest(
        str(path), '', (models,), MissingInclude.SKIP,
        TfOptions(model='r::m', frame_prefix='p/', frame_names=FrameNames.SCOPED),
        model_name='r'))
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
    assert marker.mesh_resource.endswith('/models/arm/a.stl')
    assert (marker.type, marker.frame_id, warnings) == ('MESH_RESOURCE', 'p/r/m/l', ())
