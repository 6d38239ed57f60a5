# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Parsing XML: broken and hostile files are refused, what libsdformat accepts is accepted."""

from concurrent.futures import ThreadPoolExecutor
import os
import socket

from lxml import etree
import pytest
from sdf_texts import (
    assert_at,
    codes_of,
    fixed_joint,
    LINK,
    link_with,
    model_file,
    names_of,
    only_error,
)

from sdf_pose_bridge import load, load_text, SdfError
from sdf_pose_bridge.errors import FileReadError, LimitError
from sdf_pose_bridge.sdformat.limits import DEFAULT_LIMITS, Limits, Usage
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file, xml_from_bytes
from sdf_pose_bridge.sdformat.xml_tree import text_of

MANY_PREFIXES = LINK + '<undeclared:element/>\n' * 150
"""More errors than libxml2 reports: all of these prefixes are accepted."""


def error_of(content):
    """Parse bytes that are refused; return the error."""
    with pytest.raises(SdfError) as caught:
        xml_from_bytes(content, 'file.sdf')
    return caught.value


def names_in(text):
    return names_of(load_text(text))


# Files that cannot be read

@pytest.mark.parametrize('path', ['none.sdf', '', 'a\0b', 'x' * 1000])
def test_unreadable_file_is_refused(tmp_path, path):
    with pytest.raises(SdfError) as caught:
        bytes_from_file(str(tmp_path / path), Usage())
    assert (caught.value.code, caught.value.file) == ('FILE_READ', str(tmp_path / path))


def test_a_text_instead_of_a_path_is_told():
    with pytest.raises(FileReadError, match=r'which load_text reads$'):
        load('\n<sdf version="1.9"/>')


@pytest.mark.parametrize(('path', 'reason'), [
    ('cel.sdf', r'; did you mean "cell\.sdf"\?$'), ('a.dae', '"git lfs pull" fetches its content'),
    ('pipe', 'not a regular file'), ('/dev/null', 'not a regular file'), ('/', '.'),
    ('/dev/zero', 'robot_description'), ('nothing.sdf', 'No such file or directory$'),
    ('dangling.sdf', 'No such file or directory$'), ('loop.sdf', 'symbolic links$'),
    ('arm.sdf', 'Jinja makes it of "arm.sdf.jinja" beside it$')])
def test_only_regular_files_with_content_are_read(tmp_path, path, reason):
    (tmp_path / 'cell.sdf').touch()
    (tmp_path / 'a.dae').write_text('version https://git-lfs.github.com/spec/v1\noid sha256:0\n')
    os.mkfifo(tmp_path / 'pipe')
    (tmp_path / 'arm.sdf.jinja').touch()
    (tmp_path / 'dangling.sdf').symlink_to('no.sdf')
    (tmp_path / 'loop.sdf').symlink_to('loop.sdf')
    with pytest.raises(FileReadError, match=reason):
        bytes_from_file(str(tmp_path / path), Usage())


@pytest.mark.parametrize('size', [0, 1, 100_000])
def test_pipe_is_read_where_it_is_allowed(size):
    reader, writer = os.pipe()

    def write():
        os.write(writer, b'x' * size)
        os.close(writer)

    with ThreadPoolExecutor() as executor:
        executor.submit(write)
        assert bytes_from_file(f'/dev/fd/{reader}', Usage(), allows_pipe=True) == b'x' * size
    os.close(reader)


def test_too_large_file_is_refused_before_it_is_read(tmp_path):
    with (tmp_path / 'large').open('wb') as file:
        file.truncate(10**12)
    with pytest.raises(LimitError, match=f'the limit bytes_read is {DEFAULT_LIMITS.bytes_read}'):
        bytes_from_file(str(tmp_path / 'large'), Usage())


def test_endless_pipe_is_refused():
    reader, writer = os.pipe()
    os.write(writer, b'x' * 11)
    with pytest.raises(LimitError):
        bytes_from_file(f'/dev/fd/{reader}', Usage(Limits(bytes_read=10)), allows_pipe=True)
    os.close(reader)
    os.close(writer)


