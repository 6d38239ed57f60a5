# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Where elements were written: files and lines, also beyond the lines that libxml2 counts."""

import pytest
from sdf_texts import (
    INCLUDES_LEAF,
    LINK,
    model_file,
    only_error,
    scene_from_files,
    world_file,
    write_files,
)

from sdf_pose_bridge import load, load_text

# Lines: libxml2 counts no more than 65,535 of them

LINES = '\n' * 70_000


def line_of_link(content):
    """Return the line of the link ``l`` in a model with the given content."""
    scene = load_text(model_file(content))
    return int(scene.lines[scene.index('m::l')])


@pytest.mark.parametrize('line', [1, 65_534, 65_535, 65_536, 65_537, 200_000])
def test_line_of_an_element(line):
    assert line_of_link('\n' * (line - 1) + LINK + '\n' * 10) == line


@pytest.mark.parametrize('line', [1, 65_533, 65_534, 65_535, 65_536, 70_000])
def test_line_of_an_element_is_that_of_the_beginning_of_its_start_tag(line):
    assert line_of_link('\n' * (line - 1) + '<link\nname="l"\n>\n</link>') == line


def test_lines_of_all_elements_of_a_long_file():
    names = [f'l{index}' for index in range(1, 30)]
    content = ('\n' * 5_000).join(['', *(f'<link name="{name}"/>' for name in names)])
    scene = load_text(model_file(content))
    lines = [int(scene.lines[scene.index(f'm::{name}')]) for name in names]
    assert lines == [1 + 5_000 * index for index in range(1, 30)]


@pytest.mark.parametrize('content', [
    '<!-- <link name="k"> -->', '<!-- <a b="> -->', "<!-- don't -->",
    '<plugin name="p" filename="f"><![CDATA[<a><b c=">]]></plugin>',
    '<x><![CDATA[<!-- ]]></x>', '<x><![CDATA[<!-- ]]></x><b/><!-- c -->',
    '<x>a > b</x>', "<x>don't</x>", '<x y="a>b"/>', "<x y='a>'/>",
    '<frame name="a&lt;b&gt;"/>', '<x:y z:w="1"/>', '<x\n\n/>', '<x></x >',
    '<!-- a ---><!-- b -->', '<x y="\'"/>', "<x y='\"'/>",
])
def test_content_that_looks_like_tags_does_not_change_lines(content):
    extra, rest = content.count('\n'), f'{LINK}\n\n<x/>'
    assert line_of_link(f'{LINES}{content}\n{rest}') == 70_002 + extra
    assert line_of_link(f'{content}{LINES}{rest}') == 70_001 + extra


@pytest.mark.parametrize(('before', 'after'), [
    ('<?a <b> ?>', ''), ('<!-- <b> -->', ''), ('<!DOCTYPE sdf>', ''),
    ('<!DOCTYPE sdf SYSTEM "<b>">', ''), ('', '<!-- <b> -->'), ('', '<b/>'), ('', '</b>'),
])
def test_content_beside_the_outermost_element_does_not_change_lines(before, after):
    scene = load_text(before + model_file(LINES + LINK) + after)
    assert scene.lines[scene.index('m::l')] == 70_001


@pytest.mark.parametrize('line_end', ['\n', '\r\n'])
def test_lines_end_with_line_feeds(line_end):
    assert line_of_link(line_end * 70_000 + LINK) == 70_001


@pytest.mark.parametrize('encoding', [
    'utf-8', 'utf-8-sig', 'ISO-8859-1', 'UTF-16', 'UTF-16LE', 'UTF-16BE', 'UTF-32',
    'UTF-32LE', 'windows-1252'])
def test_lines_of_bytes_in_any_encoding(encoding):
    name = {'ISO-8859-1': 'größe', 'windows-1252': '€', 'utf-8': '手 größe'}.get(encoding, '手')
    text = model_file(f'<x>{name}</x>' + LINES + f'<link name="{name}"/>')
    declared = f'<?xml version="1.0" encoding="{encoding.removesuffix("-sig")}"?>' + text
    scene = load_text(declared.encode(encoding))
    assert scene.lines[scene.index(f'm::{name}')] == 70_001


