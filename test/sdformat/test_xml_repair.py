# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Text that libsdformat reads although it is not well-formed XML."""

import tracemalloc

from lxml import etree
import pytest

from sdf_pose_bridge.sdformat.xml_repair import repaired


def root_of(text):
    return etree.fromstring(repaired(text).text)


@pytest.mark.parametrize('text', [
    b'<a', b'<a b=c/>', b'<a><b c></b></a>', b'<a/>text', b'<a><?late?></a>', b'<a/><?late?>',
    b'<!-- <a/>', b'<a><![CDATA[</a>',
])
def test_text_that_libsdformat_refuses_is_not_repaired(text):
    assert repaired(text) is None


@pytest.mark.parametrize(('text', 'content'), [
    (b'<a>R&D</a>', 'R&D'),
    (b'<a>&e;</a>', '&e;'),
    (b'<a>&#x41;&lt;</a>', 'A<'),
    (b'<a>]]></a>', ']]>'),
    (b'<a><![CDATA[& --]]></a>', '& --'),
    (b'<a><!-- a -- b --->c</a>', None),
    (b'<a>\xe9</a>', '\u00e9'),
    (b'<?xml version="1.1"?><a>b</a>', 'b'),
    (b' <?xml version="1.0"?><a>b</a>', 'b'),
    (b'before<a>b</a>', 'b'),
    (b'<a>b</a><c/>', 'b'),
])
def test_text_of_the_outermost_element(text, content):
    root = root_of(text)
    assert (root.tag, root.text) == ('a', content)


@pytest.mark.parametrize(('text', 'value'), [
    (b'<a b="c<d"/>', 'c<d'), (b'<a b="c&d"/>', 'c&d'), (b'<a e=""b="c"/>', 'c'),
    (b"<a b='\"'e=\"&\"/>", '"'),
])
def test_value_of_an_attribute(text, value):
    assert root_of(text).get('b') == value


def test_lines_stay_where_they_are():
    root = root_of(b'text\n<!-- \n -- \n --><a>\n&\n<b\nc="<"\n/>\n</a>')
    assert [element.sourceline for element in root.iter('a', 'b')] == [4, 8]


def test_each_sort_of_fault_has_the_line_of_the_first():
    faults = repaired(b'<a>\n&<b c="<"/>\n&<b c="<"/></a>').faults
    assert faults == [
        (2, '"&" is not the beginning of a known entity'), (2, '"<" in the value of an attribute')]


@pytest.mark.parametrize('text', [
    b'<a/>', b'<?xml version="1.0"?>\n<!-- c --><a b="c">d<e/></a>\n', b'\xef\xbb\xbf<a/>',
])
def test_well_formed_text_has_no_faults(text):
    assert repaired(text).faults == []


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
