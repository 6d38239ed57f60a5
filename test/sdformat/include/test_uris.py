# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Where the files are that URIs name, and in which order directories are searched."""

from pathlib import Path

import pytest

from sdf_pose_bridge.errors import AddressError
from sdf_pose_bridge.sdformat.include.uris import resource_finder


def write(folder, name):
    """Write an empty file; return its path."""
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text('')
    return str(path)


def write_package(folder, name):
    """Write the marker of an installed package; return its share directory."""
    write(folder, f'share/ament_index/resource_index/packages/{name}')
    return folder / 'share' / name


def found(uri, tmp_path, paths=(), **environment):
    """Find what a URI names in a file that stands in the folder ``from``."""
    finder = resource_finder(paths, {'HOME': str(tmp_path / 'home'), **environment})
    return finder.path_from_uri(uri, str(tmp_path / 'from' / 'world.sdf'))


# URIs in files

@pytest.mark.parametrize('uri', [
    'model://box', 'box', 'file://box', 'package://box', 'model://', '://box', 'http://x/box',
    'https://fuel.gazebosim.org/1.0/me/models', 'https://fuel.gazebosim.org/1.0/me/models/..',
    'x' * 1000, 'package://' + 'x' * 1000, 'https://x/me/models/' + 'x' * 1000,
    'https://[/1.0/me/models/box', 'a\x00b', 'https://x/me/models/a\x00b', 'package://a\x00b',
])
def test_file_that_does_not_exist_is_not_found(uri, tmp_path):
    assert found(uri, tmp_path) is None


def test_directory_without_the_marker_of_a_package_is_not_found(tmp_path):
    write(tmp_path / 'ws', 'share/cell/models/box.sdf')
    assert found('package://cell/models/box.sdf', tmp_path,
                 AMENT_PREFIX_PATH=str(tmp_path / 'ws')) is None


@pytest.mark.parametrize('uri', ['model://box', 'box', 'file://box', 'package://box', 'zzz://box'])
def test_search_paths_are_used_for_every_scheme(uri, tmp_path):
    box = write(tmp_path / 'models', 'box')
    assert found(uri, tmp_path, [tmp_path / 'models']) == box


def test_first_search_path_is_used_and_the_environment_last(tmp_path):
    write(tmp_path / 'b', 'box')
    box = write(tmp_path / 'a', 'box')
    assert found('model://box', tmp_path, [tmp_path / 'a', tmp_path / 'b']) == box
    assert found('model://box', tmp_path, [tmp_path / 'a'], SDF_PATH=str(tmp_path / 'b')) == box


@pytest.mark.parametrize('uri', ['', 'folder', 'none.stl', 'a\x00b'])
def test_what_is_no_file_is_not_found_as_one(uri, tmp_path):
    (tmp_path / 'folder').mkdir()
    assert resource_finder([tmp_path], {}).file_from_uri(uri, 'm.sdf') is None


@pytest.mark.parametrize('uri', ['model://arm/a.stl', 'model:///arm/a.stl', 'package:///arm/a.stl'])
def test_file_is_found(uri, tmp_path):
    mesh = write(tmp_path, 'arm/a.stl')
    assert resource_finder([tmp_path], {}).file_from_uri(uri, 'm.sdf') == mesh


@pytest.mark.parametrize(('uri', 'manifest', 'is_found'), [
    ('model://arm/a.stl', 'arm/model.config', True),
    ('model://arm/a.stl', 'arm/package.xml', False),
    ('model://leg/a.stl', 'arm/model.config', False),
    ('package://robots/a.stl', 'arm/package.xml', True),
    ('package://arm/a.stl', 'arm/package.xml', False),
    ('package://robots/a.stl', 'arm/model.config', False),
])
def test_mesh_is_found_in_the_model_or_package_of_the_file(uri, manifest, is_found, tmp_path):
    mesh = write(tmp_path, 'arm/a.stl')
    (tmp_path / manifest).write_text('<package><name>robots</name></package>')
    path = resource_finder((), {}).file_from_uri(uri, str(tmp_path / 'arm' / 'sdf' / 'arm.sdf'))
    assert path == (mesh if is_found else None)


