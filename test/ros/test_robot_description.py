# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The text for the topic, whatever the encoding of the file."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from lxml import etree

from sdf_pose_bridge.ros.robot_description import unicode_text

TEXT = '<robot name="größe"/>'


@pytest.mark.parametrize('text', [TEXT, TEXT.encode(), TEXT.encode('utf-8-sig')])
def test_a_text_stays_as_it_is(text):
    assert unicode_text(text) == TEXT


@pytest.mark.parametrize('encoding', ['latin-1', 'utf-16'])
def test_another_encoding_is_converted(encoding):
    text = unicode_text(f'<?xml version="1.0" encoding="{encoding}"?>{TEXT}'.encode(encoding))
    assert etree.fromstring(text).get('name') == 'größe'