@pytest.mark.parametrize('content', [
    b'', b' \n', b'not XML', b'\0\1\2\3' * 100, b'\xff\xfe\x00\xd8', b'{"sdf": 1}',
    b'<sdf version="1.9">', b'<sdf version="1.9"><model name="m"></sdf>',
    b'<sdf version="1.9"><model name="m" name="n"><link name="l"/></model></sdf>',
    b'<sdf version=1.9></sdf>',
    b'<!-- only a comment -->', b'<?xml version="1.0"?>',
], ids=repr)
def test_text_that_is_not_well_formed_is_refused(content):
    assert error_of(content).code == 'FILE_READ'


@pytest.mark.parametrize(('content', 'line'), [
    # What is no XML.
    (b'{\n  "sdf": 1\n}\n', 1), (b'solid part\n facet normal 0 0 1\nendsolid part\n', 1),
    (b'\0\n\1\n', 1),
    # What has no end.
    (b'<sdf version="1.9">\n<model name="m">\n', 2), (b'<sdf version="1.9">\n<!-- ', 2),
    (b'{\n  "sdf": "<sdf>"\n}\n', 3), (b' \n', 1), (b'', 1),
    (b'<sdf version="1.9">\n<model name="m">\n</sdf>', 3),
    (f' \n\n<?xml version="1.0"?>\n<a>{MANY_PREFIXES}<b c="1" c="2"/></a>'.encode(), 154),
], ids=range(10))
def test_error_has_the_file_and_the_line_of_the_fault(content, line):
    error = error_of(content)
    assert (error.file, error.line) == ('file.sdf', line)


@pytest.mark.parametrize('content', [
    '<link name="k"><pose>1 2 3 0 0 0</poze></link>', '<link name="k" name="h"/>',
    '<link name=k/>'])
def test_error_behind_many_undeclared_prefixes_is_reported(content):
    error = only_error('\n' + model_file(f'{MANY_PREFIXES}{content}'))
    assert (error.code, error.line) == ('FILE_READ', 152)


# Hostile files

def only_error_with_document_type(declarations, content=LINK, external=''):
    return only_error(f'<!DOCTYPE sdf {external} [{declarations}]>' + model_file(content))


@pytest.mark.parametrize('declarations', [
    '<!ENTITY e "1 2 3 0 0 0">', '<!ENTITY % p "1">', '<!ENTITY e SYSTEM "file:///etc/passwd">',
    '<!ATTLIST pose degrees CDATA "true">', '<!ATTLIST link name ID #IMPLIED>',
    '<!ELEMENT sdf ANY>', '<!NOTATION n SYSTEM "n">',
    '<!ELEMENT sdf ANY><!ATTLIST pose degrees CDATA "true"><!ENTITY e "1">',
])
@pytest.mark.parametrize('external', ['', 'SYSTEM "sdf.dtd"'])
def test_document_type_with_an_internal_subset_is_refused(declarations, external):
    error = only_error_with_document_type(declarations, external=external)
    assert (error.code, error.line) == ('FILE_READ', 1)
    assert 'document type' in error.message
    assert '\n' not in str(error)


def test_text_of_another_file_is_not_read(tmp_path):
    (tmp_path / 'secret').write_text('1 2 3 0 0 0')
    error = only_error_with_document_type(
        f'<!ENTITY e SYSTEM "{(tmp_path / "secret").as_uri()}">',
        '<link name="l"><pose>&e;</pose></link>')
    assert error.code == 'FILE_READ'


def test_nothing_is_read_from_the_network():
    with socket.create_server(('127.0.0.1', 0)) as server:
        url = f'http://127.0.0.1:{server.getsockname()[1]}/sdf.dtd'
        load_text(f'<!DOCTYPE sdf SYSTEM "{url}">' + model_file(LINK))
        server.setblocking(False)
        with pytest.raises(BlockingIOError):
            server.accept()


