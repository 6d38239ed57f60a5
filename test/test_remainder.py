# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What is left of a text without its regular part, and that nothing else is."""

from lxml import etree
import pytest
from sdf_texts import assert_at
from sdf_texts import model_file

import sdf_pose_bridge
from sdf_pose_bridge import document_reading
from sdf_pose_bridge import regular_part
from sdf_pose_bridge.document_reading import document_from_text
from sdf_pose_bridge.document_reading import documents_from_files
from sdf_pose_bridge.document_reading import whole_document
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.remainder import remainders_from_tags
from sdf_pose_bridge.tag_search import tags_from_texts
from sdf_pose_bridge.versions import NEWEST

LINK = '<link name="{}"><pose>1 2 3 0 0 0</pose></link>'
ONE_PART = 1 << 40
REGULAR = LINK.format('a') + '\n' + LINK.format('b')


@pytest.fixture(autouse=True)
def _every_file_is_large(monkeypatch):
    monkeypatch.setattr(document_reading, '_LARGE', 0)


def sdf(content):
    return f'<?xml version="1.0"?>\n<sdf version="1.9">{content}</sdf>'.encode()


def left_of(content):
    text = sdf(content)
    (remainder,) = remainders_from_tags(tags_from_texts([text]), [text], NEWEST, ONE_PART)
    return etree.fromstring(remainder.text)


def names_left(content):
    return [xml.get('name') for xml in left_of(content).iter() if xml.get('name')]


def test_of_what_is_regular_only_its_holder_is_left():
    assert names_left(f'<model name="m">{REGULAR}</model>') == ['m']


def test_what_holds_no_pose_is_left():
    root = left_of(f'<world name="w"><gravity>0 0 -9</gravity><model name="m">{REGULAR}</model>'
                   '<physics name="p"/></world>')
    assert [xml.tag for xml in root.iter()] == ['sdf', 'world', 'gravity', 'physics']


def test_what_is_odd_is_left_in_its_line_with_what_holds_it():
    odd = '<link name="c"><pose>1 2 3<!-- --> 0 0 0</pose></link>'
    root = left_of(f'<world name="w"><model name="n">{REGULAR}</model>\n<model name="m">\n'
                   f'{REGULAR}\n{odd}</model></world>')
    assert [(xml.get('name'), xml.sourceline) for xml in root.iter('world', 'model', 'link')] == [
        ('w', 2), ('m', 4), ('c', 7)]


def test_more_lines_may_be_left_out_than_a_parser_takes_in_one_text():
    root = left_of(f'<model name="m">{LINK.format("a")}<link name="b">'
                   + 11 * ('<!--' + 1_000_000 * '\n' + '-->')
                   + f'</link>{LINK.format("c")}<plugin name="p"/></model>')
    assert [xml.tag for xml in root.iter(etree.Element)] == ['sdf', 'model', 'plugin']


def test_where_a_name_is_odd_its_siblings_are_left():
    assert names_left(f'<model name="m">{REGULAR}<link name=" c "/></model>') == [
        'm', 'a', 'b', ' c ']


def test_where_names_are_equal_their_siblings_are_left():
    assert names_left(f'<model name="m">{REGULAR}{REGULAR}<link name="c"/></model>') == [
        'm', 'a', 'b', 'a', 'b', 'c']


def test_what_holds_a_doubtful_value_is_left():
    doubtful = '<link name="c"><inertial><mass>x</mass></inertial></link>'
    assert names_left(f'<model name="m">{REGULAR}{doubtful}</model>') == ['m', 'c']


@pytest.mark.parametrize('plugin', ['<plugin name="p"/>', '<plugin name="filename=\'f\'"/>'])
def test_what_holds_something_without_an_attribute_that_it_needs_is_left(plugin):
    assert 'a' in names_left(f'<model name="m"><link name="a">{plugin}</link></model>')


@pytest.mark.parametrize('plugin', [
    '<plugin name="p" filename="f"/>', "<plugin filename='f'/>", '<plugin\nfilename = "f" />'])
def test_what_has_the_attributes_that_it_needs_is_regular(plugin):
    assert 'a' not in names_left(f'<model name="m"><link name="a">{plugin}</link></model>')


@pytest.mark.parametrize(('pose', 'is_regular'), [
    ('<pose>1 2 3 0 0 -0.5</pose>', True), ('<pose>1 2 3</pose>', False), ('<pose/>', False),
    ('<pose rotation_format="quat_xyzw">1 2 3 0 0 0 1</pose>', False)])
def test_a_pose_of_a_camera(pose, is_regular):
    sensor = f'<sensor name="s" type="camera"><camera name="c">{pose}</camera></sensor>'
    left = names_left(f'<model name="m"><link name="a">{sensor}</link></model>')
    assert ('s' not in left) == is_regular


def test_what_is_kept_are_the_elements_of_the_tree():
    texts = [sdf(content) for content in (
        f'<model name="m">{REGULAR}<link/></model>', f'<model name="n">{REGULAR}</model>')]
    for remainder in remainders_from_tags(tags_from_texts(texts), texts, NEWEST, ONE_PART):
        xmls = etree.fromstring(remainder.text).iter(*KNOWN_TAGS.tags)
        tags = [KNOWN_TAGS.tags[number] for number in remainder.numbers]
        assert tags == [xml.tag for xml in xmls]


def test_a_whole_tree_can_be_had_later():
    document = document_from_text(sdf(f'<model name="m">{REGULAR}</model>'), 'x.sdf')
    assert next(document.root.iter('link'), None) is None
    assert len(list(whole_document(document).root.iter('link'))) == 2


