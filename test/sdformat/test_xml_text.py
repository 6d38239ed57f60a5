# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Encodings, and text that libsdformat reads although it is not well-formed XML."""

import codecs
import tracemalloc

from lxml import etree
import pytest
from sdf_texts import LINK, model_file, names_of

from sdf_pose_bridge import load_text, SdfError
from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.sdformat.xml_text import repaired, text_from_bytes


def root_of(text):
    return etree.fromstring(repaired(text)[0])


@pytest.mark.parametrize('text', [
    b'<a', b'<a b=c/>', b'<a><b c></b></a>', b'<a/>text', b'<a><?late?></a>', b'<a/><?late?>',
    b'<!-- <a/>', b'<a><![CDATA[</a>', b'<a/><b>', b'<a/><b></c>', b'<a/><b><c></b></c>',
    b'<a/><?late?></b>', b'<a></ a>', b'<a/><sdf/>text',
])
def test_text_that_libsdformat_refuses_is_not_repaired(text):
    assert repaired(text) is None


@pytest.mark.parametrize(('text', 'content'), [
    (b'<a>R&D</a>', 'R&D'),
    (b'<a>&e;</a>', '&e;'),
    (b'<a>&#x41;&lt;</a>', 'A<'),
    (b'<a>]]></a>', ']]>'),
    (b'<a>1\v2\f3&#12;4</a>', '1 2 3 4'),
    (b'<a><![CDATA[1\v2]]></a>', '1 2'),
    (b'<a><![CDATA[& --]]></a>', '& --'),
    (b'<a><!-- a -- b --->c</a>', None),
    (b'<a>\xe9</a>', '\u00e9'),
    (b'<?xml version="1.1"?><a>b</a>', 'b'),
    (b' <?xml version="1.0"?><a>b</a>', 'b'),
    (b'before<a>b</a>', 'b'),
    (b'<a>b</a><c/>', 'b'),
    (b'<a>b</a><c><d>e</d></c>', 'b'),
    (b'<a>b</a></c> --> <a <<', 'b'),
    (b'<a>b</a>text<c></c></a>&<?late?>', 'b'),
    (b'<a>b< /a>', 'b'),
    (b'<\f\na>b<\v/a>', 'b'),
    (b'<a>b&#;c</a>', 'b'),
])
def test_text_of_the_outermost_element(text, content):
    root = root_of(text)
    assert (root.tag, root.text) == ('a', content)


@pytest.mark.parametrize(('text', 'tag', 'line'), [
    (b'<a>b</a>\n<sdf/>', 'sdf', 2), (b'<robot/>\n<a/>\n<sdf/>', 'sdf', 3),
    (b'<a/>\n<robot/><a/>', 'robot', 2), (b'<sdf/>\n<robot/><sdf/>', 'sdf', 1),
    (b'<a><sdf/></a>\n<b/>', 'a', 1), (b'<!DOCTYPE a>\n<a/><sdf/>', 'sdf', 2),
])
def test_outermost_element_that_is_read(text, tag, line):
    root = root_of(text)
    assert (root.tag, root.sourceline) == (tag, line)
    assert [fault for _, fault in repaired(text)[1]] == ['elements beside the outermost element']


def test_an_element_that_is_not_read_is_well_formed_too():
    with pytest.raises(etree.XMLSyntaxError, match='mismatch'):
        root_of(b'<a><b></a></b><sdf/>')


@pytest.mark.parametrize(('text', 'value'), [
    (b'<a b="c<d"/>', 'c<d'), (b'<a b="c&d"/>', 'c&d'), (b'<a e=""b="c"/>', 'c'),
    (b"<a b='\"'e=\"&\"/>", '"'),
    (b'<a b="c&#0;d"/>', 'c'), (b'<a b="&#xFFFF;\1"/>', '\ufffd' * 2),
    (b'<a b="c&#x7FFFFFFF;"/>', 'c'),
])
def test_value_of_an_attribute(text, value):
    assert root_of(text).get('b') == value


def test_lines_stay_where_they_are():
    root = root_of(b'text\n<!-- \n -- \n --><a>\n&\n<b\nc="<"\n/>\n</a>')
    assert [element.sourceline for element in root.iter('a', 'b')] == [4, 8]


def test_each_sort_of_fault_has_the_line_of_the_first():
    faults = repaired(b'<a>\n&<b c="<"/>\n&<b c="<"/></a>')[1]
    assert faults == [
        (2, '"&" is not the beginning of a known entity'), (2, '"<" in the value of an attribute')]


