# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Where names of frames stand in a picture."""

import numpy as np
import pytest

pytest.importorskip('trimesh', reason='needs trimesh')
pytest.importorskip('viser', reason='needs viser')
from sdf_pose_bridge.cli.viewer.labels import labels_from_names

EYE, MIDDLE = np.array((0.0, -10.0, 0.0)), np.zeros(3)


def labels(*names_and_points, first=0):
    names, points = zip(*names_and_points, strict=True)
    return list(labels_from_names(names, np.array(points, float), EYE, MIDDLE, first))


def test_names_of_one_place_are_joined():
    found = labels(('b', (0.05, 0, -0.05)), ('left', (-5, 0, 0)), ('a', (0, -0.1, 0)))
    assert [text for text, _ in found] == ['a\nb', 'left']
    assert found[0][1].tolist() == [0, -0.1, 0]


def test_name_that_a_nearer_one_covers_is_left_out():
    found = labels(('far', (0.6, 1, -0.1)), ('a' * 40, (0, 0, 0)))
    assert [text for text, _ in found] == ['a' * 40]


def test_first_text_is_not_covered():
    found = labels(('far', (0.6, 1, -0.1)), ('a' * 40, (0, 0, 0)), first=1)
    assert [text for text, _ in found] == ['far']


def test_label_does_not_grow_over_another():
    found = labels(
        ('a', (0, -0.2, 0)), ('below', (0.1, -0.1, -0.2)), ('b' * 40, (0.01, 0, 0)))
    assert [text for text, _ in found] == ['a', 'below']


def test_many_names_of_one_place_are_counted():
    ((text, _),) = labels(*((name, (0, 0, 0)) for name in 'abcdefghij'))
    assert text == 'a\nb\nc\nd\nand 6 more'


@pytest.mark.parametrize(('name', 'is_covered'), [('a', False), ('a' * 40, True)])
def test_long_names_reach_others(name, is_covered):
    assert (len(labels((name, (0, 0, 0)), ('b', (1, 0, -0.01)))) == 1) is is_covered


def test_names_behind_the_camera_are_not_shown():
    assert labels(('a', (0, -20, 0))) == []


def test_no_names():
    assert list(labels_from_names([], np.zeros((0, 3)), EYE, MIDDLE)) == []
