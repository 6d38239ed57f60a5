# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Where included files are found, and in which order."""

import pytest

from sdf_pose_bridge.sdformat.include.resources import resource_finder


def put(folder, name, text=''):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return str(path)


def find(uri, tmp_path, paths=(), **environment):
    finder = resource_finder(paths, {'HOME': str(tmp_path / 'home'), **environment})
    return finder.path_from_uri(uri, str(tmp_path / 'from' / 'world.sdf'))


@pytest.mark.parametrize('uri', [
    'model://box', 'box', 'file://box', 'package://box', 'model://', '://box', 'http://x/box',
    'https://fuel.gazebosim.org/1.0/me/models', 'https://fuel.gazebosim.org/1.0/me/models/..',
    'x' * 1000, 'package://' + 'x' * 1000, 'https://x/me/models/' + 'x' * 1000,
    'https://[/1.0/me/models/box', 'a\x00b', 'https://x/me/models/a\x00b', 'package://a\x00b',
])
def test_what_is_nowhere_is_not_found(uri, tmp_path):
    assert find(uri, tmp_path) is None


@pytest.mark.parametrize('uri', ['model://box', 'box', 'file://box', 'package://box', 'zzz://box'])
def test_search_paths_serve_every_scheme(uri, tmp_path):
    box = put(tmp_path / 'models', 'box')
    assert find(uri, tmp_path, [tmp_path / 'models']) == box


def test_the_first_search_path_wins(tmp_path):
    put(tmp_path / 'b', 'box')
    box = put(tmp_path / 'a', 'box')
    assert find('model://box', tmp_path, [tmp_path / 'a', tmp_path / 'b']) == box


def test_an_absolute_path_is_taken_as_it_is(tmp_path):
    box = put(tmp_path, 'box.sdf')
    assert find(box, tmp_path) == box
    assert find(f'file://{box}', tmp_path) == box


@pytest.mark.parametrize(('uri', 'is_found'), [
    ('box.sdf', True), ('file://box.sdf', True), ('model://box.sdf', False),
])
def test_plain_paths_are_looked_for_beside_the_file_that_includes(uri, is_found, tmp_path):
    box = put(tmp_path / 'from', 'box.sdf')
    assert find(uri, tmp_path) == (box if is_found else None)


@pytest.mark.parametrize('variable', ['GZ_SIM_RESOURCE_PATH', 'SDF_PATH'])
def test_paths_come_from_the_environment(variable, tmp_path):
    box = put(tmp_path / 'models', 'box')
    assert find('model://box', tmp_path, **{variable: f'/nowhere:{tmp_path / "models"}'}) == box


def test_given_paths_come_before_those_of_the_environment(tmp_path):
    put(tmp_path / 'b', 'box')
    box = put(tmp_path / 'a', 'box')
    assert find('model://box', tmp_path, [tmp_path / 'a'], SDF_PATH=str(tmp_path / 'b')) == box


def test_a_package_is_found_by_its_marker(tmp_path):
    put(tmp_path / 'ws', 'share/ament_index/resource_index/packages/cell')
    box = put(tmp_path / 'ws', 'share/cell/models/box.sdf')
    found = find('package://cell/models/box.sdf', tmp_path,
                 AMENT_PREFIX_PATH=f'/nowhere:{tmp_path / "ws"}')
    assert found == box


def test_a_folder_without_the_marker_is_no_package(tmp_path):
    put(tmp_path / 'ws', 'share/cell/models/box.sdf')
    found = find('package://cell/models/box.sdf', tmp_path, AMENT_PREFIX_PATH=str(tmp_path / 'ws'))
    assert found is None


@pytest.mark.parametrize(('uri', 'version'), [
    ('https://fuel.gazebosim.org/1.0/Open/models/Big%20Box', '10'),
    ('https://fuel.gazebosim.org/1.0/Open/models/Big%20Box/tip', '10'),
    ('https://fuel.gazebosim.org/1.0/open/models/big box/2', '2'),
])
def test_fuel_models_are_found_in_the_cache(uri, version, tmp_path):
    for number in ('2', '9', '10'):
        put(tmp_path / 'home/.gz/fuel/fuel.gazebosim.org/open/models/big box', f'{number}/m.sdf')
    found = find(uri, tmp_path)
    assert found is not None
    assert found.endswith(f'/big box/{version}')


def test_a_file_of_a_fuel_model_is_found(tmp_path):
    file = put(tmp_path / 'cache/fuel.gazebosim.org/open/models/box', '3/meshes/box.sdf')
    found = find('https://fuel.gazebosim.org/1.0/Open/models/Box/3/files/meshes/box.sdf', tmp_path,
                 GZ_FUEL_CACHE_PATH=str(tmp_path / 'cache'))
    assert found == file