@pytest.mark.parametrize('content', [
    '<![CDATA[ ]]>', '<?p i?>', '<include><uri>x</uri></include>', '<link name="a::b"/>'])
def test_files_that_need_their_whole_trees(content):
    document = document_from_text(sdf(f'<model name="m">{REGULAR}{content}</model>').replace(
        b'<?p i?>', b''), 'x.sdf')
    assert (document.elements is None) == (content != '<?p i?>')


def test_files_that_are_read_together(tmp_path):
    contents = {
        'good': sdf(f'<model name="m">{REGULAR}</model>'),
        'old': sdf(f'<model name="m">{REGULAR}</model>').replace(b'1.9', b'1.4'),
        'with_include': sdf('<model name="m"><include><uri>x</uri></include></model>'),
        'with_character_data': sdf('<model name="m"><![CDATA[ ]]></model>'),
        'of_no_version': sdf('').replace(b'1.9', b'7'),
    }
    for name, content in contents.items():
        (tmp_path / name).write_bytes(content)
    paths = [str(tmp_path / name) for name in (*contents, 'missing')]
    assert [*documents_from_files(paths)] == paths[:2]


def test_one_file_that_is_not_well_formed_does_not_spoil_others(tmp_path):
    contents = {'bad': '<model name="m"><link', 'good': f'<model name="n">{REGULAR}</model>'}
    for name, content in contents.items():
        (tmp_path / f'{name}.sdf').write_bytes(sdf(content))
    includes = ''.join(f'<include><uri>{name}.sdf</uri></include>' for name in contents)
    world = f'<world name="w">{includes}</world>'
    (tmp_path / 'world.sdf').write_bytes(sdf(world))
    with pytest.raises(sdf_pose_bridge.SdfError) as refusal:
        sdf_pose_bridge.load(tmp_path / 'world.sdf')
    assert {error.code for error in refusal.value.errors} == {'FILE_READ'}


def test_each_file_is_read_by_the_rules_of_its_version(tmp_path):
    for name, version in (('old', '1.6'), ('new', '1.9')):
        links = LINK.format('a') + '<link name="b"><pose frame="a">0 0 1 0 0 0</pose></link>'
        (tmp_path / f'{name}.sdf').write_text(
            f'<sdf version="{version}"><model name="{name}">{links}</model></sdf>')
    includes = ''.join(f'<include><uri>{name}.sdf</uri></include>' for name in ('old', 'new'))
    (tmp_path / 'world.sdf').write_bytes(sdf(f'<world name="w">{includes}</world>'))
    scene = sdf_pose_bridge.load(tmp_path / 'world.sdf')
    assert_at(scene, 'old::b', (1, 2, 4))
    assert_at(scene, 'new::b', (0, 0, 1))


@pytest.mark.parametrize(('element', 'has_whole_tree'), [
    ('<plugin name="gz::sim::systems::Physics" filename="f"/>', False),
    ('<plugin\n filename="f" name="gz::sim::systems::Physics"/>', False),
    ('<frame name="f" attached_to="m::l"/>', False),
    ('<plugins name="a::b"/>', True),
    ('<plugin name="p" filename="f"><frame name="a::b"/></plugin>', True),
    ('<plugin name="p" filename="f"/><frame name="a::b"/>', True),
])
def test_only_names_with_a_separator_need_the_whole_tree(element, has_whole_tree):
    text = sdf(f'<world name="w">{element}<model name="m">{REGULAR}</model></world>')
    assert (document_from_text(text, 'file.sdf').elements is None) == has_whole_tree


@pytest.mark.parametrize('ending', ['', '<', '<link>'])
def test_a_text_so_long_that_it_is_checked_beside(ending):
    links = ''.join(LINK.format(f'l_{number}') for number in range(6_000))
    text = model_file(links + ending)
    if ending:
        with pytest.raises(sdf_pose_bridge.SdfError, match='not well-formed'):
            sdf_pose_bridge.load_text(text)
    else:
        assert_at(sdf_pose_bridge.load_text(text), 'm::l_5999', (1, 2, 3))


@pytest.mark.parametrize('size', [50, 200, 1000])
def test_a_long_text_is_looked_at_part_by_part(size, monkeypatch):
    monkeypatch.setattr(regular_part, '_PART', size)
    models = [
        f'<model name="m{i}"><pose>{i} 0 0 0 0 0</pose>\n{REGULAR}</model>\n' for i in range(20)]
    text = sdf(f'<world name="w"><frame name="f"/>{"".join(models)}<frame name="g"/></world>')
    scene = sdf_pose_bridge.load_text(text)
    assert_at(scene, 'm19::b', (20, 2, 3))
    assert scene.lines[scene.index('m19::b')] == 2 + 3 * 19 + 2
    assert scene.lines[scene.index('g')] == 2 + 3 * 20


@pytest.mark.parametrize('name', ['a', ' a '])
def test_names_in_different_parts_are_compared(name, monkeypatch):
    monkeypatch.setattr(regular_part, '_PART', 50)
    links = ''.join(LINK.format(f'l{i}') for i in range(20))
    with pytest.raises(sdf_pose_bridge.SdfError) as refusal:
        sdf_pose_bridge.load_text(
            sdf(f'<model name="m">{LINK.format("a")}{links}{LINK.format(name)}</model>'))
    assert [error.code for error in refusal.value.errors] == ['DUPLICATE_NAME']
