# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What is put into a page; integration/test_view_page.py lets a browser run it."""

import html
import re

from sdf_pose_bridge.cli.viewer.browser_script import page_with_script
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_data

HOSTILE = '"><script>'


def test_data_are_escaped():
    (value,) = re.fullmatch(
        '<meta data-names="([^"<>]*)">', html_of_data('names', HOSTILE)).groups()
    assert html.unescape(value) == HOSTILE


def test_title_is_escaped_and_the_rest_stays():
    page = page_with_script('<head><title>Viser</title></head><body>', HOSTILE)
    assert page.startswith('<head><title>&quot;&gt;&lt;script&gt;</title><style>')
    assert page.endswith('</script></head><body>')
