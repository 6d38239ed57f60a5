# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Elements that parameters name, found as libsdformat finds them, with its limits."""

import random

from lxml import etree
import pytest

from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.include.element_ids import ElementIds, hint_for_id
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes

IDS = """<model name="arm">
<pose>0 0 0 0 0 0</pose>
<link name="base"><visual name="shape"/><collision name="shape"/><sensor name="eye"/></link>
<link name="h"><visual name="v"/></link>
<link name="ö"/><frame name="ö"/>
<link name="hand"/>
<link name="hand_left"><visual name="palm"/></link>
<frame name="grip"/>
<x:thing name="thing"/>
<model name="tool"><frame name="tool::tip"/><link name="p"/><frame name="tool::p"/>
<frame name="tip"/>
<model name="inner"><frame name="end"/></model></model>
</model>"""


@pytest.fixture(scope='module')
def arm():
    return xml_from_bytes(IDS.encode(), 'f').root


@pytest.mark.parametrize(('element_id', 'tag'), [
    ('none', ''), ('', ''), ('arm', ''), ('arm::base', ''), ('base::none', ''), ('shape', ''),
    ('tip', ''), ('Base', ''), ('bas', ''), ('base:shape', ''), ('base::', 'visual'),
    ('base', 'frame'), ('base::shape', 'sensor'), ('tool::tip', 'link'), ('tool::end', 'frame'),
    # What libsdformat does not find: names of one letter at the top, and what has the name of an
    # element before it.
    ('h', 'link'), ('base::shape', 'collision'),
])
def test_unknown_id_is_not_found(arm, element_id, tag):
    assert ElementIds(arm).element(element_id, tag) is None


@pytest.mark.parametrize(('element_id', 'tag', 'name'), [
    ('base', '', 'base'), ('base', 'link', 'base'), ('base::shape', 'visual', 'shape'),
    ('base::eye', 'sensor', 'eye'), ('grip', 'frame', 'grip'), ('tool', 'model', 'tool'),
    ('tool::tip', '', 'tool::tip'), ('tool::tip', 'frame', 'tip'),
    ('tool::p', '', 'p'), ('tool::inner::end', 'frame', 'end'), ('thing', 'x:thing', 'thing'),
    ('hand_left::palm', 'visual', 'palm'), ('tool::p', 'link', 'p'), ('h', '', 'h'),
    ('ö', 'link', 'ö'),  # two bytes
])
def test_element_is_found(arm, element_id, tag, name):
    found = ElementIds(arm).element(element_id, tag)
    assert found.get('name') == name


@pytest.mark.parametrize(('element_id', 'tag', 'hint'), [
    ('zzz', '', ''),
    ('tool::top', 'frame', '; did you mean "tool::tip"?'),
    ('grp', '', '; did you mean "grip"?'),
    ('grp', 'link', ''),
    ('tool::tip', 'link', '; that is a <frame>'),
    ('h', 'link', '; libsdformat does not find names of one letter at the top of a model'),
    ('h::v', 'visual', '; libsdformat does not find names of one letter at the top of a model'),
    ('ö', 'frame',
     '; libsdformat finds only the <link> of that name, which comes before it'),
    ('base::shape', 'collision',
     '; libsdformat finds only the <visual> of that name, which comes before it'),
])
def test_hint_for_an_id_that_was_not_found(arm, element_id, tag, hint):
    problems = Problems(['a.sdf'])
    assert hint_for_id(arm, element_id, problems, tag) == hint
    # It takes long to find.
    while problems.allows_hint():
        pass
    assert hint_for_id(arm, element_id, problems, tag) == ''


@pytest.mark.parametrize('seed', range(20))
def test_changes_are_found(seed):
    choice = random.Random(seed).choice
    names, tags = ['a', 'ab', 'abc', ' ab', 'ab::c', ''], ['link', 'frame']
    top = etree.Element('model')
    ids = ElementIds(top)
    for _ in range(100):
        for name in (*names, 'abc::ab'):
            for tag in tags:
                assert ids.element(name, tag) is ElementIds(top).element(name, tag)
                assert ids.child(top, tag, name) is ElementIds(top).child(top, tag, name)
            assert ids.element(name) is ElementIds(top).element(name)
        new = etree.Element(choice(tags), name=choice(names))
        old = choice([None, *top])
        if old is None:
            top.append(new)
            ids.add(new)
        elif choice([False, True]):
            top.replace(old, new)
            ids.add(new, in_place_of=old)
        elif choice([False, True]):
            old.set('name', choice(names))
            ids.add(old, in_place_of=old)
        else:
            top.remove(old)
