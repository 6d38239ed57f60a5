# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How Sphinx, alone or called by rosdoc2, builds the documentation."""

from pathlib import Path
import sys

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

project = 'sdf_pose_bridge'
author = copyright = 'The sdf_pose_bridge authors'
extensions = ['myst_parser', 'sphinx.ext.autodoc']
exclude_patterns = ['_build']
html_theme = 'alabaster'
html_theme_options = {'description': 'Every frame of an SDFormat file in TF', 'page_width': '70em'}
myst_heading_anchors = 3
autodoc_member_order = 'bysource'
autodoc_typehints = 'description'
