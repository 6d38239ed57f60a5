# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The package files agree with each other, and install everything in its place."""

import ast
from functools import cache
import importlib
import json
import os
from pathlib import Path
import re
import sys
import xml.etree.ElementTree as ET

from command_line import completed
from folders import ROOT
import needs
import pytest

import sdf_pose_bridge
from sdf_pose_bridge.cli.main import new_parser
from sdf_pose_bridge.cli.viewer import LIBRARIES
from sdf_pose_bridge.ros.cdr import JOINT_STATE, POSE_TYPES

PACKAGES = {
    'sdf_pose_bridge': ROOT,
    'sdf_pose_bridge_interfaces': ROOT / 'sdf_pose_bridge_interfaces',
    'sdf_pose_bridge_cpp_client': ROOT / 'examples/cpp_client',
    'tf2_msgs': ROOT / 'underlay/tf2_msgs',
    'simulation_interfaces': ROOT / 'underlay/simulation_interfaces',
}
OURS = ('sdf_pose_bridge', 'sdf_pose_bridge_interfaces')
COLCON_VERBS = ('build', 'test', 'list', 'info', 'graph')


def package_xml(package):
    return ET.parse(PACKAGES[package] / 'package.xml').getroot()


def installed_files():
    """Return where below the install prefix setup.py puts each data file, by the file."""
    return {
        source: f'{target}/{Path(source).name}'
        for target, sources in arguments_of_setup()['data_files'] for source in sources}


@cache
def arguments_of_setup(*command):
    """Return what setup.py calls setuptools with, for a command."""
    needs.modules('setuptools')
    code = (
        'import json, runpy, setuptools; found = {}; setuptools.setup = found.update; '
        'runpy.run_path("setup.py"); found.pop("cmdclass"); print(json.dumps(found))')
    result = completed([sys.executable, '-c', code, *command], cwd=ROOT, check=True)
    return json.loads(result.stdout)


OF_THE_VIEWER = {'rich', 'trimesh', 'viser', 'websockets'}
"""What only ``sdf_pose view`` imports: viser, what comes with it, and trimesh."""


@pytest.mark.parametrize('package', PACKAGES)
def test_package_xml_is_valid_for_catkin_pkg(package):
    catkin_pkg = pytest.importorskip('catkin_pkg.package', reason='catkin_pkg is not installed')
    warnings = []
    parsed = catkin_pkg.parse_package(str(PACKAGES[package]), warnings=warnings)
    parsed.validate(warnings=warnings)
    assert warnings == []


