# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rules refuse a value with the words that a sentence ends with, or make the setting of it."""

import array
import math
from pathlib import Path

import pytest

from sdf_pose_bridge.ros.parameters import rules
from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.anchors import AnchorModels, AnchorPatterns

PUBLISH_RATE = DECLARATIONS['publish_rate'].convert
PUBLISH_FREQUENCY = DECLARATIONS['publish_frequency'].convert


def within_3(value):
    """Check a value whose texts may have three characters."""
    return rules.check_size(value, 3)


@pytest.mark.parametrize(('rule', 'value', 'words'), [
    (rules.root_frame_setting, '', 'is ""; it must be a frame id'),
    (rules.root_frame_setting, '/map', 'is "/map"; it must be a frame id, not empty and without'),
    (rules.root_frame_setting, 'ma\np', 'it must be without control characters'),
    (rules.prefix_setting, 'r\x001', 'it must be without control characters'),
    (rules.separator_setting, '', 'is ""; it must be at least one character'),
    (PUBLISH_RATE, 0.0009, 'is 0.0009; it must be 0.0 for never, or from 0.001 to 100.0'),
    (PUBLISH_RATE, 100.1, 'is 100.1; it must be 0.0 for never'),
    (PUBLISH_RATE, math.nan, 'is nan; it must be 0.0 for never'),
    (PUBLISH_FREQUENCY, 1000.1, 'it must be 0.0 for each message, or from 0.001 to 1000.0'),
    (rules.anchors_setting, 'a,,b', 'is "a,,b"; it must be one of auto, all, static, none, or '),
    (rules.anchors_setting, '', 'is ""; it must be one of '),
    (rules.anchors_setting, 'all,fence', 'none of which is empty or auto, all or none'),
    (rules.anchors_setting, ',' * 1000, 'has 1001 values; it must have at most 1000'),
    (rules.kinds_setting, [], 'is []; it must be "auto" alone, or made of model, '),
    (rules.kinds_setting, ['auto', 'link'], 'is "auto"; it must be "auto" alone, or made of '),
    (rules.kinds_setting, ['link', 'links'], '; did you mean "link"?'),
    (rules.topic_patterns_setting, [], 'is []; it must be at least one name of a topic'),
    (rules.topic_patterns_setting, ['a/{robot}'],
     'is "a/{robot}"; it must be the name of a topic with no other braces than {model} and'),
    (rules.topic_patterns_setting, ['a', 'my robot'],
     'is "my robot"; it must be the name of a topic: topic name must not contain characters'),
    (rules.topic_patterns_setting, [''], 'is ""; it must be the name of a topic: topic name must'),
    (rules.simulator_setting, 'my sim', 'it must be the name of a node or of its service, such'),
    (rules.entity_setting, '', 'is ""; it must be the name of an entity, with {model} at most'),
    (rules.entity_setting, '{model}/{model}', 'with {model} at most once'),
    (rules.simulator_setting, '//a', 'it must be the name of a node or of its service, such as'),
    (rules.simulator_setting, 'a' * 246, 'topic length should not exceed'),
    (rules.topic_patterns_setting, ['a//b'], 'the name of a topic: topic name must not contain r'),
    (within_3, array.array('d', [0.0]) * 1001, 'has 1001 values; it must have at most 1000'),
    (within_3, 'four', 'has a value of 4 characters; it must have at most 3'),
    (within_3, ['a', 'four'], 'has a value of 4 characters; it must have at most 3'),
    (within_3, ['a'] * 1001, 'has 1001 values; it must have at most 1000'),
])
def test_refused(rule, value, words):
    with pytest.raises(ValueError, match=r'it must|is not set') as refusal:
        rule(value)
    assert words in str(refusal.value)
    assert str(refusal.value).isprintable()


@pytest.mark.parametrize(('rule', 'value', 'setting'), [
    (rules.root_frame_setting, 'map', 'map'),
    (rules.prefix_setting, '', ''),
    (rules.prefix_setting, '/r1/', 'r1/'),
    (rules.separator_setting, '::', '::'),
    (PUBLISH_RATE, 0.0, 0.0),
    (PUBLISH_RATE, 0.001, 0.001),
    (PUBLISH_RATE, 100.0, 100.0),
    (rules.anchors_setting, 'static', AnchorModels.STATIC),
    (rules.anchors_setting, 'table*, static,fence', AnchorPatterns(('table*', 'fence'), True)),
    (rules.simulator_setting, '', ''),
    (rules.simulator_setting, '/', '/get_entities_states'),
    (rules.simulator_setting, '/gzserver', '/gzserver/get_entities_states'),
    (rules.simulator_setting, 'a/get_entities_states', 'a/get_entities_states'),
    (rules.entity_setting, '/World/{model}', '/World/{model}'),
    (rules.kinds_setting, ['link', 'light', 'link'], frozenset({Kind.LINK, Kind.LIGHT})),
    (rules.kinds_setting, ['auto'], None),
    *((within_3, value, None) for value in ('abc', ['abc'] * 1000, [], [4, 5], 4)),
    (rules.directories_setting, ['', 'models', ''], (Path('models'),)),
])
def test_taken(rule, value, setting):
    assert rule(value) == setting


def test_directory_of_an_unknown_user_is_refused():
    with pytest.raises(ValueError, match=r'^is "~no_such_user/models"; .* a user of this name'):
        rules.directories_setting(['models', '~no_such_user/models'])


def test_directories_may_begin_with_that_of_the_user(monkeypatch):
    monkeypatch.setenv('HOME', '/home/me')
    assert rules.directories_setting(['~/models']) == (Path('/home/me/models'),)
