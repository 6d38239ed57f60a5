# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which models get a transform from the root frame: words, and patterns of their names."""

import pytest
from sdf_texts import LINK, model_file, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.tf.anchors import AnchorModels, AnchorPatterns, anchors_from_text
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions


def model(name, content=LINK):
    return f'<model name="{name}">{content}</model>'


WORLD = world_file("""
    <model name="table1"><static>1</static><link name="l"/></model>
    <model name="table2"><link name="l"/></model>
    <model name="robot1"><link name="l"/></model>
    <model name="robot2">
      <link name="l"/>
      <model name="table3"><link name="l"/></model>
    </model>
    <model name="arm">
      <link name="l"/>
      <joint name="j" type="fixed"><parent>world</parent><child>l</child></joint>
    </model>""")


def tree_with(anchors, text=WORLD):
    return tf_tree_from_scene(load_text(text), TfOptions(anchor_models=anchors_from_text(anchors)))


def anchored(tree):
    return {frame_id.partition('/')[0]
            for frame_id, parent in zip(tree.frame_ids, tree.parent_ids, strict=True)
            if parent == 'world'}


@pytest.mark.parametrize('text', ['', ',', 'a,', 'all,a', 'a, none', 'auto,static'])
def test_text_that_is_neither_a_word_nor_patterns_is_refused(text):
    with pytest.raises(ValueError, match='one of auto, all, static, none, or patterns'):
        anchors_from_text(text)


@pytest.mark.parametrize('word', AnchorModels)
def test_word(word):
    assert anchors_from_text(word.value) is word


@pytest.mark.parametrize(('text', 'expected'), [
    ('table*', AnchorPatterns(('table*',))),
    ('static, robot1', AnchorPatterns(('robot1',), has_static=True)),
    ('statics', AnchorPatterns(('statics',))),
])
def test_patterns(text, expected):
    assert anchors_from_text(text) == expected


@pytest.mark.parametrize(('text', 'models'), [
    ('table*', {'table1', 'table2'}), ('robot?,arm', {'robot1', 'robot2', 'arm'}),
    ('[!t]*', {'robot1', 'robot2', 'arm'}), ('static', {'table1', 'arm'}),
    ('static,robot2', {'table1', 'arm', 'robot2'}), ('TABLE*', set()), ('table3', set()),
])
def test_models_whose_names_match_are_anchored(text, models):
    assert anchored(tree_with(text)) == models


@pytest.mark.parametrize(('text', 'hint'), [
    ('tabel1', '; did you mean "table1"?'), ('statik', '; did you mean "static"?'), ('zzz*', ''),
    ('table3', '; did you mean "table2"?')])
def test_pattern_without_a_model_is_a_warning(text, hint):
    two_worlds = WORLD.replace('</sdf>', f'<world name="v">{model("elsewhere")}</world></sdf>')
    warning, _ = tree_with(f'robot*,elsewhere,{text}', two_worlds).warnings
    assert warning.message == (
        f'anchor_models: no top-level model has a name like "{text}"{hint}')


def test_model_file_is_matched_by_the_name_of_its_model():
    assert anchored(tree_with('m', model_file(LINK))) == {'l'}
    assert anchored(tree_with('n', model_file(LINK))) == set()