@pytest.mark.parametrize('scheme', ['', 'file://'])
def test_absolute_path_is_used_as_it_is(scheme, tmp_path):
    box = write(tmp_path, 'box.sdf')
    assert found(f'{scheme}{box}', tmp_path) == box


@pytest.mark.parametrize(('uri', 'is_found'), [
    ('box.sdf', True), ('file://box.sdf', True), ('model://box.sdf', False),
])
def test_relative_path_is_searched_beside_the_including_file(uri, is_found, tmp_path):
    box = write(tmp_path / 'from', 'box.sdf')
    assert found(uri, tmp_path) == (box if is_found else None)


def test_relative_path_is_searched_beside_the_including_file_first(tmp_path):
    mine, other = write(tmp_path / 'from', 'box.sdf'), write(tmp_path / 'models', 'box.sdf')
    assert found('box.sdf', tmp_path, [tmp_path / 'models']) == mine
    finder = resource_finder([tmp_path / 'models'], {})
    assert finder.other_path_from_uri('box.sdf', mine) == other
    assert finder.other_path_from_uri('model://box.sdf', mine) is None
    assert resource_finder([tmp_path / 'from'], {}).other_path_from_uri('box.sdf', mine) is None


def test_relative_path_is_searched_in_the_working_directory_last(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, 'box.sdf')
    assert found('model://box.sdf', tmp_path) == 'box.sdf'
    box = write(tmp_path / 'models', 'box.sdf')
    assert found('model://box.sdf', tmp_path, SDF_PATH=str(tmp_path / 'models')) == box


@pytest.mark.parametrize(('file', 'uri', 'variable', 'paths'), [
    ('models/box', 'model://box', 'GZ_SIM_RESOURCE_PATH', '/nowhere:{}/models'),
    ('models/box', 'model://box', 'SDF_PATH', '/nowhere:{}/models'),
    ('ws/share/cell/models/box.sdf', 'package://cell/models/box.sdf', 'AMENT_PREFIX_PATH',
     '/nowhere:{}/ws'),
    ('cache/fuel.gazebosim.org/open/models/box/3/meshes/box.sdf',
     'https://fuel.gazebosim.org/1.0/Open/models/Box/3/files/meshes/box.sdf',
     'GZ_FUEL_CACHE_PATH', '{}/cache'),
])
def test_paths_of_the_environment_are_searched(file, uri, variable, paths, tmp_path):
    write_package(tmp_path / 'ws', 'cell')
    box = write(tmp_path, file)
    assert found(uri, tmp_path, **{variable: paths.format(tmp_path)}) == box


@pytest.mark.parametrize(('uri', 'version'), [
    ('https://fuel.gazebosim.org/1.0/Open/models/Big%20Box', '10'),
    ('https://fuel.gazebosim.org/1.0/Open/models/Big%20Box/tip', '10'),
    ('https://fuel.gazebosim.org/1.0/open/models/big box/2', '2'),
    ('https://fuel.ignitionrobotics.org/1.0/Open/models/Big Box', '10'),
    ('https://app.gazebosim.org/Open/fuel/models/Big Box', '10'),
])
def test_fuel_model_is_found_in_the_cache(uri, version, tmp_path):
    for number in ('2', '9', '10'):
        write(
            tmp_path / 'home/.gz/fuel/fuel.gazebosim.org/open/models/big box', f'{number}/m.sdf')
    path = found(uri, tmp_path)
    assert path is not None
    assert path.endswith(f'/big box/{version}')


@pytest.mark.parametrize('uri', [
    'https://{}/1.0/..%2f..%2foutside/models/box', 'https://{}/1.0/me/models/%2e%2e',
    'https://{}/1.0/me/models/box/1/files/..%2f..%2f..%2f..%2f..%2foutside/models/box/m.sdf',
    'https://../outside/models/box', 'https://{}/1.0/%2e./models/box/%2e',
    'https:///outside/models/box',
    'https://{}/1.0/me/models/a%00b'])
def test_uri_does_not_leave_the_cache(uri, tmp_path):
    write(tmp_path / 'outside/models/box', '1/m.sdf')
    write(tmp_path / 'outside/models/box', 'm.sdf')
    write(tmp_path / 'cache/server/me/models/box', '1/m.sdf')
    cache = str(tmp_path / 'cache')
    assert found(uri.format('server'), tmp_path, GZ_FUEL_CACHE_PATH=cache) is None