@pytest.mark.parametrize('line', [65_534, 65_535, 65_536, 100_000])
def test_line_of_an_error(line):
    text = model_file('\n' * (line - 2) + '<link name="l">\n<pose>1 2</pose>\n</link>')
    assert only_error(text).line == line


@pytest.mark.parametrize('line', [65_535, 65_536, 100_000])
def test_line_of_a_warning(line):
    visual = '<visual name="v"><pose relative_to="x"/></visual>'
    text = model_file('\n' * (line - 1) + f'<link name="l">{visual}</link>')
    (warning,) = load_text(text).warnings
    assert warning.place.line == line


def test_many_warnings_end_with_the_number_of_those_not_kept():
    scene = load_text(model_file('<link name="l">' + '<pose/>\n' * 131 + '</link>'))
    assert [each.place.line for each in scene.warnings] == [*range(2, 102), 0]
    assert scene.warnings[-1].message == 'and 30 more warnings'


def test_line_of_broken_xml_in_a_long_file():
    assert only_error(model_file(LINES + '<link name="l"></lynk>')).line == 70_001


# Files

def place_of(scene, name):
    return scene.place(scene.index(name))[:2]


@pytest.fixture
def folder(tmp_path):
    """Return a folder with a long model file that is included twice, and by a file in between."""
    write_files(
        tmp_path,
        long=model_file(LINES + LINK + LINES + '<frame name="f"/>'),
        twice=world_file(
            '\n' * 80_000 + '<include><uri>long.sdf</uri><name>a</name></include>\n'
            '<include><uri>long.sdf</uri><name>b</name></include>\n<frame name="g"/>'),
        middle=model_file(
            '\n' * 66_000 + '<include><uri>long.sdf</uri><name>n</name></include>\n'
            '<link name="k"/>'),
        outer=world_file('<include><uri>middle.sdf</uri></include>\n<frame name="g"/>'),
        merging=model_file(
            '\n' * 90_000 + '<include merge="1"><uri>long.sdf</uri></include>\n<link name="k"/>'))
    return tmp_path


@pytest.mark.parametrize(('main', 'name', 'file', 'line'), [
    ('twice', 'a::l', 'long', 70_001), ('twice', 'a::f', 'long', 140_001),
    ('twice', 'b::l', 'long', 70_001), ('twice', 'b::f', 'long', 140_001),
    ('twice', 'g', 'twice', 80_003), ('merging', 'm::l', 'long', 70_001),
    ('merging', 'm::f', 'long', 140_001), ('merging', 'm::k', 'merging', 90_002),
])
def test_lines_of_a_long_file_that_is_included_twice_or_merged(folder, main, name, file, line):
    scene = load(folder / f'{main}.sdf')
    assert place_of(scene, name) == (str(folder / f'{file}.sdf'), line)


def test_element_stands_where_its_include_places_it(tmp_path):
    scene = scene_from_files(
        tmp_path, leaf=model_file('\n' + LINK),
        main=world_file('\n\n<include><uri>leaf.sdf</uri>\n<pose>1 0 0 0 0 0</pose></include>'))
    assert place_of(scene, 'm') == (str(tmp_path / 'main.sdf'), 3)
    assert place_of(scene, 'm::l') == (str(tmp_path / 'leaf.sdf'), 2)


def test_element_that_its_include_does_not_place_stands_in_its_file(tmp_path):
    scene = scene_from_files(tmp_path, leaf=model_file(LINK), main=INCLUDES_LEAF)
    assert place_of(scene, 'm') == (str(tmp_path / 'leaf.sdf'), 1)


def test_all_files_that_were_read_are_listed(tmp_path):
    (tmp_path / 'box').mkdir()
    (tmp_path / 'box' / 'model.config').write_text(
        '<model><sdf version="1.9">box.sdf</sdf></model>')
    write_files(tmp_path / 'box', box=model_file(LINK))
    write_files(tmp_path, main=world_file('<include><uri>box</uri></include>' * 2).replace(
        '</include>', '<name>b</name></include>', 1))
    scene = load(tmp_path / 'main.sdf')
    assert [path.removeprefix(f'{tmp_path}/') for path in scene.files] == [
        'main.sdf', 'box/model.config', 'box/box.sdf']
