# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A release is made whole, or not at all and for a reason."""

import os
from pathlib import Path
import shutil
import sys
import xml.etree.ElementTree as ET

from command_line import completed
from folders import ROOT
import needs
import pytest

pytest.importorskip('catkin_pkg', reason='needs catkin_pkg')

INTERFACES = 'sdf_pose_bridge_interfaces'
MANIFESTS = ('package.xml', f'{INTERFACES}/package.xml', 'examples/cpp_client/package.xml')
CHANGELOGS = ('CHANGELOG.rst', f'{INTERFACES}/CHANGELOG.rst')
HEAD = '^^^^^^^^^\nChangelog\n^^^^^^^^^\n\n'
FORTHCOMING = 'Forthcoming\n-----------\n* News.\n\n'
LAST = '0.9.0 (2026-01-01)\n------------------\n* First.\n'


def git_in(folder):
    def run(*arguments):
        return completed([needs.program('git'), *arguments], cwd=folder, check=True).stdout.strip()
    return run


@pytest.fixture(scope='module')
def repository(tmp_path_factory):
    """A repository that has what a release changes, of which each test has a copy."""
    folder = tmp_path_factory.mktemp('repository')
    for name in MANIFESTS:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text('<package>\n  <version>0.9.0</version>\n</package>\n')
    for name in CHANGELOGS:
        (folder / name).write_text(HEAD + FORTHCOMING + LAST)
    (folder / 'release').mkdir()
    shutil.copy(ROOT / 'release/make_release.py', folder / 'release')
    run = git_in(folder)
    run('init', '--quiet', '--initial-branch', 'main')
    run('config', 'user.name', 'n')
    run('config', 'user.email', 'n@n.org')
    run('add', '.')
    run('commit', '--quiet', '-m', 'first')
    return folder


@pytest.fixture
def git(repository, tmp_path):
    """Runs git in a copy of the repository: ``git(*arguments)``."""
    shutil.copytree(repository, tmp_path, dirs_exist_ok=True)
    return git_in(tmp_path)


@pytest.fixture
def release(git, tmp_path):
    """Makes a release of this version there: ``release(version)``."""
    if not Path(git('--exec-path'), 'git-subtree').exists():
        pytest.skip('needs "git subtree"')

    def run(version, **environment):
        return completed([sys.executable, 'release/make_release.py', version], cwd=tmp_path,
                         env={**os.environ, **environment})
    return run


def assert_refused(done, git, *words):
    assert (done.returncode, done.stdout) == (1, '')
    assert len(done.stderr.splitlines()) == 1
    assert all(word in done.stderr for word in words)
    assert git('log', '--format=%s') == 'first'
    assert git('branch', '--format=%(refname:short)') == 'main'


@pytest.mark.parametrize(('version', 'words'), [
    *((each, f'"{each}" is not three numbers') for each in (
        '', '1.0', 'v1.0.0', '1.0.0rc1', '1.0.00', '1.0.0 ')),
    ('0.8.9', '0.8.9 is lower than 0.9.0')])
def test_version_of_another_form_or_a_lower_one_is_refused(release, git, version, words):
    assert_refused(release(version), git, words)


def test_changes_that_are_not_committed_are_refused(release, git, tmp_path):
    (tmp_path / 'package.xml').write_text('<package><version>0.9.0</version></package>')
    assert_refused(release('1.0.0'), git, 'package.xml', 'not committed')


@pytest.mark.parametrize('tag', ['1.0.0', 'interfaces-1.0.0'])
def test_tag_that_exists_is_refused(release, git, tag):
    git('tag', tag)
    assert_refused(release('1.0.0'), git, f'tag {tag} already')


def test_release_without_changes_is_refused(release, git, tmp_path):
    (tmp_path / 'CHANGELOG.rst').write_text(HEAD + LAST)
    git('commit', '--quiet', '--amend', '-am', 'first')
    assert_refused(release('1.0.0'), git, 'CHANGELOG.rst', 'Forthcoming')


@pytest.mark.parametrize('version', ['0.9.0', '0.10.0', '1.0.0'])
def test_all_places_have_the_version(release, git, tmp_path, version):
    done = release(version)
    assert (done.returncode, done.stderr) == (0, '')
    assert f'git push origin HEAD interfaces-main {version} interfaces-{version}' in done.stdout
    assert {ET.parse(tmp_path / name).getroot().findtext('version') for name in MANIFESTS} == {
        version}
    assert git('status', '--porcelain') == ''
    assert git('log', '-1', '--format=%s', version) == version


def test_release_in_a_hook_of_another_repository(release, git, repository):
    of_hook = {'GIT_DIR': str(repository / '.git'), 'GIT_WORK_TREE': str(repository)}
    assert release('1.0.0', **of_hook).returncode == 0
    assert git('tag').split() == ['1.0.0', 'interfaces-1.0.0']
    assert git_in(repository)('tag') == ''


def test_forthcoming_changes_get_version_and_date(release, git, tmp_path):
    (tmp_path / CHANGELOGS[1]).write_text(HEAD + LAST)
    git('commit', '--quiet', '-am', 'second')
    assert release('1.0.0').returncode == 0
    for name, news in zip(CHANGELOGS, ('News.', 'No changes.'), strict=True):
        title, line, entry, empty, *rest = (
            (tmp_path / name).read_text().removeprefix(HEAD).splitlines())
        assert title.startswith('1.0.0 (20')
        assert (line, entry, empty) == ('-' * len(title), f'* {news}', '')
        assert rest == LAST.splitlines()


def test_tag_of_the_interfaces_has_them_in_its_root(release, git, tmp_path):
    for version in ('1.0.0', '1.0.1'):
        assert release(version).returncode == 0
        assert git('ls-tree', '--name-only', f'interfaces-{version}').split() == [
            'CHANGELOG.rst', 'package.xml']
        assert git('show', f'interfaces-{version}:package.xml') == git(
            'show', f'{version}:{INTERFACES}/package.xml')
        assert git('rev-parse', 'interfaces-main') == git(
            'rev-parse', f'interfaces-{version}^{{commit}}')
        changelog = tmp_path / 'CHANGELOG.rst'
        changelog.write_text(changelog.read_text().replace(HEAD, HEAD + FORTHCOMING))
        git('commit', '--quiet', '-am', 'next')
