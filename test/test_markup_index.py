# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Elements found in text are those of the tree, however the text is written."""

from lxml import etree
import numpy as np
import pytest

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import text_of
from sdf_pose_bridge.document_reading import document_from_text
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.markup import markup_from_texts
from sdf_pose_bridge.markup_index import index_of_document
from sdf_pose_bridge.markup_index import written_elements
from sdf_pose_bridge.tag_search import COMMENT

TAGS = KNOWN_TAGS.tags
TEXTS = {
    'plain': '<model name="m"><link name="l"><pose>1 2</pose></link></model>',
    'empty elements': '<model name="m"><link name="l"/><link name="k"><pose/></link></model>',
    'lines': '\n<model\n name="m"\n\n>\n<link\tname="l"\r\n><pose>1\n2</pose\n></link\t></model>',
    'comment with tags': '<!-- <link name="x"> > < --><model name="m"><!--\n--><link/></model>',
    'comment in a value': '<model name="m"><pose>1 <!-- <pose> --> 2</pose></model>',
    'bracket in an attribute': '<model name="a>b"><link name="/>"/><link name="l"/></model>',
    'bracket in a value': '<model name="m"><pose>1 > 2</pose><link/></model>',
    'character data': '<model name="m"><pose><![CDATA[1 <link> 2]]></pose><link/></model>',
    'other quotes': "<model name='m'><link kind='\"' name=\"l\"/></model>",
    'other tags between': '<plugin><model><x><link/></x></model></plugin><model><pose/></model>',
    'letters': '<model name="größe"><link name="\U0001f916"><pose>é</pose></link></model>',
    'references': '<model name="a&amp;b"><pose>1 &lt; 2</pose></model>',
}


def found_in(text):
    document = document_from_text(text, 'x.sdf')
    return document.root, written_elements(document).markup


def sdf(content):
    return f'<?xml version="1.0"?>\n<sdf version="1.9">{content}</sdf>'


@pytest.mark.parametrize('content', TEXTS.values(), ids=TEXTS)
def test_tags_and_holders_are_those_of_the_tree(content):
    root, markup = found_in(sdf(content))
    xmls = list(root.iter(*TAGS))
    assert [TAGS[number] for number in markup.numbers] == [xml.tag for xml in xmls]
    holders = markup.holders(np.arange(len(xmls))).tolist()
    expected = [
        xmls.index(xml.getparent()) if xml.getparent() in xmls else -1 for xml in xmls]
    assert holders == expected


@pytest.mark.parametrize('content', TEXTS.values(), ids=TEXTS)
def test_lines_are_those_of_the_tree(content):
    document = document_from_text(sdf(content), 'x.sdf')
    xmls = list(document.root.iter(*TAGS))
    lines = written_elements(document).lines_of(np.arange(len(xmls)))
    assert lines.tolist() == [xml.sourceline for xml in xmls]


@pytest.mark.parametrize('content', TEXTS.values(), ids=TEXTS)
def test_texts_are_those_of_the_tree_where_nothing_is_odd_in_them(content):
    root, markup = found_in(sdf(content))
    poses = markup.of('pose')
    for text, xml in zip(markup.texts(poses), root.iter('pose'), strict=True):
        if '&' not in text and COMMENT not in text:
            assert text.strip() == text_of(xml).strip()


@pytest.mark.parametrize('content', TEXTS.values(), ids=TEXTS)
def test_first_values_are_names_or_empty(content):
    root, markup = found_in(sdf(content))
    models = markup.of('model')
    for name, xml in zip(markup.first_values(models), root.iter('model'), strict=True):
        assert name in ('', xml.get('name'), 'a&amp;b', 'a&gt;b')


def test_a_text_without_double_quotes():
    _, markup = found_in("<sdf version='1.9'><link name='a'/></sdf>")
    assert markup.first_values(markup.of('link')) == ['']


