# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make a release in a scratch clone, and try it as users and the release tools of ROS do.

What this needs from the network is fetched once, into .underlay-release; the rest uses none.
"""

import argparse
from collections.abc import Callable, Iterator
import contextlib
import hashlib
import json
import os
from pathlib import Path
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

from caller import environment_of_caller
from make_release import environment_of_git
import yaml

ROOT = Path(__file__).resolve().parents[1]
CACHE = ROOT / '.underlay-release'
TOOLS = CACHE / 'tools/bin'
WHEELS = CACHE / 'wheels'
LOCK = ROOT / 'underlay/release.txt'
BRIDGE, INTERFACES = 'sdf_pose_bridge', 'sdf_pose_bridge_interfaces'
PLATFORMS = (
    ('jazzy', 'ubuntu', 'noble'), ('jazzy', 'rhel', '9'),
    ('kilted', 'ubuntu', 'noble'), ('kilted', 'rhel', '9'),
    ('lyrical', 'ubuntu', 'resolute'), ('lyrical', 'rhel', '10'))
"""Distribution, system and version, for which the build farm builds packages."""
PLACEHOLDERS = ('<owner>', 'example.org')


class CheckError(Exception):
    """What is wrong with the release."""


def run(*command: object, cwd: Path = ROOT, **environment: str) -> str:
    """
    Run a command without what the caller's shell has set for Python and ROS.

    :return: what it prints.
    :raises CheckError: if it fails.
    """
    kept = environment_of_caller(environment_of_git())
    kept.pop('LD_LIBRARY_PATH', None)
    done = subprocess.run(
        list(map(str, command)), cwd=cwd, env={**kept, **environment}, text=True, check=False,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        msg = f'"{" ".join(map(str, command))}" fails:\n{done.stdout}'
        raise CheckError(msg)
    return done.stdout


def expect(found: object, wanted: object, what: str) -> None:
    """
    Compare what was found.

    :raises CheckError: if it is something else.
    """
    if found != wanted:
        msg = f'{what}: this is {found!r} and should be {wanted!r}'
        raise CheckError(msg)


def is_here(version: str) -> bool:
    """Tell whether there is a Python that runs."""
    with contextlib.suppress(OSError):
        return not subprocess.run(
            [f'python{version}', '-c', ''], capture_output=True, check=False).returncode
    return False


def declared() -> tuple[list[str], list[str]]:
    """Return what the package and its tests need, and for which Pythons they are, by setup.py."""
    code = ('import json, runpy, setuptools; found = {}; setuptools.setup = found.update; '
            'runpy.run_path("setup.py"); found.pop("cmdclass"); print(json.dumps(found))')
    found = json.loads(run(sys.executable, '-c', code))
    pythons = re.findall(r':: (3\.\d+)$', '\n'.join(found['classifiers']), re.MULTILINE)
    return found['install_requires'] + found['extras_require']['test'], pythons


def prepare() -> list[str]:
    """
    Fetch the tools and the wheels of what the package needs, for each Python.

    :return: the versions of Python.
    """
    requirements, pythons = declared()
    wanted = json.dumps([hashlib.sha256(LOCK.read_bytes()).hexdigest(), requirements, pythons])
    stamp = CACHE / 'stamp'
    if stamp.exists() and stamp.read_text() == wanted:
        return pythons
    print('fetching the release tools, and wheels for each Python ...', flush=True)
    shutil.rmtree(CACHE, ignore_errors=True)
    run(sys.executable, '-m', 'venv', TOOLS.parent)
    pip = (TOOLS / 'python', '-m', 'pip', '--disable-pip-version-check', '--quiet')
    run(*pip, 'install', '--require-hashes', '-r', LOCK)
    for version in pythons:
        run(*pip, 'download', '--only-binary', ':all:', '--python-version', version,
            '--dest', WHEELS, 'setuptools>=77', 'wheel', *requirements)
    (CACHE / 'COLCON_IGNORE').touch()
    stamp.write_text(wanted)
    return pythons


class Release:
    """
    A release in a scratch clone.

    :param scratch: an empty folder.
    :param pythons: the versions of Python for which it is.
    """

    def __init__(self, scratch: Path, pythons: list[str]) -> None:
        self._scratch, self._pythons = scratch, pythons
        self._clone = scratch / 'clone'
        run('git', 'clone', '--quiet', ROOT, self._clone)
        last = ET.parse(self._clone / 'package.xml').getroot().findtext('version') or ''
        major, minor, patch = map(int, last.split('.'))
        self._version = f'{major}.{minor}.{patch + 1}'
        self._distributions: list[Path] = []

    def is_made(self) -> str:
        """Make the commit, the tags and the branch."""
        for name, value in (('user.name', 'release check'), ('user.email', 'check@localhost'),
                            ('commit.gpgSign', 'false'), ('tag.gpgSign', 'false')):
            run('git', 'config', name, value, cwd=self._clone)
        run(TOOLS / 'python', 'release/make_release.py', self._version, cwd=self._clone)
        for tag, package in self._tags():
            run('git', 'worktree', 'add', '--quiet', '--detach', self._scratch / package, tag,
                cwd=self._clone)
        commit = run('git', 'rev-parse', '--short', 'HEAD').strip()
        return f'version {self._version} of {commit}'

    def _tags(self) -> tuple[tuple[str, str], tuple[str, str]]:
        return (self._version, BRIDGE), (f'interfaces-{self._version}', INTERFACES)

    def is_found(self) -> str:
        """Let the release tools find the packages, each in the root of its tag."""
        code = ('import json; from catkin_pkg.packages import find_packages; print(json.dumps('
                '{path: [p.name, p.version] for path, p in find_packages(".").items()}))')
        for tag, package in self._tags():
            found = json.loads(
                run(TOOLS / 'python', '-c', code, cwd=self._scratch / package).splitlines()[-1])
            expect(found, {'.': [package, self._version]}, f'packages in tag {tag}')
        return 'by catkin_pkg, one package in each tag'

    def is_packaged(self) -> str:
        """Generate the files from which packages for each platform are built."""
        index = self._scratch / 'index'
        write_index(index, self._version)
        environment = {
            'PATH': f'{TOOLS}:{os.environ["PATH"]}', 'ROS_HOME': str(index / 'home'),
            'ROSDISTRO_INDEX_URL': (index / 'index-v4.yaml').as_uri(),
            'ROSDEP_SOURCE_PATH': str(index / 'sources.list.d')}
        run(TOOLS / 'rosdep', 'update', **environment)
        for distro, system, name in PLATFORMS:
            kind = 'debian' if system == 'ubuntu' else 'rpm'
            for _, package in self._tags():
                source = self._scratch / package
                run(TOOLS / 'bloom-generate', f'ros{kind}', '--ros-distro', distro,
                    '--os-name', system, '--os-version', name, cwd=source, **environment)
                self._check_generated(source / kind, distro, package, kind)
                shutil.rmtree(source / kind)
        return ', '.join(f'{distro} on {system} {name}' for distro, system, name in PLATFORMS)

    def _check_generated(self, folder: Path, distro: str, package: str, kind: str) -> None:
        name = f'ros-{distro}-{package}'.replace('_', '-')
        if kind == 'debian':
            control, changelog = (
                (folder / file).read_text(encoding='utf-8') for file in ('control', 'changelog'))
            expect(control.splitlines()[0], f'Source: {name}', 'debian/control')
            expect(changelog.startswith(f'{name} ({self._version}-'), True, 'debian/changelog')
            expect('no changelog for this version' in changelog, False, 'a changelog is missing')
            return
        (spec,) = folder.glob('*.spec')
        text = spec.read_text(encoding='utf-8')
        expect(re.findall('^(?:Name|Version): *(.*)$', text, re.M), [name, self._version], 'spec')

    def is_built(self) -> str:
        """Build the source distribution, and the wheel from it."""
        target = self._scratch / 'dist'
        run(TOOLS / 'python', '-m', 'build', '--no-isolation', '--outdir', target,
            cwd=self._scratch / BRIDGE)
        self._distributions = sorted(target.iterdir())
        expect([path.name.partition('-')[2] for path in self._distributions],
               [f'{self._version}-py3-none-any.whl', f'{self._version}.tar.gz'], 'distributions')
        run(TOOLS / 'twine', 'check', '--strict', *self._distributions)
        return '"twine check --strict" accepts wheel and sdist'

    def is_installed(self) -> str:
        """Install the wheel, and the sdist, for each Python, and start the programs."""
        here = [version for version in self._pythons if is_here(version)]
        for version in here:
            for path in self._distributions:
                self._try_programs(self._environment(version, path))
        missing = sorted(set(self._pythons) - set(here))
        return f'wheel and sdist with Python {", ".join(here)}' + (
            f'\nNOT TESTED, because this machine does not have it: Python {", ".join(missing)}'
            if missing else '')

    def _environment(self, version: str, *what: object) -> Path:
        """Install something into a new environment, and return the folder of its programs."""
        folder = Path(tempfile.mkdtemp(dir=self._scratch, prefix=f'python{version}-'))
        run(f'python{version}', '-m', 'venv', '--without-pip', folder)
        pip = (TOOLS / 'python', '-m', 'pip', '--python', folder / 'bin/python', 'install',
               '--disable-pip-version-check', '--quiet', '--no-index', '--find-links', WHEELS)
        # The sdist is built by the setuptools of the environment, and needs no other.
        run(*pip, 'setuptools', 'wheel', cwd=folder)
        run(*pip, '--no-build-isolation', *what, cwd=folder)
        return folder / 'bin'

    def _try_programs(self, programs: Path) -> None:
        ours = {path.name for path in programs.iterdir()} & {'bridge', 'sdf_pose', BRIDGE}
        expect(ours, {'sdf_pose', BRIDGE}, 'programs')
        cell = self._scratch / BRIDGE / 'examples/work_cell.sdf'
        expect(run(programs / 'sdf_pose', '--version'), f'sdf_pose {self._version}\n', '--version')
        expect(run(programs / 'sdf_pose', 'check', cell), '', 'sdf_pose check')
        poses = json.loads(run(programs / 'sdf_pose', 'poses', '--json', cell))
        expect(len(poses['elements']) > 40, True, 'sdf_pose poses')
        node = subprocess.run(
            [programs / BRIDGE], capture_output=True, text=True, check=False,
            env={'PATH': os.environ['PATH']})
        expect((node.returncode, 'the Python module rclpy is missing' in node.stderr), (1, True),
               f'{BRIDGE} without ROS')

    def passes_its_tests(self) -> str:
        """Run the tests that need no ROS, from the source distribution."""
        version = f'3.{sys.version_info.minor}'
        wheel, archive = self._distributions
        folder = self._scratch / 'unpacked'
        folder.mkdir()
        run('tar', '-xzf', archive, '-C', folder)
        (source,) = folder.iterdir()
        programs = self._environment(version, f'{BRIDGE}[test] @ {wheel.as_uri()}')
        printed = run(programs / 'python', '-m', 'pytest', '-q', '-p', 'no:cacheprovider',
                      cwd=source, PATH=f'{programs}:{os.defpath}')
        return f'{printed.splitlines()[-1]}, with Python {version}'

    def has_no_placeholders(self) -> str:
        """Check that the addresses in package.xml are real ones."""
        root = ET.parse(ROOT / 'package.xml').getroot()
        texts = [root.findtext('url') or '', root.find('maintainer').get('email') or '']
        if wrong := [text for text in texts if any(word in text for word in PLACEHOLDERS)]:
            msg = f'package.xml has no real address yet, but {" and ".join(wrong)}'
            raise CheckError(msg)
        return ', '.join(texts)


def write_index(folder: Path, version: str) -> None:
    """Write an index of ROS distributions, with a list for rosdep, that needs no network."""
    manifests = [ROOT / 'package.xml', ROOT / INTERFACES / 'package.xml']
    keys = {
        element.text for file in manifests for element in ET.parse(file).getroot()
        if element.tag.endswith('depend')}
    rosdep = yaml.safe_load((ROOT / 'release/rosdep.yaml').read_text(encoding='utf-8'))
    of_ros = sorted(keys - rosdep.keys() - {BRIDGE, INTERFACES})

    def repository(name: str, packages: list[str]) -> dict[str, object]:
        return {'release': {
            'packages': packages, 'tags': {'release': 'release/{package}/{version}'},
            'url': f'https://localhost/{name}.git', 'version': f'{version}-1'}}

    repositories = {name: repository(name, [name]) for name in (BRIDGE, INTERFACES)}
    repositories['ros'] = repository('ros', of_ros)
    folder.mkdir()
    (folder / 'sources.list.d').mkdir()
    (folder / 'sources.list.d/10-local.list').write_text(
        f'yaml {(ROOT / "release/rosdep.yaml").as_uri()}\n')
    distributions = {}
    for distro in sorted({distro for distro, _, _ in PLATFORMS}):
        platforms: dict[str, list[str]] = {}
        for _, system, name in (each for each in PLATFORMS if each[0] == distro):
            platforms.setdefault(system, []).append(name)
        description = {
            'type': 'distribution', 'version': 2, 'release_platforms': platforms,
            'repositories': repositories}
        cache = {'type': 'cache', 'version': 2, 'name': distro,
                 'distribution_file': [description], 'release_package_xmls': {}}
        (folder / f'{distro}.yaml').write_text(yaml.safe_dump(description))
        (folder / f'{distro}-cache.yaml').write_text(yaml.safe_dump(cache))
        distributions[distro] = {
            'distribution': [f'{distro}.yaml'], 'distribution_status': 'active',
            'distribution_cache': (folder / f'{distro}-cache.yaml').as_uri(),
            'distribution_type': 'ros2', 'python_version': 3}
    (folder / 'index-v4.yaml').write_text(yaml.safe_dump(
        {'type': 'index', 'version': 4, 'distributions': distributions}))


def steps(release: Release, *, only_installs: bool) -> Iterator[tuple[str, Callable[[], str]]]:
    """Give the steps of the check with their titles."""
    yield 'made', release.is_made
    if not only_installs:
        yield 'found', release.is_found
        yield 'packaged', release.is_packaged
    yield 'built', release.is_built
    yield 'installed', release.is_installed
    if not only_installs:
        yield 'tested', release.passes_its_tests
        yield 'addressed', release.has_no_placeholders


def main() -> int:
    """
    Check the last commit.

    :return: 0, or 1 after the reason why it cannot be released.
    """
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[1])
    parser.add_argument('--only-installs', action='store_true',
                        help='only install the wheel and the sdist, and start their programs')
    options = parser.parse_args()
    title = 'prepared'
    try:
        pythons = prepare()
        with tempfile.TemporaryDirectory(prefix='sdf_pose_bridge_release_') as scratch:
            release = Release(Path(scratch), pythons)
            for title, step in steps(release, only_installs=options.only_installs):
                print(f'{title}: {step()}', flush=True)
    except CheckError as error:
        print(f'not {title}: {error}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
