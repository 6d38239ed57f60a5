# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The pages of the documentation are built, have no dead links, and know where they will be."""

from importlib.util import find_spec
import os
import re
import shutil
import sys
from urllib.parse import unquote, urlsplit
import xml.etree.ElementTree as ET

from command_line import completed
from folders import ROOT
import pytest

pytestmark = pytest.mark.skipif(
    not all(map(find_spec, ('sphinx', 'myst_parser', 'furo'))),
    reason='needs Sphinx, MyST and furo')

URL = 'https://example.org/a/b/'
# What rosdoc2 0.2 runs, and a page that it adds.
CONF_OF_ROSDOC2 = f'exec(open("{ROOT}/docs/conf.py").read())\n'
README_OF_ROSDOC2 = f'.. include:: {ROOT}/README.md\n   :parser: myst_parser.sphinx_\n'


def build(source, target, *options, **environment):
    result = completed(
        [sys.executable, '-m', 'sphinx', '--fail-on-warning', '--keep-going', '--quiet', *options,
         str(source), str(target)], env={**os.environ, **environment}, cwd='/')
    assert (result.returncode, result.stderr) == (0, '')
    return target


@pytest.fixture(scope='module')
def pages(tmp_path_factory):
    """Folder of the pages as `make docs` builds them for a web site."""
    return build(ROOT / 'docs', tmp_path_factory.mktemp('pages'), DOCS_URL=URL)


@pytest.fixture(scope='module')
def pages_of_rosdoc2(tmp_path_factory):
    """Folder of the pages as rosdoc2 builds them, from a copy of docs with pages of its own."""
    copy = tmp_path_factory.mktemp('copy') / 'wrapped'
    shutil.copytree(ROOT / 'docs', copy, ignore=shutil.ignore_patterns('_build'))
    (copy / 'conf.py').write_text(CONF_OF_ROSDOC2)
    (copy / 'index.rst').write_text('Index\n=====\n')
    (copy / '__readme_include.rst').write_text(f'README\n======\n\n{README_OF_ROSDOC2}')
    # It has a theme of its own, too; this one takes less time.
    return build(copy, tmp_path_factory.mktemp('pages_of_rosdoc2'), '-D', 'html_theme=basic')


def dead_links(folder):
    """Return the local links of all pages that lead to no file."""
    dead = []
    for page in folder.rglob('*.html'):
        for link in re.findall(r'(?:href|src)="([^"]*)"', page.read_text()):
            path = unquote(urlsplit(link).path)
            if urlsplit(link).scheme or not path:
                continue
            base = page.parent if not path.startswith('/') else folder
            if not (base / path.removeprefix(urlsplit(URL).path).lstrip('/')).exists():
                dead.append((page.name, link))
    return dead


@pytest.mark.parametrize('how', ['pages', 'pages_of_rosdoc2'])
def test_no_link_is_dead(how, request):
    folder = request.getfixturevalue(how)
    assert (folder / 'joints.html').exists()
    assert dead_links(folder) == []


@pytest.mark.parametrize('how', ['pages', 'pages_of_rosdoc2'])
def test_loading_has_its_public_name_with_all_parameters(how, request):
    page = (request.getfixturevalue(how) / 'python_api.html').read_text()
    entry = page.partition('id="sdf_pose_bridge.load"')[2].partition('id="sdf_pose_bridge.')[0]
    names = ('path', 'resource_paths', 'on_missing_include', 'limits', 'shapes', 'texts')
    assert [name for name in names if f'<strong>{name}</strong>' not in entry] == []


def test_pages_have_the_version_and_their_address(pages):
    version = ET.parse(ROOT / 'package.xml').getroot().findtext('version')
    page = (pages / 'joints.html').read_text()
    assert f'sdf_pose_bridge {version}</title>' in page
    assert f'<link rel="canonical" href="{URL}joints.html"' in page


def test_the_page_for_wrong_addresses_works_at_any_of_them(pages):
    pytest.importorskip('notfound', reason='needs sphinx-notfound-page')
    page = (pages / '404.html').read_text()
    local = [link for link in re.findall(r'(?:href|src)="([^"#]+)"', page)
             if not urlsplit(link).scheme]
    assert local
    assert [link for link in local if not link.startswith(urlsplit(URL).path)] == []


@pytest.mark.parametrize(('page', 'language'), [
    ('command_line', 'console'), ('index', 'bash'), ('moving_here', 'xml'), ('joints', 'python')])
def test_blocks_are_highlighted(pages, page, language):
    text = (pages / f'{page}.html').read_text()
    assert f'class="highlight-{language} ' in text
