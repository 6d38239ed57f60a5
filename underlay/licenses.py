#!/usr/bin/env python3
# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Print a Markdown table of the licences of everything that the lock files install here."""

from collections import defaultdict
from importlib.metadata import distribution, PackageNotFoundError
from pathlib import Path
import re
import sys
from xml.etree import ElementTree as ET

HERE = Path(__file__).resolve().parent


def licence_of_ros_package(name: str) -> str:
    """
    Return the licence that a package.xml declares; wheels of ROS packages declare none.

    :param name: name of the wheel.
    :return: the licences, or an empty string.
    """
    package = re.sub('^ros-(jazzy-|kilted-)?', '', name).replace('-', '_')
    manifest = Path(sys.prefix, 'share', package, 'package.xml')
    if not manifest.exists():
        return ''
    return ', '.join(sorted({each.text or '' for each in ET.parse(manifest).iter('license')}))


def licence_of_wheel(name: str) -> str:
    """
    Return the licence that a wheel declares.

    :param name: name of the wheel.
    :return: the licence, or an empty string.
    """
    metadata = distribution(name).metadata
    classifiers = [
        each.rpartition(' :: ')[2] for each in metadata.get_all('Classifier') or ()
        if each.startswith('License :: ')]
    return (metadata['License-Expression'] or ', '.join(classifiers)
            or (metadata['License'] or '').partition('\n')[0])


def main() -> None:
    """Print the table."""
    names = {name for lock in HERE.glob('*.txt') for name in re.findall(
        r'^([A-Za-z0-9._-]+)==', lock.read_text(encoding='utf-8'), re.MULTILINE)}
    packages = defaultdict(list)
    for name in sorted(names):
        try:
            licence = licence_of_wheel(name) or licence_of_ros_package(name) or 'not declared'
        except PackageNotFoundError:  # for another Python or another system
            continue
        packages[licence].append(name)
    print('| licence | packages |\n| --- | --- |')
    for licence, members in sorted(packages.items()):
        print(f'| {licence} | {", ".join(members)} |')


if __name__ == '__main__':
    main()