@pytest.mark.parametrize(('text', 'fault'), [
    ('<sdf version="1.9">' + '<model name="m">' * 1000 + '</model>' * 1000 + '</sdf>',
     'elements are nested more than 256 deep'),
    (link_with(f'<a>{"<a>" * 300}{"</a>" * 300}</a>'), 'elements are nested more than 256 deep'),
    (link_with(f'<a>{"a" * 10_500_000}</a>'), 'a text or a value is longer than 10 MB'),
    (link_with(f'<a b="{"a" * 10_500_000}"/>'), 'a text or a value is longer than 10 MB'),
    # A search that backtracks would take minutes for these.
    (model_file(LINK) + '<!--' * 20_000, ''),
    (model_file(LINK + '<!-- -- -->' + '<!--' * 20_000), ''),
    (model_file(LINK, attributes='a' * 100_000), ''),
], ids=['models', 'other elements', 'a text', 'a value', 'comments', 'comments and hyphens',
        'an attribute'])
def test_too_deep_or_too_long_content_is_refused(text, fault):
    error = only_error(text)
    assert error.code == 'FILE_READ'
    assert fault in error.message


# Well-formedness that libsdformat does not need

@pytest.mark.parametrize('text', [
    model_file(LINK + '<drake:joint name="x::y"><pose>no</pose></drake:joint>'),
    model_file(LINK + '<a:b:c/>'),
    model_file(LINK, attributes='experimental:x="1"'),
    model_file(LINK, attributes='xmlns:experimental="http://a" experimental:x="1"'),
    model_file(LINK + '<d:link xmlns:d="http://d" name="k"><d:pose>no</d:pose></d:link>'),
    model_file('<x:link name="l"/>' + LINK + '<x:frame name="f"/>'),
    model_file('<x:link xmlns:x="http://x" name="l"/>' + LINK),
    model_file(LINK, attributes='xmlns:a="x y" xmlns:b="" xmlns:xml="c"'),
    model_file(LINK, attributes='xmlns:a="x" xmlns:b="x" a:c="" b:c=""'),
    model_file(LINK + '<x:y><link name="k"/></x:y>'),
    f' \n<?xml version="1.0"?>{model_file(MANY_PREFIXES)}<x/>',
    *(before + model_file(LINK) for before in (
        '<?x y?>', '<!DOCTYPE sdf>', '<!DOCTYPE sdf SYSTEM "sdf.dtd">',
        '<!DOCTYPE sdf PUBLIC "sdf" "sdf.dtd">', '<?xml version="1.0"?>\n<!DOCTYPE sdf>',
        '<!DOCTYPE something>')),
    b'\xef\xbb\xbf' + model_file(LINK).encode(),
])
def test_what_is_not_sdformat_is_skipped(text):
    assert names_in(text) == ['m', 'm::l']


@pytest.mark.parametrize('text', [
    link_with('<pose>1 2 3 0 0 0</pose>').replace('<sdf', '<sdf xmlns="http://sdformat.org"'),
    link_with('<pose>1 2 3 0 0 0</pose>').replace('<model', '<model xmlns="urn:x"'),
])
def test_default_namespace_is_ignored(text):
    assert_at(load_text(text), 'm::l', (1, 2, 3))


@pytest.mark.parametrize('text', [
    '<sdf xmlns="u" xmlns:a = "v"><a:b\n\txmlns:c=\'w\' c:d="" xmlns\n="u"/><e/></sdf>',
    '<x:sdf xmlns:x="u"><!-- <a xmlns="b"> --><x:a xmlns:x="v" b="<c xmlns=d>"/></x:sdf>',
])
def test_no_element_has_a_name_space(text):
    root = xml_from_bytes(text.encode(), 'file.sdf').root
    assert {element.prefix for element in root.iter(etree.Element)} == {None}
    assert not any(element.nsmap for element in root.iter(etree.Element))