def test_what_is_no_version_in_the_cache_is_skipped(tmp_path):
    box = tmp_path / 'cache/server/me/models/box'
    for name in ('1', '\u00b2', '\u0663', '-4', 'x5'):
        write(box / name, 'm.sdf')
    assert found('https://server/1.0/me/models/box', tmp_path,
                 GZ_FUEL_CACHE_PATH=str(tmp_path / 'cache')) == str(box / '1')


@pytest.mark.parametrize('folder', ['server', 'server/me', 'server/me/models'])
def test_directory_of_the_cache_that_cannot_be_listed_has_nothing(folder, tmp_path):
    cache = tmp_path / 'cache'
    loop = cache / folder
    loop.parent.mkdir(parents=True)
    loop.symlink_to(loop)
    assert found('https://server/1.0/me/models/box', tmp_path,
                 GZ_FUEL_CACHE_PATH=str(cache)) is None


@pytest.mark.parametrize(('uri', 'shown'), [
    ('https://fuel.gazebosim.org/1.0/Open/models/Box',) * 2,
    ('https://fuel.gazebosim.org/1.0/Open/models/Box/2',) * 2,
    *((f'https://fuel.gazebosim.org/Open/models/Box/tip{rest}',
       'https://fuel.gazebosim.org/Open/models/Box/tip') for rest in ('/', '/files/meshes/a.dae')),
    ('https://x/1.0/me/models/Box/files/a.dae', 'https://x/1.0/me/models/Box'),
    ('https://x/1.0/me/models/a";id;"', """'https://x/1.0/me/models/a";id;"'"""),
    ("https://x/1.0/me/models/a';id", """'https://x/1.0/me/models/a'"'"';id'""")])
def test_reason_for_a_missing_fuel_model_says_how_to_fetch_it(uri, shown):
    assert resource_finder((), {}).reason_not_found(uri, 'a.sdf').endswith(
        f'fetch it with: gz fuel download -u {shown}')


@pytest.mark.parametrize('uri', [
    'https://example.org/cell.sdf', 'https://app.gazebosim.org/Open/fuel/models/Box',
    'https://x/1.0/me/models/' + "'" * 1000])
def test_no_command_is_told_that_cannot_fetch_an_address(uri):
    reason = resource_finder((), {}).reason_not_found(uri, 'a.sdf')
    assert reason == 'it is not in the cache of Gazebo Fuel'


@pytest.mark.parametrize(('uri', 'reason'), [
    ('model://box', 'it is not in "mine", "there", "."'),
    ('box', 'it is not in "cells", "mine", "there", "."'),
    ('package://arm/box', 'no package "arm" is installed, and it is not in "mine", '),
    ('x' * 1000, 'it is not in "cells", '),
])
def test_reason_for_a_missing_model_names_what_was_searched(uri, reason):
    finder = resource_finder(['mine'], {'SDF_PATH': 'there'})
    assert finder.reason_not_found(uri, 'cells/a.sdf').startswith(reason)
    assert 'GZ_SIM_RESOURCE_PATH' in finder.reason_not_found(uri, 'cells/a.sdf')


def test_reason_for_a_model_of_gazebo_classic_says_that_it_is_not_needed():
    assert resource_finder((), {}).reason_not_found('model://sun', 'a.sdf') == (
        'it comes with Gazebo Classic, and no frame needs it')


@pytest.mark.parametrize(('uri', 'file', 'missing'), [
    ('package://arm/meshes/basee.stl', 'urdf/arm.urdf', 'basee.stl'),
    ('model://arm/meshes/basee.stl', 'urdf/arm.urdf', 'basee.stl'),
    ('../meshes/basee.stl', 'urdf/arm.urdf', 'basee.stl'),
    ('package://arm/mesh/base.stl', 'urdf/arm.urdf', 'mesh'),
])
def test_reason_names_the_folder_without_the_file_and_the_nearest_name(
        tmp_path, uri, file, missing):
    write(tmp_path / 'arm', 'model.config')
    write(tmp_path / 'arm', 'meshes/base.stl')
    write(tmp_path / 'arm', file)
    reason = resource_finder((), {}).reason_not_found(uri, str(tmp_path / 'arm' / file))
    nearest = {'basee.stl': 'base.stl', 'mesh': 'meshes'}[missing]
    assert reason.endswith(f'" has no "{missing}"; did you mean "{nearest}"?')


