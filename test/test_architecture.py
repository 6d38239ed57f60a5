# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Modules, tests and pages fit together as docs/architecture.md describes."""

import ast
from collections import defaultdict
import re

from folders import ROOT
import pytest

PACKAGE = ROOT / 'sdf_pose_bridge'
TESTS = ROOT / 'test'
MODULES = sorted(
    path.relative_to(PACKAGE) for path in PACKAGE.rglob('*.py') if not path.stem.startswith('__'))
PAGES = [ROOT / 'CONTRIBUTING.md', *sorted((ROOT / 'docs').glob('*.md'))]

TESTED_AS_A_WHOLE = {
    'ros/node/node.py': [
        'integration/test_bridge_reload.py', 'integration/test_bridge_changes.py'],
}
"""Modules that run only as a part of others, and the test modules that run these."""


def test_every_module_has_its_test_module_or_is_tested_as_a_whole():
    without = {str(module) for module in MODULES
               if not (TESTS / module.with_name(f'test_{module.name}')).exists()}
    assert without == TESTED_AS_A_WHOLE.keys()


@pytest.mark.parametrize(('file', 'others'), [
    ('.ci/run', {'ros'}), ('Makefile', {'ros', 'cli'})], ids=['oldest versions', 'test_core'])
def test_all_rooms_are_in_a_run_without_ros(file, others):
    run, = re.findall(r'^\s*(test/geometry .*)', (ROOT / file).read_text(), re.M)
    rooms = {module.parts[0] for module in MODULES if len(module.parts) > 1}
    assert {*re.findall(r'test/(\w+)', run)} == rooms - others


@pytest.mark.parametrize('module', TESTED_AS_A_WHOLE)
def test_tests_of_whole_programs_exist(module):
    assert all((TESTS / name).exists() for name in TESTED_AS_A_WHOLE[module])


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_files_that_a_page_names_exist(page):
    rooms = '|'.join(sorted({module.parts[0] for module in MODULES}))
    named = re.findall(
        rf'`((?:(?:{rooms}|test|docs|config|underlay)/)[\w/.]+)`',
        page.read_text())
    assert [name for name in named
            if not (PACKAGE / name).exists() and not (ROOT / name).exists()] == []


def test_the_map_lists_each_room_after_those_that_it_imports():
    text = (ROOT / 'docs/architecture.md').read_text()
    rooms = [room for names in re.findall(r'^\* ((?:`\w+(?:/|\.py)`(?:, )?)+):', text, re.M)
             for room in re.findall(r'`(\w+)', names)]
    modules = defaultdict(str)
    for module in MODULES:
        modules[module.parts[0].removesuffix('.py')] += (PACKAGE / module).read_text()
    assert sorted(modules) == sorted(rooms)
    found = [
        (room, other) for room in rooms
        for other in re.findall(r'^ *from sdf_pose_bridge\.(\w+)', modules[room], re.M)
        if rooms.index(other) > rooms.index(room)]
    assert found == []


def names_defined_in(path):
    """Return the names of the classes, functions, constants and fields in a module."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id


def test_classes_functions_and_constants_that_the_page_on_architecture_names_exist():
    text = (ROOT / 'docs/architecture.md').read_text()
    named = re.findall(r'`(?:[a-z_]+\.)?([A-Z]\w+|[a-z]+_\w+)`', text)
    defined = {name for module in MODULES for name in names_defined_in(PACKAGE / module)}
    assert 'Scene' in named
    assert 'hint_from_names' in named
    assert set(named) - defined == {'sdf_pose'}  # the program
