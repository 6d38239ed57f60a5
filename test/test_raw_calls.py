# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a small file could make the reader do again and again is found in its source."""

from growth.raw_calls import faults, raw_calls
import pytest


def test_the_reader_has_none():
    assert list(faults()) == []


@pytest.mark.parametrize('text', [
    "for flag in flags:\n    axis = flag.getparent()\n    xyz = first_child(axis, 'xyz')",
    "for flag in flags:\n    if first_child(axis, 'xyz') is None:\n        pass",
    "while flags:\n    first_child(axis, 'xyz')",
    "names = [child_value(model, 'name') for link in links]",
    'for path in paths:\n    pass\nfolder.resolve()',
    'list(folder.iterdir())',
])
def test_what_is_not_counted_is_found(text):
    assert len(raw_calls(text)) == 1


@pytest.mark.parametrize('text', [
    "for axis in axes:\n    xyz = first_child(axis, 'xyz')",
    "for axis in axes:\n    limit = first_child(axis, 'limit')\n    first_child(limit, 'lower')",
    'parts = [first_child(joint, tag) for tag in TAGS]',
    "xyz = first_child(axis, 'xyz')",
    "for axis in axes:\n    def pose():\n        return first_child(other, 'pose')",
])
def test_what_is_done_once_for_each_element_is_not(text):
    assert raw_calls(text) == []
