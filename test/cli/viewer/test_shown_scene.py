# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which models and joints a page shows, and where its frames are."""

import numpy as np
import pytest

pytest.importorskip('viser', reason='needs viser')
from sdf_pose_bridge.cli.viewer.shown_scene import short_names, ShownScene
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import TfOptions

ARM = """<link name="a"/><link name="b"/><joint name="j" type="prismatic">
  <parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint>"""
TEXT = f"""<sdf version="1.11"><world name="w">
  <model name="table"><static>true</static><link name="l"/></model>
  <model name="arm">{ARM}</model></world></sdf>"""


def shown(**options):
    return ShownScene(load_text(TEXT.encode(), 'cell.sdf'), TfOptions(**options))


def test_model_that_does_not_exist():
    with pytest.raises(SdfError, match='bed'):
        shown(model='bed')


def test_only_the_model_that_is_asked_for():
    scene = shown(model='table')
    assert [*scene.joints] == []
    assert np.array(scene.loaded.names)[scene.is_in_model].tolist() == ['table', 'table::l']


@pytest.mark.parametrize(('names', 'expected'), [
    (['a/link', 'b/link', 'b/top'], ['a/link', 'b/link', 'top']),
    (['table', 'x/table', 'x/y/table'], ['table', 'x/table', 'y/table']),
    (['p/x/c', 'q/x/c'], ['p/x/c', 'q/x/c']), (['a/' * 9 + 'c', 'b/c'], ['a/c', 'b/c']),
    (['a/x/x/x/x/c', 'b/x/x/x/x/c'], ['a/x/x/x/x/c', 'b/x/x/x/x/c']),
    ([], [])])
def test_names_are_as_short_as_they_are_unique(names, expected):
    assert short_names(names) == expected


def test_what_is_in_a_robot():
    scene = shown()
    assert np.array(scene.loaded.names)[scene.is_in_robot].tolist() == [
        'arm', 'arm::a', 'arm::b', 'arm::j']


def test_frames_at_positions():
    scene = shown()
    assert [*scene.joints] == ['arm/j']
    posed = scene.at({'arm/j': 0.25})
    assert posed.pose_of(posed.tree.frame_ids.index('arm/b')).z == 0.25
    assert posed.pose_of(ROOT_IS_PARENT) == Pose()
