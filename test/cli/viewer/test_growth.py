# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The time of the page grows with what is typed into its fields, which have no limit."""

import contextlib
from functools import partial
import re

from folders import ROOT
from growth.families import each, model, REPEATED
from growth.turns import fault_of_growth
import pytest

pytest.importorskip('viser', reason='needs viser')
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_tree
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.pose_texts import number_from_text, typed_poses_from_text
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.tree import TfOptions


def links(n):
    """Return a text with n links that have poses."""
    return model(each(n, REPEATED['links with poses']))


FIELDS = {
    'search': lambda n: partial(
        html_of_tree, ShownScene(load_text(links(n // 100)), TfOptions()), 'x' * n, '', (), ()),
    'self._name': lambda n: partial(number_from_text, '1' * n),  # of a joint
    'label': lambda n: partial(typed_poses_from_text, '1 ' * n),  # of a number of a pose
}
"""For each field, what reads n characters in it."""

OF_THE_SCRIPT = {'asked'}
"""Fields in which nobody types."""


def test_each_field_has_a_row():
    sources = (ROOT / 'sdf_pose_bridge' / 'cli' / 'viewer').glob('*.py')
    found = re.findall(r"gui\.add_text\(\s*'?([\w.]+)", ''.join(
        path.read_text() for path in sources))
    assert {*found} == {*FIELDS} | OF_THE_SCRIPT


@pytest.mark.parametrize('field', FIELDS)
def test_time_grows_with_what_is_typed_and_not_faster(field):
    def read(call):
        with contextlib.suppress(PoseFormatError):
            call()

    n = 80_000
    calls = FIELDS[field](n), FIELDS[field](n // 2), partial(load_text, links(n // 60))
    fault = fault_of_growth(*(partial(read, call) for call in calls))
    assert not fault, fault
