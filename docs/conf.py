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
html_theme = 'furo'
html_title = 'sdf_pose_bridge'
html_static_path = ['static']
html_css_files = ['pages.css']
# Indented blocks are commands with their output as often as Python.
highlight_language = 'text'
myst_heading_anchors = 3
autodoc_member_order = 'bysource'
autodoc_typehints = 'description'