@pytest.mark.parametrize('text', [
    b'<a/>', b'<?xml version="1.0"?>\n<!-- c --><a b="c">d<e/></a>\n', b'\xef\xbb\xbf<a/>',
])
def test_well_formed_text_has_no_faults(text):
    assert repaired(text)[1] == []


@pytest.mark.parametrize('attribute', [b'a="1" ', b'a="1"'])
def test_tag_that_does_not_end_takes_little_memory(attribute):
    text = b'<a ' + attribute * 10_000
    tracemalloc.start()
    try:
        assert repaired(text) is None
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 10 * len(text)


NAME = 'größe'


def declared(encoding, content='<link name="größe"/>'):
    return f'<?xml version="1.0" encoding="{encoding}"?>' + model_file(content)


@pytest.mark.parametrize('encoding', [
    'utf-8', 'UTF8', 'ISO-8859-1', 'latin-1', 'iso-8859-15', 'windows-1252', 'UTF-16', 'UTF-32'])
def test_text_is_decoded_from_the_encoding_that_it_declares(encoding):
    text = declared(encoding)
    scene = load_text(text.encode(encoding))
    assert names_of(scene) == ['m', f'm::{NAME}']
    assert scene.warnings == ()


@pytest.mark.parametrize('encoding', ['utf-16-le', 'utf-16-be', 'utf-32-le', 'utf-32-be'])
def test_two_and_four_bytes_are_known_without_a_byte_order_mark(encoding):
    assert text_from_bytes(model_file(NAME).encode(encoding), 'f') == (
        model_file(NAME).encode(), encoding, [])


@pytest.mark.parametrize('encoding', [
    'punycode', 'undefined', 'UTF-7', 'idna', 'unicode_escape', 'rot13', 'zlib', 'EUC-JP', 'cp037',
    'utf-8-sig'])
def test_other_encodings_are_refused_by_name(encoding):
    with pytest.raises(FileReadError, match=f'"{encoding}" is not supported'):
        text_from_bytes(declared(encoding).encode(), 'f')


@pytest.mark.parametrize('text', [
    b'+ADwAIQ-DOCTYPE sdf +AFsAPAAh-ENTITY a "b"+AD4AXQA+-' + model_file(LINK).encode(),
    model_file('<link name="l+ADoAOg-x"/>').encode()])
def test_nothing_is_hidden_by_an_encoding(text):
    with pytest.raises(SdfError, match='UTF-7'):
        load_text(b'<?xml version="1.0" encoding="UTF-7"?>' + text)


@pytest.mark.parametrize('encoding', ['none', 'utf-16', 'UTF-32', 'mbcs'])
def test_text_that_is_not_in_its_encoding_is_read_as_utf_8(encoding):
    scene = load_text(declared(encoding).encode())
    assert names_of(scene) == ['m', f'm::{NAME}']
    assert encoding in scene.warnings[0].message


@pytest.mark.parametrize('content', [
    b'\x81', codecs.BOM_UTF16_LE + b'\0\xd8', codecs.BOM_UTF32_BE + b'\xff' * 4,
    codecs.BOM_UTF16_BE + b'a', b'\0<\0'])
def test_bytes_that_cannot_be_decoded_are_an_error_of_the_file(content):
    with pytest.raises(SdfError):
        load_text(declared('windows-1252', '').encode() + content
                  if content == b'\x81' else content)


def test_declarations_in_a_comment_are_no_document_type():
    comment = f'<!-- {"<!DOCTYPE" * 12_000} -->'
    text = '<!DOCTYPE sdf>' + model_file(LINK + comment)
    assert names_of(load_text(text)) == ['m', 'm::l']


@pytest.mark.parametrize('text', [
    '<!DOCTYPE sdf [<!ENTITY e "f">]>', '<!-- > --><?a b?>\n<!DOCTYPE sdf SYSTEM "a>" []>',
    "<!DOCTYPE sdf SYSTEM ']' [ ]>", '&<!DOCTYPE sdf []>'])
@pytest.mark.parametrize('encoding', ['utf-8', 'utf-16', 'utf-32'])
def test_declarations_of_a_document_type_are_refused(text, encoding):
    with pytest.raises(SdfError, match='declarations of its own'):
        load_text((text + model_file(LINK)).encode(encoding))
