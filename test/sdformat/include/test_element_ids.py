# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Finding the elements that parameters name, as libsdformat finds them, with its limits."""

import pytest

from sdf_pose_bridge.sdformat.include.element_ids import element_by_id, hint_for_id
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes

ARM = """<model name="arm">
<pose>0 0 0 0 0 0</pose>
<link name="base"><visual name="shape"/><collision name="shape"/><sensor name="eye"/></link>
<link name="h"/>
<link name="ö"/>
<link name="hand"/>
<link name="hand_left"><visual name="palm"/></link>
<frame name="grip"/>
<x:thing name="thing"/>
<model name="tool"><link name="p"/><frame name="tip"/>
<model name="inner"><frame name="end"/></model></model>
</model>"""


@pytest.fixture(scope='module')
def arm():
    return xml_from_bytes(ARM.encode(), 'f').root


@pytest.mark.parametrize(('element_id', 'tag'), [
    ('none', ''), ('', ''), ('arm', ''), ('arm::base', ''), ('base::none', ''), ('shape', ''),
    ('tip', ''), ('Base', ''), ('bas', ''), ('base:shape', ''), ('base::', 'visual'),
    ('base', 'frame'), ('base::shape', 'sensor'), ('tool::tip', 'link'), ('tool::end', 'frame'),
])
def test_unknown_id_is_not_found(arm, element_id, tag):
    assert element_by_id(arm, element_id, tag) is None


@pytest.mark.parametrize(('element_id', 'tag', 'name'), [
    ('base', '', 'base'), ('base', 'link', 'base'), ('base::shape', 'visual', 'shape'),
    ('base::eye', 'sensor', 'eye'), ('grip', 'frame', 'grip'), ('tool', 'model', 'tool'),
    ('tool::tip', '', 'tip'), ('tool::inner::end', 'frame', 'end'), ('thing', 'x:thing', 'thing'),
    ('hand_left::palm', 'visual', 'palm'), ('tool::p', 'link', 'p'), ('h', '', 'h'),
    ('ö', 'link', 'ö'),  # two bytes
])
def test_element_is_found(arm, element_id, tag, name):
    found = element_by_id(arm, element_id, tag)
    assert found.get('name') == name


@pytest.mark.parametrize(('element_id', 'tag'), [
    ('h', 'link'),  # the name of one letter at the top
    ('base::shape', 'collision'),  # the visual of that name comes first
])
def test_element_that_libsdformat_does_not_find_is_not_found(arm, element_id, tag):
    assert element_by_id(arm, element_id, tag) is None


@pytest.mark.parametrize(('element_id', 'tag', 'hint'), [
    ('zzz', '', ''),
    ('tool::top', 'frame', '; did you mean "tool::tip"?'),
    ('grp', '', '; did you mean "grip"?'),
    ('tool::tip', 'link', '; that is a <frame>'),
    ('h', 'link', '; libsdformat does not find names of one letter at the top of a model'),
    ('base::shape', 'collision',
     '; libsdformat finds only the <visual> of that name, which comes before it'),
])
def test_hint_for_an_id_that_was_not_found(arm, element_id, tag, hint):
    assert hint_for_id(arm, element_id, tag) == hint
