# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading one file: what is hostile or broken is refused, what tinyxml2 takes is taken."""

import socket

import pytest
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import text_of
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document_reading import document_from_text
from sdf_texts import assert_at
from sdf_texts import codes_of
from sdf_texts import errors_of
from sdf_texts import model_file
from sdf_texts import names_of
from sdf_texts import only_error

import sdf_pose_bridge
from sdf_pose_bridge.sdformat.xml_file import fault_beyond_log

LINK = '<link name="l"/>'
POSED_LINK = '<link name="l"><pose>1 2 3 0 0 0</pose></link>'
BILLION = ''.join(
    f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' if i else '<!ENTITY e0 "1 2 3 0 0 0 ">'
    for i in range(12))




def pose_text(content):
    """Return what is read of a pose with the given content."""
    return text_of(document_from_text(
        f'<sdf version="1.9"><pose>{content}</pose></sdf>'.encode(), 'f').root[0])


# Files that cannot be read

def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(sdf_pose_bridge.SdfError) as caught:
        sdf_pose_bridge.load(tmp_path / 'none.sdf')
    assert caught.value.code == 'FILE_READ'
    assert caught.value.file == str(tmp_path / 'none.sdf')


def test_a_directory_is_no_file(tmp_path):
    with pytest.raises(sdf_pose_bridge.SdfError) as caught:
        sdf_pose_bridge.load(tmp_path)
    assert caught.value.code == 'FILE_READ'


@pytest.mark.parametrize('content', [
    b'', b' \n', b'not XML', b'\0\1\2\3' * 100, b'\xff\xfe\x00\xd8', b'{"sdf": 1}',
    b'<sdf version="1.9">', b'<sdf version="1.9"><model name="m"></sdf>',
    b'<sdf version="1.9"><model name="m" name="n"><link name="l"/></model></sdf>',
    b'<sdf version=1.9></sdf>', b'<sdf version="1.9">\xff</sdf>',
    b'<!-- only a comment -->', b'<?xml version="1.0"?>',
], ids=repr)
def test_what_is_not_well_formed_is_refused(content):
    with pytest.raises(sdf_pose_bridge.SdfError) as caught:
        sdf_pose_bridge.load_text(content)
    assert caught.value.code == 'FILE_READ'


MANY_PREFIXES = LINK + '<undeclared:element/>\n' * 150


@pytest.mark.parametrize('content', [
    '<link name="k"><pose>1 2 3 0 0 0</poze></link>', '<link name="k" name="h"/>', '&undeclared;',
    '<link name=k/>'])
def test_faults_behind_many_undeclared_prefixes_are_told(content):
    error = only_error('\n' + model_file(f'{MANY_PREFIXES}{content}'))
    assert (error.code, error.line) == ('FILE_READ', 152)


def test_many_undeclared_prefixes_by_themselves_do_no_harm():
    scene = sdf_pose_bridge.load_text(f' \n<?xml version="1.0"?>{model_file(MANY_PREFIXES)}x')
    assert names_of(scene) == ['m', 'm::l']


