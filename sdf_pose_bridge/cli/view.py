# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose view``: show frames and shapes in 3D, in a browser or in a file."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
import contextlib
from functools import partial
import importlib
import os
from pathlib import Path
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import time
from types import ModuleType
from typing import Any

from sdf_pose_bridge.cli.arguments import (
    add_file_arguments,
    add_frame_arguments,
    add_output_argument,
    add_unit_arguments,
    argument_type,
    tf_options_from_arguments,
)
from sdf_pose_bridge.cli.input_files import loader, scene_from_file, STANDARD_INPUT
from sdf_pose_bridge.cli.printing import CommandError, print_problems
from sdf_pose_bridge.cli.viewer import LIBRARIES, UntestedViserError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.export.pose_setting import pose_change
from sdf_pose_bridge.file_change import replace_file, signals_wait
from sdf_pose_bridge.file_watcher import FileWatcher
from sdf_pose_bridge.geometry.units import Units
from sdf_pose_bridge.limited_process import LimitedProcess
from sdf_pose_bridge.problems import by_message, errors_of_process
from sdf_pose_bridge.process_limits import FOR_FILES
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.include.uris import resource_finder

_FORMATS = ('.html', '.png')
_PORT = 8080
_PERIOD_S, _SETTLING_S, _TABS_S = 0.05, 0.03, 1.0
_EMPTY = b'<sdf version="1.11"><world name="empty"/></sdf>'

BROWSERS = ('chromium', 'chromium-browser', 'google-chrome', 'chrome')
# WebGL in software if there is no graphics card; no requests except from the page.
_BROWSER_OPTIONS = (
    '--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--disable-quic',
    # 1600 x 1000 pixels, so that names can be read where the picture is shown smaller.
    '--window-size=1120,700', '--force-device-scale-factor=1.4286', '--hide-scrollbars',
    # Milliseconds without activity of the page before the picture is drawn. On a busy machine, the
    # time stands still for ever unless each frame waits for all of its stages.
    '--virtual-time-budget=10000', '--run-all-compositor-stages-before-draw')
_ONLY_THE_SCENE = ('<style>body :not(canvas, :has(canvas)) {visibility: hidden} '
                   '.labels div {visibility: visible}</style>')
_MOST_SECONDS, _LONGEST_END_S = 300.0, 5.0

