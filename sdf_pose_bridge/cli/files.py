# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the commands that read files have in common: their arguments, and how they load."""

from __future__ import annotations

import argparse
from typing import NamedTuple

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.scene.loading import load
from sdf_pose_bridge.scene.loading import MissingInclude
from sdf_pose_bridge.scene.scene import Scene


class Loaded(NamedTuple):
    """What came of a file."""

    scene: Scene | None
    """The scene; None for a file that is not valid."""
    errors: tuple[SdfError, ...]
    warnings: tuple[SdfWarning, ...]


def add_file_arguments(parser: argparse.ArgumentParser) -> None:
    """
    Declare the arguments that say which files are read, and how.

    :param parser: the parser of a command.
    """
    parser.add_argument('files', metavar='FILE', nargs='+', help='an SDFormat file')
    parser.add_argument(
        '-I', dest='resource_paths', metavar='DIR', action='append', default=[],
        help='a directory to look in for included models, before those of GZ_SIM_RESOURCE_PATH '
             'and SDF_PATH; may be given more than once')
    parser.add_argument(
        '--skip-missing', action='store_true',
        help='leave out includes that cannot be found, with a warning')


def load_file(path: str, options: argparse.Namespace) -> Loaded:
    """
    Load a file as the arguments say.

    :param path: one of the files.
    :param options: what was parsed.
    :return: its scene, or what is wrong with it.
    """
    missing = MissingInclude.SKIP if options.skip_missing else MissingInclude.ERROR
    try:
        scene = load(
            path, resource_paths=options.resource_paths, on_missing_include=missing)
    except SdfError as error:
        return Loaded(None, error.errors, error.warnings)
    return Loaded(scene, (), scene.warnings)
