# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names of tags, recognized eight bytes at a time."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

from sdf_pose_bridge.tag_names import TagNames
from sdf_pose_bridge.tag_names import UNKNOWN

TAGS = ('a', 'link', 'linker', 'inertial', 'inertials', 'collide_without_contact',
        'collide_without_contact_bitmask', 'particle_emitter', 'particle_size')
PARTS = st.sampled_from(('link', 'er', 'inertial', 's', 'collide_without_contact', '_bitmask',
                         'particle', '_emitter', 'a', '-', '.', ':', 'é', '\U0001f916'))
ENDS = st.sampled_from(['>', '/>', ' name="link">', '\n>', '\t>', '\r>'])


def numbers_of(*tags):
    text = b'<sdf>'
    places = []
    for tag in tags:
        text += b'<'
        places.append(len(text))
        text += tag.encode() + b'</x>'
    text += b'</sdf>'
    return TagNames(TAGS).numbers_from_text(
        np.frombuffer(text, np.uint8), np.array(places, dtype=np.intp)).tolist()


@pytest.mark.parametrize('tag', TAGS)
@pytest.mark.parametrize('end', ['>', '/>', ' name="x">', '\n>', '\t>', '\r\n>'])
def test_each_is_recognized_whatever_ends_it(tag, end):
    assert numbers_of(tag + end) == [TAGS.index(tag)]


@pytest.mark.parametrize(
    'tag', ['b', 'lin', 'Link', 'link-', 'link.', 'gz:link', 'linkers', 'inertia', 'inertialss',
            'collide_without_contac', 'collide_without_contact_', 'particle', 'liné', 'link\x7f'])
def test_what_only_resembles_a_name_is_unknown(tag):
    assert numbers_of(tag + '>') == [UNKNOWN]


@given(st.lists(st.tuples(st.lists(PARTS, min_size=1, max_size=3).map(''.join), ENDS)))
def test_any_names(tags):
    expected = [TAGS.index(tag) if tag in TAGS else UNKNOWN for tag, _ in tags]
    assert numbers_of(*(tag + end for tag, end in tags)) == expected