HELP = 'show frames and shapes in 3D'
DESCRIPTION = (
    'Show the frames of a file as axes (x red, y green, z blue) and the shapes of '
    'visuals and collisions, with a slider for each joint. The page is served to '
    'this machine alone, opens in the browser and follows the file until Ctrl-C. '
    'With -o it is written instead, without sliders.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_file_arguments(parser, takes_many=False)
    add_output_argument(parser, _FORMATS, 'a page for .html, or a picture for .png')
    add_frame_arguments(parser)
    add_unit_arguments(parser)
    parser.add_argument(
        '--port', default=_PORT, metavar='N',
        type=argument_type(int, 'is not a port, 0 to 65535', lambda port: 0 <= port < 2 ** 16),
        help=f'the port of the page, or the next free one; by default {_PORT}')
    parser.add_argument(
        '--edit', action='store_true',
        help='drag frames in the page, and write their poses into the file as "sdf_pose set" does')


def run(options: argparse.Namespace) -> int:
    """Show a file, or write it; return 0."""
    if options.files[0] == STANDARD_INPUT and options.edit:
        msg = 'the standard input cannot be changed, as --edit would; name a file'
        raise CommandError(msg)
    viewer = _viewer()
    # It is made before the server starts threads, and its own standard streams lead nowhere.
    read = partial(scene_from_file, shapes=True, terminal=os.dup(2))
    with contextlib.closing(LimitedProcess()) as process:
        (path,), read_since_ns = options.files, time.time_ns()
        call = partial(_result_of_process, process, path)
        load = partial(call, read, path, options)
        errors: Sequence[SdfError] = ()
        try:
            scene = load()
        except SdfError as error:
            # The page waits until the file is mended.
            if options.output or options.model or not os.path.isfile(path):  # noqa: PTH113
                raise
            scene, errors = load_text(_EMPTY, path), error.errors
        print_problems(errors, scene.warnings, sys.stderr)
        meshes = viewer.MeshReader(resource_finder(options.resource_paths), process)
        try:
            pages = viewer.Pages(
                scene, tf_options_from_arguments(options), 0 if options.output else options.port,
                Units(options.length_unit, options.angle_unit), meshes,
                partial(call, partial(pose_change, load=loader(path, options, shapes=True)))
                if options.edit else None)
        except UntestedViserError as error:
            raise CommandError(str(error)) from error
        with contextlib.closing(pages):
            for line in () if errors else pages.reasons:
                print(f'sdf_pose view: {line}', file=sys.stderr)
            if options.output is not None:
                _write(pages.html(), options.output, {*scene.files, *meshes.files})
                return 0
            if errors:
                pages.show_errors(_lines(errors))
            _open(pages, options.port)
            watcher = FileWatcher()
            # The standard input cannot be read again.
            watcher.watch(
                () if path == STANDARD_INPUT else {
                    *scene.files, *(str(error.place.file) for error in errors if error.place)},
                read_since_ns)
            while True:
                _follow(pages, watcher, load)


def _viewer() -> ModuleType:
    """Import the viewer, which other commands do not need."""
    from importlib.metadata import version
    try:
        for library in LIBRARIES:
            name, oldest = re.split('>=|,', library)[:2]
            found = version(name)
            numbers = [[*map(int, re.findall(r'\d+', each)[:3])] for each in (found, oldest)]
            if numbers[0] < numbers[1]:
                msg = f'this needs {name} {oldest} or newer and found {found}: {_how_to_install()}'
                raise CommandError(msg)
        return importlib.import_module('sdf_pose_bridge.cli.viewer.page')
    except ImportError as error:
        msg = (f'this needs viser, trimesh and pycollada, and {error.name} is missing: '
               f'{_how_to_install()}')
        raise CommandError(msg) from None


def _how_to_install() -> str:
    libraries = ' '.join(f"'{library}'" for library in LIBRARIES)
    is_of_the_system = sys.prefix == sys.base_prefix and Path(
        sysconfig.get_path('stdlib'), 'EXTERNALLY-MANAGED').exists()
    if not is_of_the_system:
        return f'pip install {libraries}'
    return (
        'python3 -m venv --system-site-packages ~/sdf_pose_view && '
        f'~/sdf_pose_view/bin/pip install {libraries}; then '
        f'"~/sdf_pose_view/bin/python {shlex.quote(sys.argv[0])} view" is this command (apt has '
        'no viser, and pip installs nothing beside the packages of apt)')


def _open(pages: Any, port: int) -> None:
    # Imported here because other commands do not need it.
    import webbrowser
    if port and f':{port}/' not in pages.address:
        print(f'sdf_pose view: port {port} is in use', file=sys.stderr)
    print(f'open {pages.address} in a browser; Ctrl-C ends this program', flush=True)
    # A tab of the last start that is in view asks for the page by itself.
    if not pages.was_asked.wait(_TABS_S):
        webbrowser.open(pages.address)


def _follow(pages: Any, watcher: FileWatcher, load: Callable[[], Scene]) -> None:
    """Process requests, and show the file again if it or an included file has changed."""
    pages.act(_PERIOD_S)
    if not watcher.notices_change():
        return
    # Some editors write in steps, and a file that has just changed would be read twice.
    pages.act(_SETTLING_S)
    read_since_ns = time.time_ns()
    try:
        scene = load()
        watcher.watch(scene.files, read_since_ns)
        pages.show(scene)
    except SdfError as error:
        # The scene that is shown may lack the file that is broken.
        watcher.watch_also(str(each.place.file) for each in error.errors if each.place)
        pages.show_errors(_lines(error.errors))


def _lines(errors: Sequence[SdfError]) -> Iterator[str]:
    return (f'{error}{other_lines}' for error, other_lines in by_message(errors))


def _write(html: str, path: Path, inputs: Iterable[str]) -> None:
    try:
        content = _picture(html, path) if path.suffix.lower() == '.png' else html.encode()
    except OSError as error:
        msg = f'cannot write {path}: {error}'
        raise CommandError(msg) from error
    replace_file(str(path), None, content, inputs)


def _result_of_process(
    process: LimitedProcess, path: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function that reads the file in another process."""
    with errors_of_process(path):
        return process.call(FOR_FILES, function, *arguments)


def _picture(page: str, output: Path) -> bytes:
    """Draw a page by a browser; raise an OSError if there is none, or it does not draw."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        msg = 'a picture needs Chrome or Chromium; a file that ends with .html does not'
        raise FileNotFoundError(msg)
    # A browser of snap has a /tmp of its own, and does not see hidden folders. Other processes of
    # a browser may still write after the first one has ended.
    with signals_wait() as signals, tempfile.TemporaryDirectory(
            prefix='sdf_pose_view_', dir=output.absolute().parent,
            ignore_cleanup_errors=True) as folder:
        source, picture = Path(folder, 'page.html'), Path(folder, 'picture.png')
        source.write_text(page + _ONLY_THE_SCENE, encoding='utf-8')
        command = [browser, *_BROWSER_OPTIONS, f'--user-data-dir={folder}',
                   f'--screenshot={picture}', source.as_uri()]
        ends_at = time.monotonic() + _MOST_SECONDS
        with subprocess.Popen(
                command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and not signals and time.monotonic() < ends_at:
                time.sleep(_PERIOD_S)
            # It ends its other processes, unless it is killed.
            process.terminate()
            try:
                process.wait(_LONGEST_END_S)
            except subprocess.TimeoutExpired:
                process.kill()
        if picture.exists():
            return picture.read_bytes()
    msg = (f'{browser} wrote no picture into that folder; a browser of snap, as on Ubuntu, writes '
           'only below the home folder, and into no folder whose name begins with "."')
    raise ChildProcessError(msg)