def test_what_looks_like_a_name_space_stays():
    name = ' xmlns:a=b xmlns='
    text = model_file(f'<link name="{name}"/><!-- <a xmlns="b"> -->').replace(
        '<sdf', '<sdf xmlns:x="u"')
    assert names_in(text) == ['m', f'm::{name.strip()}']


@pytest.mark.parametrize('rest', ['<sdf version="1.9"/>', '<a/><b/>', '</a>'])
def test_content_after_the_outermost_element_is_ignored_with_a_warning(rest):
    scene = load_text(model_file(LINK) + rest)
    assert names_of(scene) == ['m', 'm::l']
    assert 'not well-formed' in scene.warnings[0].message


def test_white_space_before_the_declaration_is_accepted_with_a_warning():
    scene = load_text('\n <?xml version="1.0"?>' + model_file(LINK))
    assert names_of(scene) == ['m', 'm::l']
    assert scene.warnings[0].place.line == 2


def test_processing_instruction_in_an_element_does_not_hide_its_text():
    # libsdformat refuses such a file.
    text = link_with('<pose><?x y?>1 2 3 0 0 0</pose>')
    assert 'processing instruction' in only_error(text).message


@pytest.mark.parametrize('attributes', ['\nnot_defined="1"', ' alias="a>b"\nnot_defined="1"'])
@pytest.mark.parametrize('comment', ['', '<!-- < -->', '<![CDATA[<]]>'])
def test_tag_over_several_lines_has_the_line_of_its_beginning(attributes, comment):
    scene = load_text(model_file(f'{comment}\n<link name="l"{attributes}/>'))
    assert {warning.place.line for warning in scene.warnings} == {2}


# Comments

@pytest.mark.parametrize(('before', 'inside'), [
    ('', ''), ('', MANY_PREFIXES), ('<?x <!-- ?>', '')])
@pytest.mark.parametrize('comment', [
    '<!-- a -- b -->', '<!-- a --->', '<!------- a ------->', '<!------ a ------>', '<!----->',
    '<!-- a\n---\nb --->', '<!--> a --->', '<!-- <!-- a -->', '<!-- <?a -- ?> -->',
    '<!-- <![CDATA[ -- ]]> -->',
])
def test_comment_ends_where_it_ends_in_libsdformat(before, inside, comment):
    text = model_file(f'{inside}{comment}\n<link name="a"/>{comment}<link name="b"/>')
    assert names_in(before + text)[-2:] == ['m::a', 'm::b']


def test_hyphens_in_one_comment_give_a_warning():
    (warning,) = load_text(model_file('<!-- a ---- b --->' + LINK)).warnings
    assert warning.message == 'this is not well-formed XML: a comment holds two hyphens in a row'


@pytest.mark.parametrize('text', ['1-2', '<!--1-2-->'])
def test_hyphens_outside_of_comments_are_kept(text):
    root = xml_from_bytes(f'<a><![CDATA[{text}]]><!-- - --- --></a>'.encode(), 'f').root
    assert text_of(root) == text


def test_hyphens_in_comments_of_utf_16_give_a_warning():
    text = '<?xml version="1.0" encoding="UTF-16"?>' + model_file('<!-- a ---><!-- -->' + LINK)
    assert len(load_text(text.encode('UTF-16')).warnings) == 1


# Encodings

def test_default_encoding_is_utf_8():
    assert names_in(model_file('<link name="größe 手"/>').encode()) == ['m', 'm::größe 手']


