# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Build and install the Python package; with ROS and without it."""

import configparser
import os
from pathlib import Path
import re
import shutil
import sys
from typing import Any
import xml.etree.ElementTree as ET

import setuptools
from setuptools import find_packages, setup
from setuptools.command.install_scripts import install_scripts

# Links of files need not lead here, as where colcon builds with links.
ROOT = Path(__file__).resolve().parent
PACKAGE = 'sdf_pose_bridge'
MANIFEST = ET.parse(ROOT / 'package.xml').getroot()
VERSION = MANIFEST.findtext('version')
URL = MANIFEST.findtext('url')
LICENSE = MANIFEST.findtext('license')
SHARE = f'share/{PACKAGE}'
NOT_INSTALLED = ('__pycache__', '.pytest_cache', '.mypy_cache', '.ruff_cache')
COMMAND_LINE = 'sdf_pose = sdf_pose_bridge.__main__:main'
# For `ros2 run`, which finds executables by the name of their package.
ROS_EXECUTABLES = [
    COMMAND_LINE, 'bridge = sdf_pose_bridge.ros.node.bridge:main',
    'robot_state_publisher = sdf_pose_bridge.ros.node.bridge:robot_state_publisher']
# In the PATH, where `bridge` is a program of iproute2.
COMMANDS = [COMMAND_LINE, 'sdf_pose_bridge = sdf_pose_bridge.ros.node.bridge:main']
MAKES_A_WHEEL = not {'bdist_wheel', 'dist_info', 'editable_wheel'}.isdisjoint(sys.argv)
if MAKES_A_WHEEL:
    # Modules that were deleted since an older build would be installed too.
    shutil.rmtree(ROOT / 'build/lib', ignore_errors=True)


def shared_folders() -> list[str]:
    """Return the folders in the root that are installed in share/."""
    settings = configparser.ConfigParser()
    settings.read(ROOT / 'setup.cfg')
    return settings[PACKAGE]['share'].split()


def text_of(tag: str) -> str:
    """Return the text of an element of package.xml, in one line."""
    return ' '.join(MANIFEST.findtext(tag, '').split())


def readme_for_an_index() -> str:
    """Return README.md with links, and pictures, that lead into the repository from anywhere."""
    text = (ROOT / 'README.md').read_text(encoding='utf-8')
    text = re.sub(r'(!\[[^]]*\]\()(?!\w+:)', rf'\1{URL}/raw/{VERSION}/', text)
    return re.sub(r'(\]\()(?!\w+:|#)', rf'\1{URL}/blob/{VERSION}/', text)


def data_files_of(folder: str) -> list[tuple[str, list[str]]]:
    """
    Return the files below a folder as setuptools wants them.

    :param folder: name of a folder in the root, also one that does not exist.
    :return: a list of (target folder, files) pairs that keeps the subfolders.
    """
    found = []
    for path, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if name not in NOT_INSTALLED)
        if files:
            sources = [str(Path(path, name)) for name in sorted(files)]
            found.append((f'{SHARE}/{Path(path).as_posix()}', sources))
    return found


class InstallScripts(install_scripts):
    """
    Writes the executables of a ROS workspace, which import what they call.

    Those of setuptools look their entry point up first, which takes longer than to read a file and
    publish it. In them signals wait, before anything is imported, until the function that they
    call handles them. A process that the program starts by multiprocessing imports the
    executable, which does nothing then.
    """

    def write_script(self, script_name: str, contents: str, *args: Any, **kwargs: Any) -> None:
        """Write an executable, with the first line that setuptools gives it."""
        (entry,) = (
            text for text in self.distribution.entry_points['console_scripts']
            if text.split(' = ')[0] == script_name)
        module, function = entry.split(' = ')[1].split(':')
        first_line = contents.partition('\n')[0]
        program = (
            'import signal',
            'signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM])',
            'import sys', f'from {module} import {function}', f'sys.exit({function}())')
        lines = [
            first_line, '# PYTHON_ARGCOMPLETE_OK', "if __name__ == '__main__':",
            *(f'    {line}' for line in program), '']
        super().write_script(script_name, '\n'.join(lines), *args, **kwargs)


setup(
    name=PACKAGE,
    version=VERSION,
    description=text_of('description'),
    long_description=readme_for_an_index(),
    long_description_content_type='text/markdown',
    url=URL,
    project_urls={
        'Documentation': f'{URL}/tree/{VERSION}/docs',
        'Issues': f'{URL}/issues',
        'Changelog': f'{URL}/blob/{VERSION}/CHANGELOG.rst',
    },
    author=text_of('author'),
    maintainer=text_of('maintainer'),
    maintainer_email=MANIFEST.find('maintainer').get('email'),
    # setuptools 77 is the first that knows expressions of SPDX as such.
    **{'license_expression' if int(setuptools.__version__.split('.')[0]) >= 77 else 'license':
       LICENSE},
    keywords=[
        'ros', 'ros2', 'sdformat', 'sdf', 'gazebo', 'urdf', 'tf', 'tf2', 'robotics', 'transforms'],
    classifiers=[
        'Development Status :: 4 - Beta',
        'Environment :: Console',
        'Intended Audience :: Developers',
        'Intended Audience :: Manufacturing',
        'Intended Audience :: Science/Research',
        'Operating System :: POSIX :: Linux',
        'Programming Language :: Python :: 3',
        *(f'Programming Language :: Python :: 3.{minor}' for minor in range(10, 15)),
        'Topic :: Scientific/Engineering',
        'Typing :: Typed',
    ],
    python_requires='>=3.10',
    # Each with the oldest release that the tests pass with, and below the first that they do not
    # know. docs/releasing.md says how this is tested.
    install_requires=['numpy>=1.26.4,<3', 'lxml>=5.2.1,<7'],
    # By the first colcon knows that it is pytest that runs the tests.
    extras_require={
        'test': ['pytest', 'hypothesis', 'mpmath'],
        # For sdf_pose view, whose pictures need Chrome or Chromium as well.
        'view': ['viser>=1.1.1,<1.2', 'trimesh>=5.0,<6', 'pycollada>=0.7.2,<0.10'],
    },
    packages=find_packages(include=[PACKAGE, f'{PACKAGE}.*']),
    package_data={PACKAGE: ['py.typed'], f'{PACKAGE}.cli.viewer': ['page.css', 'page.js']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (SHARE, ['package.xml']),
        ('share/man/man1', ['resource/sdf_pose.1']),
        ('share/bash-completion/completions', ['resource/completions/sdf_pose']),
        # pip puts its own program of this name there.
        *([] if MAKES_A_WHEEL else [('bin', ['resource/bin/sdf_pose'])]),
        *(pair for folder in shared_folders() for pair in data_files_of(folder)),
    ],
    cmdclass={'install_scripts': InstallScripts},
    entry_points={'console_scripts': COMMANDS if MAKES_A_WHEEL else ROS_EXECUTABLES},
    zip_safe=True,
)
