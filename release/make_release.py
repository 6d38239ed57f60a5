# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make a release in this repository: its commit, its tags, and the branch of the interfaces.

The release tools of ROS find no package inside a package. So the interfaces are released from a
branch of their own, where they are the root.
"""

import argparse
from collections.abc import Sequence
from datetime import datetime, timezone
import os
from pathlib import Path
import re
import subprocess
import sys
import xml.etree.ElementTree as ET

from catkin_pkg.changelog_generator import FORTHCOMING_LABEL
from catkin_pkg.package_version import get_forthcoming_label, rename_section

ROOT = Path(__file__).resolve().parents[1]
INTERFACES = 'sdf_pose_bridge_interfaces'
BRANCH = 'interfaces-main'
"""Has the history of the interfaces alone, and what was committed to them last."""
MANIFESTS = ('package.xml', f'{INTERFACES}/package.xml', 'examples/cpp_client/package.xml')
CHANGELOGS = ('CHANGELOG.rst', f'{INTERFACES}/CHANGELOG.rst')


class RefusalError(Exception):
    """The reason, in a sentence, why there is no release."""


def environment_of_git() -> dict[str, str]:
    """Return the caller's variables without those of a repository, which a hook of git has."""
    listed = subprocess.run(
        ['git', 'rev-parse', '--local-env-vars'], capture_output=True, text=True, check=True)
    names = listed.stdout.split()
    return {name: value for name, value in os.environ.items() if name not in names}


def git(*arguments: str) -> str:
    """
    Run git in the repository.

    :return: what it prints.
    :raises RefusalError: if it fails.
    """
    done = subprocess.run(
        ['git', *arguments], cwd=ROOT, env=environment_of_git(), capture_output=True, text=True,
        check=False)
    if done.returncode:
        msg = f'"git {" ".join(arguments)}" fails: {done.stderr.strip()}'
        raise RefusalError(msg)
    return done.stdout.strip()


def numbers_of(version: str) -> tuple[int, ...]:
    """
    Return the three numbers of a version.

    :raises RefusalError: if it does not have three.
    """
    if not re.fullmatch(r'(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)', version):
        msg = f'the version "{version}" is not three numbers, such as 1.0.0'
        raise RefusalError(msg)
    return tuple(map(int, version.split('.')))


def check(version: str) -> None:
    """
    Check that there can be a release, before anything is changed.

    :raises RefusalError: if there cannot.
    """
    last = ET.parse(ROOT / 'package.xml').getroot().findtext('version') or ''
    if numbers_of(version) < numbers_of(last):
        msg = f'the version {version} is lower than {last} in package.xml'
        raise RefusalError(msg)
    if changed := git('status', '--porcelain', '--untracked-files=no'):
        msg = f'there are changes that are not committed: {" ".join(changed.split())}'
        raise RefusalError(msg)
    for tag in tags_of(version):
        if git('tag', '--list', tag):
            msg = f'there is a tag {tag} already'
            raise RefusalError(msg)
    if get_forthcoming_label((ROOT / CHANGELOGS[0]).read_text(encoding='utf-8')) is None:
        msg = f'{CHANGELOGS[0]} has no section "{FORTHCOMING_LABEL}"'
        raise RefusalError(msg)
    if not Path(git('--exec-path'), 'git-subtree').exists():
        msg = 'git has no command subtree; install it, on Fedora and RHEL as git-subtree'
        raise RefusalError(msg)


def tags_of(version: str) -> tuple[str, str]:
    """Return the tags of the release, and of the interfaces in it."""
    return version, f'interfaces-{version}'


def changelog_of_release(text: str, version: str, date: str) -> str:
    """Give the forthcoming changes of a changelog the number of their version."""
    title = f'{version} ({date})'
    label = get_forthcoming_label(text)
    if label is not None:
        return str(rename_section(text, label, title))
    last = re.search(r'^\d+\.\d+\.\d+ \(', text, re.MULTILINE)
    place = last.start() if last else len(text)
    return f'{text[:place]}{title}\n{"-" * len(title)}\n* No changes.\n\n{text[place:]}'


def release(version: str) -> None:
    """
    Make the commit, the tags and the branch.

    :raises RefusalError: if this is not possible.
    """
    check(version)
    date = datetime.now(timezone.utc).date().isoformat()
    for name in MANIFESTS:
        text = (ROOT / name).read_text(encoding='utf-8')
        text = re.sub('(<version>).*(</version>)', rf'\g<1>{version}\g<2>', text, count=1)
        (ROOT / name).write_text(text, encoding='utf-8')
    for name in CHANGELOGS:
        text = (ROOT / name).read_text(encoding='utf-8')
        (ROOT / name).write_text(changelog_of_release(text, version, date), encoding='utf-8')
    tag, tag_of_interfaces = tags_of(version)
    git('commit', '--quiet', '--message', version, '--', *MANIFESTS, *CHANGELOGS)
    git('subtree', 'split', '--prefix', INTERFACES, '--branch', BRANCH)
    git('tag', '--annotate', '--message', version, tag)
    git('tag', '--annotate', '--message', version, tag_of_interfaces, BRANCH)
    print(f'The release {version} is made here; to publish it:\n'
          f'  git push origin HEAD {BRANCH} {tag} {tag_of_interfaces}')


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Make a release.

    :return: 0, or 1 after one sentence on stderr.
    """
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[1])
    parser.add_argument('version', help='three numbers, such as 1.0.0')
    try:
        release(parser.parse_args(arguments).version)
    except RefusalError as refusal:
        print(f'There is no release: {refusal}.', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