@pytest.mark.parametrize('encoding', ['utf-8', 'ISO-8859-1', 'UTF-16'])
def test_declared_encoding_does_not_matter_for_decoded_text(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?>' + model_file('<link name="größe"/>')
    assert names_in(text) == ['m', 'm::größe']


# Characters that XML does not have

@pytest.mark.parametrize('text', [
    '&#1;', '&#xD800;', '&#55296;', '&#xFFFF;', '&#x110000;', '&#1114112;',
    '&#99999999999;', '\x01', '\ufffe', '<!-- \x01 -->', '<!-- \ufffe -->', '<![CDATA[\x01]]>',
])
def test_characters_that_xml_does_not_have_are_replaced_in_text(text):
    scene = load_text(link_with(text))
    assert scene.names[-1] == 'm::l'
    assert 'is no character of XML; it is replaced' in scene.warnings[0].message


@pytest.mark.parametrize(('text', 'read'), [
    ('&#;', ''), ('&#0;x', ''), ('&#x0;', ''), ('&#x7FFFFFFF;', ''), ('&#xFFFF;', '\ufffd'),
    ('&#x110000;', '\ufffd'), ('\x01', '\ufffd'), ('\ufffe', '\ufffd')])
def test_characters_that_xml_does_not_have_are_read_in_names_and_references(text, read):
    scene = load_text(model_file(
        f'<link name="l{text}"/><frame name="f" attached_to="l{text}"/>'
        + fixed_joint('j', 'world', f'l{text}')))
    assert names_of(scene) == ['m', f'm::l{read}', 'm::f', 'm::j']
    assert 'U+0000' in scene.warnings[0].message or 'no character' in scene.warnings[0].message


@pytest.mark.parametrize('text', ['&#65;', '&#x1F916;', '&#x0000000041;', '&#10;', '\t'])
def test_other_characters_are_read(text):
    assert not load_text(link_with(text)).warnings


# The declaration

@pytest.mark.parametrize('before', [
    'abc ', '<!DOCTYPE sdf>', '<!-- c -->', '<![CDATA[x]]>', 'a\n'])
def test_declaration_after_something_else_is_refused(before):
    assert codes_of(f'{before}<?xml version="1.0"?>{link_with("")}') == ['FILE_READ']


@pytest.mark.parametrize('before', ['\n', '\ufeff ', '<?xml version="1.0"?>'])
def test_declaration_after_white_space_or_another_has_a_warning(before):
    scene = load_text(f'{before}<?xml version="1.0"?>{link_with("")}')
    assert 'the declaration is not at the beginning' in scene.warnings[0].message


# Names

@pytest.mark.parametrize(('name', 'what'), [
    ('"a\nb"', 'a line break'), ("'a\tb'", 'a tab'), ('"a\r\nb"', 'a line break')])
def test_name_with_a_break_has_a_warning(name, what):
    scene = load_text(f'<sdf version="1.9"><model name="m">\n<link name={name}/></model></sdf>')
    assert scene.names[-1] == 'm::a b'
    warning, = scene.warnings
    assert f'holds {what}, which XML reads as a blank' in warning.message
    assert warning.place.line == 2


@pytest.mark.parametrize('link', [
    '<link name="\nab\t"/>', '<link\n\tname="a b"/>',
    '<link name="ab"/><plugin name="a\tb" filename="f"/>'])
def test_name_without_a_break_in_it_has_no_warning(link):
    assert not load_text(f'<sdf version="1.9"><model name="m">{link}</model></sdf>').warnings


@pytest.mark.parametrize(('text', 'fault', 'line'), [
    ('<sdf version="1.9">\n<model name="m">\n<link>\n</model></sdf>',
     '</model> cannot end <link> of line 3; </link> is missing or misspelt', 4),
    ('<sdf version="1.9">\n<model name="m">\n', 'the file ends inside <model> of line 2', 2),
    ('<sdf version=1.9/>', 'the value of an attribute is not in quotation marks', 1),
    ('<sdf version="1.9"><a b="c" b="d"/></sdf>', 'the attribute b is given twice', 1),
    ('<sdf version="1.9"><a b="c><d/></a></sdf>', 'a quotation mark before it may be missing', 1),
])
def test_fault_is_told_in_words_of_the_author(text, fault, line):
    error = only_error(text)
    assert fault in error.message
    assert error.line == line
