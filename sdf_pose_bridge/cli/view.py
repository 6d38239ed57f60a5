# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose view``: show frames and shapes in 3D, in a browser or in a file."""

from __future__ import annotations

import argparse
from functools import partial
import importlib
import os
import signal
import sys
import time
from typing import Any

from sdf_pose_bridge.cli.loading import add_file_arguments
from sdf_pose_bridge.cli.loading import add_frame_arguments
from sdf_pose_bridge.cli.loading import load_file
from sdf_pose_bridge.cli.loading import scene_of
from sdf_pose_bridge.cli.loading import tf_options_from_arguments
from sdf_pose_bridge.cli.printing import add_output_argument
from sdf_pose_bridge.cli.printing import add_unit_arguments
from sdf_pose_bridge.cli.printing import CommandError
from sdf_pose_bridge.cli.printing import units_from_arguments
from sdf_pose_bridge.cli.set import set_pose
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.sdformat.file_watcher import FileWatcher
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS

_FORMATS = ('.html', '.png')
_PORT = 8080
_PERIOD_S = 0.05
_ROOM = 'sdf_pose_bridge.cli.viewer'
_NEEDS_VISER = "this needs viser, trimesh and pycollada: pip install 'sdf_pose_bridge[view]'"


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'view', help='show frames and shapes in 3D',
        description='Show the frames of a file as axes (x red, y green, z blue) and the shapes of '
                    'visuals and collisions, with a slider for each joint. The page is served to '
                    'this machine alone, opens in the browser and follows the file until Ctrl-C. '
                    'With -o it is written instead, without sliders.')
    add_file_arguments(parser, takes_many=False)
    add_output_argument(parser, _FORMATS, 'a page for .html, or a picture for .png')
    add_frame_arguments(parser, DEFAULT_KINDS)
    add_unit_arguments(parser)
    parser.add_argument(
        '--port', type=int, default=_PORT, metavar='N',
        help=f'the port of the page, or the next free one; by default {_PORT}')
    parser.add_argument(
        '--edit', action='store_true',
        help='let a frame be dragged in the page, and its pose be written into the file as by '
             '"sdf_pose set"')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """
    Show a file.

    :return: exit code: 0.
    :raises CommandError: if it cannot be shown or written.
    """
    try:
        # Other commands need none of this.
        servers, pages, meshes = (
            importlib.import_module(f'{_ROOM}.{name}') for name in ('server', 'page', 'meshes'))
    except ImportError:
        raise CommandError(_NEEDS_VISER) from None
    # Else a browser that draws a picture would outlive this process.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    path = options.files[0]
    watcher, read_since_ns = FileWatcher(), time.time_ns()
    scene = scene_of(path, options, shapes=True)
    watcher.watch(scene.files, read_since_ns)
    reader = meshes.MeshReader(resource_finder(options.resource_paths, os.environ))
    server = servers.server_for_this_machine(0 if options.output else options.port)
    page = pages.Page(
        server, tf_options_from_arguments(options), units_from_arguments(options), reader,
        partial(set_pose, options=options) if options.edit else None)
    try:
        for line in page.show(scene):
            print(f'sdf_pose view: {line}', file=sys.stderr)
        if options.output is None:
            _open(f'http://{servers.ADDRESS}:{server.get_port()}')
            _follow(page, watcher, options)
        else:
            servers.write_page(server, path, options.output)
    except OSError as error:
        msg = f'cannot write {options.output}: {error}'
        raise CommandError(msg) from error
    finally:
        reader.close()
        server.stop()
    return 0


def _open(address: str) -> None:
    # This is imported here because the other commands need not wait for it.
    import webbrowser
    print(address, flush=True)
    if not webbrowser.open(address):
        print('sdf_pose view: there is no browser; open the address above in one',
              file=sys.stderr)


def _follow(page: Any, watcher: FileWatcher, options: argparse.Namespace) -> None:
    """Show the file again whenever it, or a file that it includes, changes; never returns."""
    while True:
        page.act(_PERIOD_S)
        if not watcher.has_changed():
            continue
        read_since_ns = time.time_ns()
        loaded = load_file(options.files[0], options, shapes=True)
        errors = loaded.errors
        if loaded.scene is not None:
            watcher.watch(loaded.scene.files, read_since_ns)
            try:
                page.show(loaded.scene)
            except SdfError as error:
                errors = error.errors
        if errors:
            page.show_errors(list(map(str, errors)))