def test_package_xml_declares_every_package_that_the_code_imports():
    files = [*(ROOT / 'sdf_pose_bridge').rglob('*.py'), *(ROOT / 'launch').glob('*.py')]
    # A launch file in XML imports nothing, but is read by a package of its own. The command xacro
    # is run by bridge.launch.py.
    imported = {'launch_xml', 'xacro', *(
        each.partition('/')[0] for each in (JOINT_STATE, *POSE_TYPES))}
    for file in files:
        for node in ast.walk(ast.parse(file.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) else []
            imported |= {name.split('.')[0] for name in names}
    keys = {
        f'python3-{name}' if name in ('lxml', 'numpy', 'yaml') else name
        for name in imported - sys.stdlib_module_names - OF_THE_VIEWER - {'sdf_pose_bridge'}}
    declared = {tag.text for tag in package_xml('sdf_pose_bridge').iter('exec_depend')}
    assert keys == declared


@pytest.mark.parametrize('package', PACKAGES)
def test_every_license_is_apache(package):
    assert [tag.text for tag in package_xml(package).iter('license')] == ['Apache-2.0']


def test_there_is_one_version():
    versions = {package_xml(name).findtext('version') for name in PACKAGES
                if PACKAGES[name].parent != ROOT / 'underlay'}
    assert versions == {arguments_of_setup()['version']} == {sdf_pose_bridge.__version__}


def test_people_are_those_of_package_xml():
    root, found = package_xml('sdf_pose_bridge'), arguments_of_setup()
    maintainer = root.find('maintainer')
    assert (found['maintainer'], found['maintainer_email'], found['author']) == (
        maintainer.text, maintainer.get('email'), root.findtext('author'))
    assert f'the {maintainer.text}, {found["maintainer_email"]}:' in (
        ROOT / 'README.md').read_text()


def test_the_address_of_the_repository_stands_in_one_place():
    files = [
        file for pattern in ('*.*', '.github/**/*.*', 'docs/*.*', 'sdf_pose_bridge_*/*.*')
        for file in ROOT.glob(pattern) if file.is_file()]
    assert [file.name for file in files if re.search(
        r'github\.com/[^/\s]+/sdf_pose_bridge(?![-\w])', file.read_text(errors='replace'))] == [
            'package.xml']


def test_links_and_pictures_lead_into_the_repository_from_a_package_index():
    found = arguments_of_setup()
    links = re.findall(r'(!?)\[[^]]*\]\(([^)]*)\)', found['long_description'])
    assert len(links) > 10
    version, url = found['version'], found['url']
    for is_picture, link in links:
        if link.startswith(('#', 'https://img.shields.io/')):
            continue
        kind, name = re.fullmatch(rf'{re.escape(url)}/(\w+)/{version}/(.*)', link).groups()
        assert kind == ('raw' if is_picture else 'blob')
        assert (ROOT / name).is_file(), name


def test_libraries_of_view_are_those_that_it_names_in_its_errors():
    assert arguments_of_setup()['extras_require']['view'] == list(LIBRARIES)


@pytest.mark.parametrize(('command', 'node'), [
    ('install', {'bridge', 'robot_state_publisher'}),
    ('develop', {'bridge', 'robot_state_publisher'}), ('bdist_wheel', {'sdf_pose_bridge'})])
def test_names_of_other_programs_are_used_in_a_ros_workspace_only(command, node):
    scripts = arguments_of_setup(command)['entry_points']['console_scripts']
    assert {script.split(' = ')[0] for script in scripts} == {'sdf_pose', *node}
    # pip puts the programs themselves there.
    assert ('bin' in dict(arguments_of_setup(command)['data_files'])) is ('bridge' in node)


@pytest.fixture(scope='module')
def scripts(tmp_path_factory):
    """Folder of the scripts as they are installed for ROS."""
    folder = tmp_path_factory.mktemp('scripts')
    needs.modules('setuptools')
    completed([sys.executable, 'setup.py', '--quiet', 'egg_info', '--egg-base', folder,
               'install_scripts', '--install-dir', folder], cwd=ROOT, check=True)
    return folder


@pytest.mark.parametrize('name', ['bridge', 'robot_state_publisher', 'sdf_pose'])
def test_scripts_are_marked_for_completion_and_block_signals_first(name, scripts):
    _, mark, _, *lines = map(str.strip, (scripts / name).read_text().splitlines())
    assert mark == '# PYTHON_ARGCOMPLETE_OK'
    blocks = [line.startswith('signal.pthread_sigmask(signal.SIG_BLOCK, ') for line in lines[:2]]
    assert blocks == [False, True]


@pytest.mark.parametrize('verb', COLCON_VERBS)
def test_colcon_finds_both_packages_under_every_verb(verb):
    yaml = pytest.importorskip('yaml', reason='PyYAML is not installed')
    settings = yaml.safe_load((ROOT / 'colcon_defaults.yaml').read_text())
    found = {
        package_xml(name).findtext('name')
        for name, folder in PACKAGES.items()
        if folder in {(ROOT / path).resolve() for path in settings[verb]['base-paths']}}
    assert found == set(OURS)


def test_cmake_generates_every_service_file():
    folder = PACKAGES['sdf_pose_bridge_interfaces']
    assert re.findall(r'"(srv/\w+\.srv)"', (folder / 'CMakeLists.txt').read_text()) == sorted(
        f'srv/{file.name}' for file in folder.glob('srv/*.srv'))


@pytest.mark.parametrize('folder', ['launch', 'config', 'rviz', 'examples'])
def test_every_file_to_share_is_installed_in_its_place(folder):
    files = [
        file.relative_to(ROOT).as_posix() for file in (ROOT / folder).rglob('*')
        if file.is_file() and '__pycache__' not in file.parts]
    assert files
    places = installed_files()
    assert {file: places.get(file) for file in files} == {
        file: f'share/sdf_pose_bridge/{file}' for file in files}


def test_the_environment_is_built_again_after_a_change_of_any_installed_file(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / 'underlay'))
    from make_underlay import bridge_sources
    sources = bridge_sources()
    assert [file for file in installed_files() if not any(
        (ROOT / file).is_relative_to(source) for source in sources)] == []
    assert ROOT / 'sdf_pose_bridge' in sources


def test_package_xml_and_the_index_entry_are_installed():
    places = installed_files()
    assert (places['package.xml'], places['resource/sdf_pose_bridge']) == (
        'share/sdf_pose_bridge/package.xml',
        'share/ament_index/resource_index/packages/sdf_pose_bridge')


def test_the_manual_page_names_every_command():
    page = (ROOT / 'resource/sdf_pose.1').read_text()
    listed = re.findall(r'^    ([a-z]+) +(.+)$', new_parser().format_help(), re.MULTILINE)
    assert re.findall(r'^\.B ([a-z]+)\n(.+)$', page, re.MULTILINE) == listed


def test_license_is_the_whole_apache_license():
    text = (ROOT / 'LICENSE').read_text()
    assert 'Version 2.0, January 2004' in text
    assert 'END OF TERMS AND CONDITIONS' in text


def test_example_packages_are_ignored_where_they_are():
    assert {path.name for path in (ROOT / 'examples/cpp_client').glob('*_IGNORE')} == {
        'AMENT_IGNORE', 'COLCON_IGNORE'}


def test_tests_are_collected_where_modules_are_missing():
    missing = [
        'catkin_pkg', 'collada', 'hypothesis', 'mpmath', 'rclpy', 'setuptools', 'trimesh',
        'viser', 'yaml']
    code = (
        f'import pytest, sys; sys.modules.update(dict.fromkeys({missing})); '
        'sys.exit(pytest.main(["--collect-only", "--quiet", "--assert", "plain", '
        '"-p", "no:cacheprovider"]))')
    done = completed(
        [sys.executable, '-c', code], cwd=ROOT,
        env={**os.environ, 'PYTEST_DISABLE_PLUGIN_AUTOLOAD': '1'})
    assert done.returncode == 0, done.stdout
    assert 'needs hypothesis' in done.stdout
    assert 'needs mpmath' in done.stdout


@pytest.mark.parametrize('path', sorted(ROOT.glob('launch/*.py')), ids=lambda path: path.name)
def test_launch_files_import_names_that_exist(path):
    pytest.importorskip('rclpy', reason='needs ROS 2')
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module.startswith('sdf_pose_bridge'):
            module = importlib.import_module(node.module)
            assert [name.name for name in node.names if not hasattr(module, name.name)] == []