def test_a_second_value():
    _, markup = found_in(sdf(
        '<link name="a"/><link name="b" type="t"/><link name="c" type="t" more="x"/>'
        '<link name="d" other="o"/><link type="t" name="e"/><link/>'))
    values, has_more = markup.second_values(markup.of('link'), b'type')
    assert values[1] == 't'
    assert values[0] == values[3] == values[4] == ''
    assert has_more[2:5].all()
    assert not has_more[1]


def test_what_follows_the_outermost_element_is_not_found():
    _, markup = found_in(sdf('<link/>') + '<sdf><link/></sdf>')
    assert len(markup.of('link')) == 1


def test_another_encoding():
    text = '<?xml version="1.0" encoding="utf-16"?><sdf version="1.9"><model name="é"/></sdf>'
    _, markup = found_in(text.encode('utf-16'))
    assert markup.first_values(markup.of('model')) == ['é']


def test_a_tree_that_has_changed():
    root = etree.fromstring('<sdf>\n<link name="a"/>\n</sdf>')
    etree.SubElement(root, 'link', name='b')
    markup, lines_of, _ = written_elements(Document('x.sdf', root, '1.9'))
    links = markup.of('link')
    assert markup.first_values(links) == ['a', 'b']
    assert lines_of(links).tolist()[0] == 2


def test_xmls_of_some():
    document = document_from_text(
        sdf('<link name="a"/><model/><link name="b"/>'), 'x.sdf')
    tree = index_of_document(document).tree
    assert [xml.get('name') for xml in tree.xmls_of(('link',), np.array([3]))] == ['b']
    assert tree.xmls_of(('pose',), np.arange(0)) == []
    assert tree.xmls_of(('link', 'model'), np.arange(1, 4)) == list(document.root)


def test_many_texts_are_searched_together():
    texts = [sdf(content).encode() for content in (
        '<link name="a"/>\n<link name="b"/>', '', '\n<model><link name="c"/></model> <!-- -->')]
    markup = markup_from_texts(texts)
    links = markup.of('link')
    assert markup.first_values(links) == ['a', 'b', 'c']
    assert markup.lines(links).tolist() == [2, 3, 3]
    assert markup.roots.tolist() == markup.of('sdf').tolist() == [0, 3, 4]
    assert markup.holders(links).tolist() == [0, 0, 5]


def test_texts_of_which_one_has_more_than_tags_are_not_searched_together():
    texts = [sdf(content).encode() for content in ('<link/>', '<a><![CDATA[<b/>]]></a>')]
    assert markup_from_texts(texts) is None


def test_spans():
    markup = markup_from_texts([b'<sdf><link/> <model><link> </link></model>.</sdf>'])
    spans = markup.spans(np.arange(4))
    assert spans.begins.tolist() == [0, 5, 13, 20]
    assert spans.ends.tolist() == [49, 12, 42, 34]
    assert spans.first_tags.tolist() == [0, 1, 2, 3]
    assert spans.last_tags.tolist() == [6, 1, 5, 4]


@pytest.mark.parametrize(('text', 'count'), [
    ('1 2 3', 3), (' 1\n2.5\t3 ', 3), ('1', 1), ('', 0), (' ', 0), ('1 -2 3', 0), ('1 x', 0),
    ('1 <!-- --> 2', 0), ('1 .5', 0), ('1 2<b/> 3', 2)])
def test_counts_of_numbers(text, count):
    markup = markup_from_texts([f'<sdf><size>{text}</size><size>7</size></sdf>'.encode()])
    assert markup.counts_of_numbers(markup.of('size')).tolist() == [count, 1]


def test_counts_of_numbers_of_nothing_and_of_empty_elements():
    markup = markup_from_texts([b'<sdf><size/><size>1</size></sdf>'])
    assert markup.counts_of_numbers(markup.of('size')).tolist() == [0, 1]
    assert markup.counts_of_numbers(markup.of('mass')).tolist() == []
