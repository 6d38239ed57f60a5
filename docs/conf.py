# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How Sphinx, alone or called by rosdoc2, builds the documentation."""

import importlib.util
import os
from pathlib import Path
import re
import sys
from urllib.parse import urlsplit
import xml.etree.ElementTree as ET

from docutils import nodes
from sphinx.application import Sphinx

# rosdoc2 copies the pages, and runs this file from another one, which names it.
RUN_BY_ROSDOC2 = re.search(
    r'exec\(open\("(.+)"\)', Path(__file__).read_text(encoding='utf-8'))
ROOT = Path(RUN_BY_ROSDOC2[1] if RUN_BY_ROSDOC2 else __file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

LANGUAGES = {
    'xml': re.compile('<'), 'console': re.compile(r'\$ '), 'python': re.compile('(import|from) '),
    'bash': re.compile(r'(ros2|sdf_pose|pip|python3|make|gz|eval|FASTDDS_\w+=)\b')}
"""The beginning of the first line of a block without a language."""

project = 'sdf_pose_bridge'
author = copyright = 'The sdf_pose_bridge authors'
version = release = ET.parse(ROOT / 'package.xml').getroot().findtext('version')
extensions = ['myst_parser', 'sphinx.ext.autodoc']
# The pages that rosdoc2 adds: those of all modules, and README.md, whose links lead to files that
# rosdoc2 does not copy.
exclude_patterns = [
    '_build', 'index.rst', 'modules.rst', 'sdf_pose_bridge*.rst', 'standards.rst',
    'standard_docs', '__readme_include.rst']
html_theme = 'furo'
html_title = f'sdf_pose_bridge {version}'
html_static_path = ['static']
html_css_files = ['pages.css']
# Where the pages will be; where this is not known, links between them are relative all the same.
html_baseurl = os.environ.get('DOCS_URL', '')
# The page for addresses that do not exist is shown at any of them, so its links begin with this.
if importlib.util.find_spec('notfound'):
    extensions.append('notfound.extension')
    notfound_urls_prefix = f'{urlsplit(html_baseurl).path.rstrip("/")}/'
highlight_language = 'text'
myst_heading_anchors = 3
autodoc_member_order = 'bysource'
autodoc_typehints = 'description'
autodoc_preserve_defaults = True


def _highlight(_app: Sphinx, doctree: nodes.document) -> None:
    """Give blocks that are written without a language the one that they are in."""
    for block in doctree.findall(nodes.literal_block):
        if block.get('language', 'none') == 'none':
            block['language'] = next(
                (name for name, pattern in LANGUAGES.items() if pattern.match(block.astext())),
                highlight_language)


def _link_to_repository(app: Sphinx, _page: str, source: list[str]) -> None:
    """Let links to files beside the folder of the pages lead there also from a copy of it."""
    source[0] = source[0].replace('](../', f']({os.path.relpath(ROOT, app.srcdir)}/')


def setup(app: Sphinx) -> None:
    """Register the changes to pages."""
    app.connect('source-read', _link_to_repository)
    app.connect('doctree-read', _highlight)
