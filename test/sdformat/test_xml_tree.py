# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading values from XML elements: text, attributes, prefixes, steps of paths."""

import ast
from pathlib import Path

from lxml import etree
import pytest

from sdf_pose_bridge.sdformat import xml_tree
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    copy_of,
    described,
    first_child,
    is_foreign,
    text_of,
    value_of,
    written_tag,
)


def xml(text):
    return xml_from_bytes(text.encode(), 'f').root


# Text

@pytest.mark.parametrize(('content', 'text'), [
    ('', ''),
    (' \n ', ''),
    ('<x/>1 2', ''),
    ('<!-- c --><x/>1 2', ''),
    ('<x/><!-- c -->1 2', ''),
    ('1 2', '1 2'),
    ('<!-- c -->1 2', '1 2'),
    (' \n<!-- c --> <!-- d -->1 2', '1 2'),
    ('1 <!-- c -->2', '1'),
    ('1 <x/>2', '1'),
    ('&#160;<!-- c -->1', '\u00a0'),
    ('<!-- c -->&#8195;<!-- c -->1', '\u2003'),
    ('\x85', '\x85'),
    ('<![CDATA[1 2]]>', '1 2'),
    (' <![CDATA[1 2]]> 3', '1 2'),
    ('1<![CDATA[2]]>', '1'),
    ('<![CDATA[1]]><![CDATA[2]]>', '1'),
    ('1<![CDATA[ ]]>2', '1'),
    ('<![CDATA[]]>1', ''),
    (' <![CDATA[ ]]><![CDATA[1]]>', ''),
    ('<!-- <![CDATA[ -->1<!-- ]]> -->', '1'),
    ('1&#32;2', '1 2'),
])
def test_first_run_of_character_data_is_the_text(content, text):
    assert text_of(xml(f'<pose>{content}</pose>')) == text


@pytest.mark.parametrize(('content', 'value'), [
    ('', ''), (' \t\n', ''), ('a', 'a'), (' a\n', 'a'), ('\ta \n b\t', 'a b'),
    ('\t\u00a0x \n', '\u00a0x'), ('<!-- c --> a <!-- d -->b', 'a'),
])
def test_value_has_no_ascii_white_space_around_it(content, value):
    assert value_of(xml(f'<a>{content}</a>')) == value


# Attributes

@pytest.mark.parametrize(('attributes', 'value'), [
    ('', ''), ('name=""', ''), ('name="  "', ''), ('name=" a "', 'a'), ('name="&#10;a&#9;"', 'a'),
    ('name="\u00a0a"', '\u00a0a'), ('name="&#13;a"', '\ra'), ('name="\ra"', 'a'),
    ('x:name="a"', ''), ('Name="a"', ''),
])
def test_attribute_has_no_ascii_white_space_around_it(attributes, value):
    assert attribute_of(xml(f'<link {attributes}/>'), 'name') == value


def test_white_space_of_python_is_in_no_other_module():
    # The tables of the grammar and of topics have texts of this package only.
    modules = set(Path(xml_tree.__file__).parent.rglob('*.py')) - {Path(xml_tree.__file__)}
    calls = [
        f'{path.name}:{call.lineno}' for path in modules
        if path.stem not in ('gazebo_topics', 'grammar', 'specification')
        for call in ast.walk(ast.parse(path.read_text()))
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and not call.args
        and call.func.attr in ('isspace', 'lstrip', 'rsplit', 'rstrip', 'split', 'strip')]
    assert calls == []


# Children

@pytest.mark.parametrize(('text', 'tags', 'found'), [
    ('<a><!-- c --><b/><c/><!-- d --></a>', '', 'bc'),
    ('<a><d/><b n="1"/><c/><b n="2"/></a>', 'cb', 'bcb'),
])
def test_child_elements_are_in_file_order_without_comments(text, tags, found):
    assert [child.tag for child in child_elements(xml(text), *tags)] == [*found]


@pytest.mark.parametrize(('text', 'number'), [
    ('<a><b/><x:c/><d><c/></d></a>', None), ('<a><b/><c n="1"/><c n="2"/></a>', '1')])
def test_first_child_is_the_first_of_its_tag(text, number):
    child = first_child(xml(text), 'c')
    assert (child if child is None else child.get('n')) == number


# Prefixes

@pytest.mark.parametrize(('text', 'tag'), [
    ('<a/>', 'a'), ('<x:a/>', 'x:a'), ('<x:y:a/>', 'x:y:a'), ('<x:a xmlns:x="urn:x"/>', 'x:a'),
    ('<a xmlns="urn:x"/>', 'a'), ('<xml:a/>', 'xml:a'),
])
def test_tag_as_it_is_written(text, tag):
    assert written_tag(xml(text)) == tag


@pytest.mark.parametrize(('text', 'foreign'), [
    ('<x:a/>', True), ('<x:a xmlns:x="urn:x"/>', True), ('<plugin/>', True),
    ('<plugin><a/></plugin>', True), ('<x:y><z><a/></z></x:y>', True),
    ('<a/>', False), ('<b><a/></b>', False), ('<b><plugin/><x:c/><a/></b>', False)])
def test_only_an_element_in_a_plugin_or_with_a_prefix_is_foreign(text, foreign):
    *_, last = xml(text).iter()
    assert is_foreign(last) is foreign


# Paths

@pytest.mark.parametrize(('text', 'step'), [
    ('<link/>', 'link'), ('<link name=""/>', 'link'), ('<link name=" l "/>', 'link[@name="l"]'),
    ('<x:link name="l"/>', 'x:link[@name="l"]'),
])
def test_step_of_a_path(text, step):
    assert described(xml(text)) == step


# Copies

def test_a_copy_has_all_but_the_text_behind_it():
    root = xml('<a>1<b c="d">2<!-- 3 --><e/>4</b>5</a>')
    assert etree.tostring(copy_of(root[0])) == b'<b c="d">2<!-- 3 --><e/>4</b>'
