# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Tell what this machine lacks, before the first long step starts."""

import importlib.util
import os
from pathlib import Path
import platform
import shlex
import shutil
import string
import subprocess
import sys
import sysconfig
import tempfile

from steps import RefusalError

DISTRO = os.environ.get('ROS') or 'jazzy'
"""The distribution of ROS 2 that the environment is for."""

VERSIONS = os.environ.get('VERSIONS') or ''
"""The release of Ubuntu whose versions of other packages are used; empty for the newest ones."""

TITLE = f'ROS 2 {DISTRO.capitalize()}'

FREE_BYTES_NEEDED = 1500 * 1024 * 1024
# The wheels of ROS 2 are tagged manylinux_2_28.
GLIBC_NEEDED = (2, 28)
LONGEST_PATH = 180
SAFE_CHARACTERS = frozenset(f'{string.ascii_letters}{string.digits}/._-+@~,')
NEEDED_FROM_ROS = (
    'ament_cmake', 'ament_index_python', 'geometry_msgs', 'rclpy', 'rosidl_default_generators',
    'tf2_msgs',
)


def check_root(root: Path) -> None:
    """
    Refuse a folder whose path the build tools of ROS cannot handle.

    :param root: the repository.
    :raises RefusalError: if it holds a character other than letters, digits and a few signs, or is
        too long to stand in the first line of a script.
    """
    bad = sorted({character for character in str(root) if character not in SAFE_CHARACTERS})
    if bad:
        msg = (
            f'The repository lies in {str(root)!r}, and the build tools of ROS 2 do not work in a '
            f'path with {" ".join(map(repr, bad))}; move it to a path of plain letters, digits, '
            f'".", "_" and "-".')
        raise RefusalError(msg)
    if len(str(root)) > LONGEST_PATH:
        msg = (
            f'The path of the repository, {root}, has more than {LONGEST_PATH} characters, which '
            f'is too long for the scripts in it; move it to a shorter one.')
        raise RefusalError(msg)


def check_python() -> None:
    """
    Refuse a Python that cannot make an environment, or that nothing can be compiled for.

    :raises RefusalError: if venv, pip's installer or the header files are missing.
    """
    version = platform.python_version()
    short = f'{sys.version_info.major}.{sys.version_info.minor}'
    if sys.implementation.name != 'cpython' or sysconfig.get_config_var('Py_GIL_DISABLED'):
        msg = (
            f'{sys.executable} ({sys.implementation.name} {version}) cannot be used: {TITLE} '
            f'needs the ordinary CPython; choose one with PYTHON=<command>.')
        raise RefusalError(msg)
    if not (importlib.util.find_spec('venv') and importlib.util.find_spec('ensurepip')):
        msg = (
            f'Python {version} ({sys.executable}) comes without venv; install it (on Debian and '
            f'Ubuntu: apt install python{short}-venv) or choose another with PYTHON=<command>.')
        raise RefusalError(msg)
    if not Path(sysconfig.get_config_var('INCLUDEPY') or '', 'Python.h').is_file():
        msg = (
            f'The header files of Python {version} ({sys.executable}) are missing; install them '
            f'(on Debian and Ubuntu: apt install python{short}-dev) or choose another Python with '
            f'PYTHON=<command>.')
        raise RefusalError(msg)


def check_pypi_platform() -> None:
    """
    Refuse a machine for which there are no wheels of ROS 2.

    :raises RefusalError: if it is not Linux with glibc on a 64-bit x86 processor.
    """
    machine = platform.machine()
    if sys.platform != 'linux' or machine not in {'x86_64', 'AMD64'} or sys.maxsize < 2**32:
        msg = (
            f'{TITLE} comes from PyPI for 64-bit x86 processors on Linux alone, and this is '
            f'{machine} on {platform.system()}; install {TITLE} in /opt/ros/{DISTRO} and run '
            f'this again.')
        raise RefusalError(msg)
    name, version = platform.libc_ver()
    numbers = tuple(int(part) for part in version.split('.')[:2] if part.isdigit())
    if name != 'glibc' or numbers < GLIBC_NEEDED:
        msg = (
            f'{TITLE} comes from PyPI for glibc {GLIBC_NEEDED[0]}.{GLIBC_NEEDED[1]} or newer, '
            f'and this system has {name or "no glibc"} {version}; use a newer Linux, such as '
            f'Debian 12 or Ubuntu 24.04.'.replace('  ', ' '))
        raise RefusalError(msg)


