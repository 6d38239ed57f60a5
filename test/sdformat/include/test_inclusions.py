# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Files that include files: what cannot be read, rings, depth, and what is left out."""

import pytest
from sdf_texts import model_file
from sdf_texts import world_file

import sdf_pose_bridge
from sdf_pose_bridge import SdfError


def include(uri, inside=''):
    return f'<include><uri>{uri}</uri>{inside}</include>'


def errors_of(path, **options):
    with pytest.raises(SdfError) as refusal:
        sdf_pose_bridge.load(path, **options)
    return refusal.value.errors


@pytest.fixture(name='world')
def write_world(tmp_path):
    def write(content):
        path = tmp_path / 'world.sdf'
        path.write_text(world_file(content))
        return path
    return write


def test_a_missing_file_is_named_with_its_include(world):
    (error,) = errors_of(world(include('model://nothing')))
    assert (error.code, error.line > 0) == ('URI_LOOKUP', True)
    assert '"model://nothing" cannot be included' in error.message


def test_nothing_follows_from_a_missing_file(world):
    errors = errors_of(world(
        include('model://nothing') + '<frame name="f" attached_to="nothing::l"/>'))
    assert [error.code for error in errors] == ['URI_LOOKUP']


def test_an_error_in_an_included_file_names_that_file(world, tmp_path):
    (tmp_path / 'm.sdf').write_text(model_file('<link name="l"><pose relative_to="x"/></link>'))
    (error,) = errors_of(world(include('m.sdf')))
    assert (error.code, error.file) == ('POSE_RELATIVE_TO_INVALID', str(tmp_path / 'm.sdf'))


def test_an_error_in_a_file_that_is_included_twice_is_told_once(world, tmp_path):
    (tmp_path / 'm.sdf').write_text(model_file('<link name="l"><pose>1 2</pose></link>'))
    (error,) = errors_of(world(''.join(include('m.sdf', f'<name>{name}</name>') for name in 'ab')))
    assert error.element == '/sdf/world[@name="w"]/model[@name="a"]/link[@name="l"]/pose'


def test_two_errors_in_an_included_file_are_told_both(world, tmp_path):
    links = ''.join(f'<link name="{pose}"><pose>{pose}</pose></link>' for pose in ('1 2', '3 4'))
    (tmp_path / 'm.sdf').write_text(model_file(links))
    assert len(errors_of(world(include('m.sdf')))) == 2


def test_the_same_error_twice_in_one_line_is_told_twice(world):
    links = ''.join(f'<link name="{name}"><pose>1 2</pose></link>' for name in 'ab')
    assert len(errors_of(world(f'<model name="m">{links}</model>'))) == 2


def test_urdf_is_told_from_sdf(world, tmp_path):
    (tmp_path / 'm.urdf').write_text('<robot name="r"/>')
    (error,) = errors_of(world(include('m.urdf')))
    assert 'this is URDF' in error.message


def test_a_ring_of_files_is_named(tmp_path):
    for name, other in (('a', 'b'), ('b', 'c'), ('c', 'a')):
        (tmp_path / f'{name}.sdf').write_text(
            model_file('<link name="l"/>' + include(f'{other}.sdf')).replace('"m"', f'"{name}"'))
    (error,) = errors_of(tmp_path / 'a.sdf')
    assert error.code == 'URI_LOOKUP'
    assert 'includes itself: a.sdf -> b.sdf -> c.sdf -> a.sdf' in error.message


def test_files_may_not_be_nested_without_end(tmp_path):
    for number in range(80):
        (tmp_path / f'{number}.sdf').write_text(
            model_file('<link name="l"/>' + include(f'{number + 1}.sdf', '<name>n</name>')))
    (error,) = errors_of(tmp_path / '0.sdf')
    assert 'more than 64' in error.message


def test_what_is_missing_is_left_out_if_asked_for(world):
    scene = sdf_pose_bridge.load(
        world(include('model://nothing', '<name>robot</name>')
              + '<frame name="f" attached_to="robot::l"/><frame name="g" attached_to="f"/>'
              + '<model name="k"><link name="l"/></model>'),
        on_missing_include='skip')
    assert scene.names == ('world', 'k', 'k::l')
    assert [warning.code for warning in scene.warnings] == ['WARNING', 'WARNING']
    assert '2 more elements are left out, which refer to it: "f", "g"' in (
        scene.warnings[1].message)


def test_a_uri_that_is_missing_twice_is_warned_about_once(world):
    scene = sdf_pose_bridge.load(
        world(include('model://a', '<name>x</name>') + include('model://a', '<name>y</name>')),
        on_missing_include='skip')
    assert len(scene.warnings) == 1


def test_all_files_that_were_read_are_told(world, tmp_path):
    (tmp_path / 'box').mkdir()
    (tmp_path / 'box' / 'model.config').write_text(
        '<model><sdf version="1.9">box.sdf</sdf></model>')
    (tmp_path / 'box' / 'box.sdf').write_text(model_file('<link name="l"/>'))
    scene = sdf_pose_bridge.load(world(include('box')))
    assert {path.removeprefix(f'{tmp_path}/') for path in scene.files} == {
        'world.sdf', 'box/model.config', 'box/box.sdf'}