def test_reason_for_a_model_in_a_folder_beside_the_file_names_the_folder(tmp_path):
    write(tmp_path / 'models/arm', 'model.sdf')
    reason = resource_finder((), {}).reason_not_found(
        'model://arm', str(tmp_path / 'worlds/cell.sdf'))
    assert f'but in "{tmp_path}/models"; add that to resource_paths' in reason


def test_reason_for_a_misspelt_file_has_the_nearest_name(tmp_path):
    write(tmp_path, 'table.sdf')
    reason = resource_finder((), {}).reason_not_found('tabel.sdf', str(tmp_path / 'cell.sdf'))
    assert reason.endswith('; did you mean "table.sdf"?')


@pytest.mark.parametrize(('template', 'program'), [
    ('arm.sdf.jinja', 'Jinja'), ('arm.sdf.xacro', 'xacro')])
@pytest.mark.parametrize('uri', ['arm.sdf', 'model://models/arm.sdf'])
def test_reason_for_a_missing_file_names_the_template_of_it(tmp_path, template, program, uri):
    write(tmp_path / 'models', template)
    write(tmp_path / 'models', 'arms.sdf')
    reason = resource_finder([tmp_path], {}).reason_not_found(
        uri, str(tmp_path / 'models/cell.sdf'))
    assert reason.endswith(f'; {program} makes it of "{template}" beside it')


# Addresses that users give

@pytest.fixture
def finder(tmp_path):
    """Return a finder that knows a package ``cell_description`` and a model ``table``."""
    write_package(tmp_path / 'ws', 'cell_description')
    write(tmp_path / 'models', 'table')
    return resource_finder(
        [tmp_path / 'models'], {'AMENT_PREFIX_PATH': str(tmp_path / 'ws'), 'HOME': '/'})


@pytest.mark.parametrize(('address', 'reason'), [
    ('package://nowhere/cell.sdf', 'names the package "nowhere", which is not installed'),
    ('package:///cell.sdf', 'names the package ""'),
    ('model://chair', 'is found neither in resource_paths nor in'),
    ('http://example.org/cell.sdf', 'is a http:// URI'),
    ('file://cells/cell.sdf', 'names the host "cells"'),
    ('file:///cell.sdf?x=1', r'write %3F or %23'),
    ('file:///cell#2.sdf', r'write %3F or %23'),
    ('file://[cell.sdf', 'is not a URI'),
    ('~no_such_user/cell.sdf', 'a user who does not exist'),
])
def test_address_that_names_no_file_is_refused(finder, address, reason):
    with pytest.raises(AddressError, match=reason) as refusal:
        finder.path_from_address(address)
    assert f'"{address}"' in str(refusal.value)


@pytest.mark.parametrize(('address', 'path'), [
    ('/cells/cell.sdf', '/cells/cell.sdf'),
    ('/cells/50%25 #2?.sdf', '/cells/50%25 #2?.sdf'),
    ('file:///cells/cell.sdf', '/cells/cell.sdf'),
    ('file://localhost/cells/cell.sdf', '/cells/cell.sdf'),
    ('file:///cells/left%20cell%23.sdf', '/cells/left cell#.sdf'),
    ('model://table', 'models/table'),
    ('package://cell_description/worlds/cell.sdf', 'ws/share/cell_description/worlds/cell.sdf'),
    ('package://cell_description/left%20cell.sdf', 'ws/share/cell_description/left cell.sdf'),
    ('package://cell_description', 'ws/share/cell_description'),
    ('cell.sdf', 'cell.sdf'),
])
def test_address_is_absolute_or_starts_at_what_it_names_or_at_the_working_directory(
        finder, monkeypatch, tmp_path, address, path):
    monkeypatch.chdir(tmp_path)
    assert finder.path_from_address(address) == tmp_path / path


def test_tilde_in_an_address_is_the_home_directory(finder, monkeypatch):
    monkeypatch.setenv('HOME', '/home/someone')
    assert finder.path_from_address('~/cell.sdf') == Path('/home/someone/cell.sdf')