def check_ros(prefix: Path) -> None:
    """
    Refuse an installation of ROS 2 that lacks a package, or is for another Python.

    :param prefix: the installation, normally /opt/ros/jazzy.
    :raises RefusalError: with the packages to install, or the Python to choose.
    """
    missing = [
        name for name in NEEDED_FROM_ROS if not (prefix / f'share/{name}/package.xml').is_file()]
    if missing:
        debs = ' '.join(f'ros-{DISTRO}-{name.replace("_", "-")}' for name in missing)
        msg = (
            f'{TITLE} in {prefix} lacks {", ".join(missing)}; install what is missing '
            f'(on Ubuntu: apt install {debs}).')
        raise RefusalError(msg)
    short = f'{sys.version_info.major}.{sys.version_info.minor}'
    if not (prefix / f'lib/python{short}/site-packages/rclpy').is_dir():
        theirs = sorted(path.parts[-3] for path in prefix.glob('lib/python3*/site-packages/rclpy'))
        msg = (
            f'{TITLE} in {prefix} is for {theirs[0] if theirs else "another Python"}, and '
            f'this is Python {platform.python_version()} ({sys.executable}); leave PYTHON unset '
            f'or name that one.')
        raise RefusalError(msg)


def check_compiler() -> None:
    """
    Refuse a machine on which C and C++ cannot be compiled.

    :raises RefusalError: if a compiler, make, or what a small program needs is missing.
    """
    install = 'install them (on Debian and Ubuntu: apt install build-essential)'
    for language, variable, names, suffix in (
        ('C', 'CC', ('cc', 'gcc', 'clang'), '.c'),
        ('C++', 'CXX', ('c++', 'g++', 'clang++'), '.cpp'),
    ):
        chosen = os.environ.get(variable)
        command = shlex.split(chosen) if chosen else next(
            ([name] for name in names if shutil.which(name)), [])
        if not command or not shutil.which(command[0]):
            said = f' ({variable} names {chosen!r})' if chosen else ''
            msg = (
                f'There is no {language} compiler on this machine{said}, and the service types '
                f'have to be compiled; C and C++ compilers and make are needed: {install}.')
            raise RefusalError(msg)
        header = 'stdlib.h' if suffix == '.c' else 'vector'
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, f'probe{suffix}')
            source.write_text(f'#include <{header}>\nint main(void) {{ return 0; }}\n')
            result = subprocess.run(
                [*command, str(source), '-o', str(Path(folder, 'probe'))],
                capture_output=True, text=True, check=False)
        if result.returncode != 0:
            reason = (result.stderr.strip() or 'it says nothing').splitlines()[0]
            msg = (
                f'The {language} compiler {command[0]} cannot compile an empty program '
                f'({reason}); repair it, or install C and C++ compilers and make (on Debian and '
                f'Ubuntu: apt install build-essential).')
            raise RefusalError(msg)
    if not shutil.which('make'):
        msg = (
            f'There is no make on this machine; C and C++ compilers and make are needed: '
            f'{install}.')
        raise RefusalError(msg)


def check_disk(folder: Path) -> None:
    """
    Refuse a disk that is nearly full.

    :param folder: where the environment will be.
    :raises RefusalError: if less is free than the environment takes.
    """
    free = shutil.disk_usage(folder).free
    if free < FREE_BYTES_NEEDED:
        msg = (
            f'Only {free // 2**20} MiB are free on the disk of {folder}, and the environment '
            f'takes up to {FREE_BYTES_NEEDED // 2**20} MiB; make room and run this again.')
        raise RefusalError(msg)