@pytest.mark.parametrize('encoding', ['ISO-8859-1', 'UTF-16', 'EUC-JP'])
def test_many_undeclared_prefixes_in_another_encoding_do_no_harm(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?>{model_file(MANY_PREFIXES)}'
    assert names_of(sdf_pose_bridge.load_text(text.encode(encoding))) == ['m', 'm::l']


def test_comments_with_hyphens_behind_many_undeclared_prefixes():
    scene = sdf_pose_bridge.load_text(
        model_file(MANY_PREFIXES + '<!-- a ---><link name="k"/><!-- -->'))
    assert names_of(scene) == ['m', 'm::l', 'm::k']


@pytest.mark.parametrize(('text', 'line'), [
    (b'<a>\n</b>', 2), (b' \n\n<?xml version="1.0"?>\n<a b="1" b="2"/>', 4), (b'<a>', 1)])
def test_the_other_parser_finds_the_line_of_a_fault(text, line):
    assert fault_beyond_log(text).line == line


@pytest.mark.parametrize('text', [
    b'<a/>', b'\n<?xml version="1.0"?><a:b/>', b'<a/>x', b'<a/><a/>',
    b'<?xml version="1.0" encoding="unheard-of"?><a>',
    b'<?xml version="1.0" encoding="euc-jp"?><a>'])
def test_the_other_parser_forgives(text):
    assert fault_beyond_log(text) is None


def test_the_line_of_broken_xml_is_told():
    error = only_error('<sdf version="1.9">\n<model name="m">\n</sdf>')
    assert (error.file, error.line) == ('file.sdf', 3)


@pytest.mark.parametrize(('text', 'code'), [
    ('<sdf/>', 'FILE_READ'),
    ('<sdf Version="1.9"/>', 'FILE_READ'),
    ('<gazebo version="1.9"/>', 'PARSING_ERROR'),
    ('<model name="m"/>', 'PARSING_ERROR'),
    ('<SDF version="1.9"/>', 'PARSING_ERROR'),
    ('<robot name="r"/>', 'PARSING_ERROR'),
])
def test_the_outermost_element(text, code):
    assert codes_of(text) == [code]


def test_urdf_is_called_by_its_name():
    assert 'URDF' in only_error('<robot name="r"/>').message


def test_a_missing_version_is_told():
    assert 'version' in only_error('<sdf/>').message


# Hostile files

def refused_with_entity(declaration, content):
    return codes_of(f'<!DOCTYPE sdf [{declaration}]>' + model_file(content))


def test_the_text_of_another_file_is_not_taken(tmp_path):
    (tmp_path / 'secret').write_text('1 2 3 0 0 0')
    assert refused_with_entity(
        f'<!ENTITY e SYSTEM "{(tmp_path / "secret").as_uri()}">',
        '<link name="l"><pose>&e;</pose></link>')


def test_what_an_entity_names_is_not_even_opened(tmp_path):
    # If it were, the file that is missing would be what the message tells of.
    text = f'<!DOCTYPE sdf [<!ENTITY e SYSTEM "{(tmp_path / "none").as_uri()}">]>' + model_file(
        '<link name="l"><pose>&e;</pose></link>')
    assert 'declares entities' in only_error(text).message


def test_an_entity_in_a_pose_is_not_passed_over():
    assert refused_with_entity(
        '<!ENTITY e "1 2 3 0 0 0">', '<link name="l"><pose>&e;</pose></link>')


def test_an_undeclared_entity_is_refused():
    assert codes_of(model_file('<link name="&e;"/>')) == ['FILE_READ']


@pytest.mark.parametrize('content', [
    '<link name="l"><pose>&e11;</pose></link>', '<link name="&e11;"/>',
])
def test_an_expansion_bomb_does_not_go_off(content):
    assert refused_with_entity(BILLION, content)


def test_entities_that_hold_one_another_end():
    assert refused_with_entity(
        '<!ENTITY a "&b;"><!ENTITY b "&a;">', '<link name="&a;"/>')


def test_nothing_is_asked_for_over_the_network():
    with socket.create_server(('127.0.0.1', 0)) as server:
        url = f'http://127.0.0.1:{server.getsockname()[1]}/sdf.dtd'
        text = f'<!DOCTYPE sdf SYSTEM "{url}">' + model_file(LINK)
        sdf_pose_bridge.load_text(text)
        server.setblocking(False)
        with pytest.raises(BlockingIOError):
            server.accept()


@pytest.mark.parametrize('content', [
    '<model name="m">' * 1000 + '</model>' * 1000,
    f'<model name="m"><link name="l"><a>{"<a>" * 300}{"</a>" * 300}</a></link></model>',
    f'<model name="m"><link name="l"><a>{"a" * 10_500_000}</a></link></model>',
], ids=['models', 'other elements', 'a text'])
def test_bottomless_files_are_refused(content):
    assert codes_of(f'<sdf version="1.9">{content}</sdf>') == ['FILE_READ']


# What looked at the rest of a run from each place in it took minutes for the next two.

@pytest.mark.parametrize('text', [
    model_file(LINK) + '<!--' * 20_000, model_file(LINK + '<!-- -- -->' + '<!--' * 20_000),
    model_file(LINK, attributes='a' * 100_000),
], ids=['comments', 'comments and hyphens', 'an attribute'])
def test_long_runs_of_what_is_not_well_formed_are_refused(text):
    assert codes_of(text) == ['FILE_READ']


@pytest.mark.parametrize('text', [
    model_file(f'<link name="l"><inertial><mass>{" " * 100_000}</mass></inertial></link>'),
    model_file('<link name="l"/><joint name="j" type="fixed"><parent>world</parent>'
               f'<child>l</child><axis><xyz>{" " * 100_000}1 0 0</xyz></axis></joint>'),
], ids=['a number', 'an axis'])
def test_long_runs_of_white_space_are_read(text):
    assert 'm::l' in names_of(sdf_pose_bridge.load_text(text))


def test_deep_models_are_read():
    depth = 200
    text = ('<sdf version="1.9">'
            + '<model name="m"><pose>0 0 1 0 0 0</pose>' * depth + LINK
            + '</model>' * depth + '</sdf>')
    assert_at(sdf_pose_bridge.load_text(text), '::'.join(['m'] * depth + ['l']), (0, 0, depth))


def test_a_text_too_long_to_be_meant_is_refused():
    error = only_error(model_file(
        f'<link name="l"><pose>{"1" * 2_000_000} 0 0 0 0 0</pose></link>'))
    assert len(error.message) < 500


# What tinyxml2 takes and lxml minds

@pytest.mark.parametrize('text', [
    model_file(LINK + '<drake:joint name="x::y"><pose>no</pose></drake:joint>'),
    model_file(LINK + '<a:b:c/>'),
    model_file(LINK, attributes='experimental:x="1"'),
    model_file(LINK, attributes='xmlns:experimental="http://a" experimental:x="1"'),
    model_file(LINK + '<d:link xmlns:d="http://d" name="k"><d:pose>no</d:pose></d:link>'),
])
def test_prefixes_are_passed_over(text):
    assert names_of(sdf_pose_bridge.load_text(text)) == ['m', 'm::l']


@pytest.mark.parametrize('text', [
    model_file('<x:link name="l"/>' + LINK + '<x:frame name="f"/>'),
    model_file('<x:link xmlns:x="http://x" name="l"/>' + LINK),
    model_file(LINK + '<x:y><link name="k"/></x:y>'),
])
def test_elements_with_a_prefix_are_other_elements(text):
    assert names_of(sdf_pose_bridge.load_text(text)) == ['m', 'm::l']


@pytest.mark.parametrize('text', [
    model_file(POSED_LINK).replace('<sdf', '<sdf xmlns="http://sdformat.org"'),
    model_file(POSED_LINK, attributes='xmlns="urn:x"'),
])
def test_a_default_namespace_changes_nothing(text):
    assert_at(sdf_pose_bridge.load_text(text), 'm::l', (1, 2, 3))


def test_a_prefix_of_the_outermost_element_makes_it_another():
    assert codes_of('<x:sdf xmlns:x="urn:x" version="1.9"/>') == ['PARSING_ERROR']


def test_what_follows_the_root_is_not_read():
    scene = sdf_pose_bridge.load_text(model_file(LINK) + '<sdf version="1.9"/>')
    assert names_of(scene) == ['m', 'm::l']


@pytest.mark.parametrize('comment', [
    '<!-- a -- b -->', '<!-- a --->', '<!------- a ------->', '<!------ a ------>', '<!----->',
    '<!-- a\n---\nb --->', '<!--> a --->', '<!-- <!-- a -->', '<!-- <?a -- ?> -->',
    '<!-- <![CDATA[ -- ]]> -->',
])
def test_comments_end_where_libsdformat_lets_them_end(comment):
    scene = sdf_pose_bridge.load_text(
        model_file(f'{comment}\n<link name="a"/>{comment}<link name="b"/>'))
    assert names_of(scene) == ['m', 'm::a', 'm::b']


def test_hyphens_in_comments_are_told_once():
    scene = sdf_pose_bridge.load_text(
        model_file('\n<!-- fine -->\n<!--- a --->' + LINK + '<!-- b --->\n'))
    (warning,) = scene.warnings
    assert (warning.message, warning.place.line) == (
        'this is not well-formed XML: 2 comments hold two hyphens in a row', 3)


def test_hyphens_in_one_comment_are_told():
    (warning,) = sdf_pose_bridge.load_text(model_file('<!-- a ---- b --->' + LINK)).warnings
    assert warning.message == 'this is not well-formed XML: a comment holds two hyphens in a row'


@pytest.mark.parametrize('verbatim', ['<![CDATA[{}]]>', '<![CDATA[<!--{}-->]]>'])
def test_only_hyphens_in_comments_are_passed_over(verbatim):
    assert pose_text(verbatim.format('1-2') + '<!-- - --- -->') == (
        verbatim.format('1-2').removeprefix('<![CDATA[').removesuffix(']]>'))


def test_a_comment_in_a_processing_instruction_is_none():
    scene = sdf_pose_bridge.load_text(
        '<?x <!-- ?>' + model_file('<!-- a ---><link name="a"/><!-- -->'))
    assert names_of(scene) == ['m', 'm::a']


def test_hyphens_in_comments_of_utf_16_are_refused():
    text = '<?xml version="1.0" encoding="UTF-16"?>' + model_file('<!-- a ---><!-- -->' + LINK)
    with pytest.raises(sdf_pose_bridge.SdfError) as caught:
        sdf_pose_bridge.load_text(text.encode('UTF-16'))
    assert caught.value.code == 'FILE_READ'


def test_a_document_type_by_itself_does_no_harm():
    scene = sdf_pose_bridge.load_text('<!DOCTYPE sdf>' + model_file(LINK))
    assert names_of(scene) == ['m', 'm::l']


# Encodings

def test_a_byte_order_mark_is_no_content():
    scene = sdf_pose_bridge.load_text(b'\xef\xbb\xbf' + model_file(LINK).encode())
    assert names_of(scene) == ['m', 'm::l']


def test_names_are_utf_8_unless_said_otherwise():
    scene = sdf_pose_bridge.load_text(model_file('<link name="größe 手"/>').encode())
    assert names_of(scene) == ['m', 'm::größe 手']


@pytest.mark.parametrize('encoding', ['utf-8', 'ISO-8859-1', 'UTF-16'])
def test_a_file_says_its_encoding(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?>' + model_file('<link name="größe"/>')
    scene = sdf_pose_bridge.load_text(text.encode(encoding))
    assert names_of(scene) == ['m', 'm::größe']


@pytest.mark.parametrize('encoding', ['utf-8', 'ISO-8859-1', 'UTF-16'])
def test_text_that_is_decoded_already_is_not_decoded_again(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?>' + model_file('<link name="größe"/>')
    assert names_of(sdf_pose_bridge.load_text(text)) == ['m', 'm::größe']


# Character data

@pytest.mark.parametrize(('content', 'text'), [
    ('1 2', '1 2'),
    ('<!-- c -->1 2', '1 2'),
    (' \n<!-- c --> <!-- d -->1 2', '1 2'),
    ('1 <!-- c -->2', '1 '),
    ('1 <x/>2', '1 '),
    ('<x/>1 2', ''),
    ('<!-- c --><x/>1 2', ''),
    ('<x/><!-- c -->1 2', ''),
    ('<![CDATA[1 2]]>', '1 2'),
    ('1&#32;2', '1 2'),
    ('', ''),
    (' \n ', ''),
])
def test_the_first_run_of_text_counts(content, text):
    assert pose_text(content) == text


def test_a_processing_instruction_does_not_hide_a_pose():
    # libsdformat refuses the file; what must not happen is that the pose is taken for empty.
    text = model_file('<link name="l"><pose><?x y?>1 2 3 0 0 0</pose></link>')
    try:
        scene = sdf_pose_bridge.load_text(text)
    except sdf_pose_bridge.SdfError:
        return
    assert_at(scene, 'm::l', (1, 2, 3))


def test_a_value_is_stripped_of_ascii_white_space_only():
    root = document_from_text('<sdf version="1.9"><a>\t\u00a0x \n</a></sdf>'.encode(), 'f').root
    assert value_of(root[0]) == '\u00a0x'


@pytest.mark.parametrize('text', ['true', 'True', 'TRUE', '1', ' true\n'])
def test_true(text):
    assert boolean_from_text(text) is True


@pytest.mark.parametrize('text', ['false', 'False', 'FALSE', '0', '\t0 '])
def test_false(text):
    assert boolean_from_text(text) is False


@pytest.mark.parametrize('text', ['yes', 'no', 't', '2', '-1', '01', '1.0', 'tru e', '\u0661'])
def test_what_is_neither_true_nor_false(text):
    assert boolean_from_text(text) is None


@pytest.mark.parametrize('version', [
    '', '1.0', '1.1', '1.13', '2.0', '1', '1.6.0', ' 1.9 ', '1.9 ', '1.09', 'one', '1.x', '-1.9',
    '1,9', '\u0661.9', '1.' + '9' * 5000,
])
def test_versions_that_there_are_none_of(version):
    assert errors_of(f'<sdf version="{version}">{LINK}</sdf>')[0].code == 'CONVERSION_ERROR'


@pytest.mark.parametrize('minor', range(2, 13))
def test_versions_that_can_be_read(minor):
    scene = sdf_pose_bridge.load_text(model_file(LINK, version=f'1.{minor}'))
    assert names_of(scene) == ['m', 'm::l']
