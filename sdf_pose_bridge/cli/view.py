# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose view``: show frames and shapes in 3D, in a browser or in a file."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Mapping
import importlib
import os
from pathlib import Path
import sys
from types import ModuleType
from typing import Any

from sdf_pose_bridge.cli.drawn_shapes import drawn_shapes_from_scene
from sdf_pose_bridge.cli.figure import figure_from_scene
from sdf_pose_bridge.cli.loading import add_file_arguments
from sdf_pose_bridge.cli.loading import add_frame_arguments
from sdf_pose_bridge.cli.loading import scene_of
from sdf_pose_bridge.cli.loading import tf_tree_of
from sdf_pose_bridge.cli.printing import add_output_argument
from sdf_pose_bridge.cli.printing import add_unit_arguments
from sdf_pose_bridge.cli.printing import printed_errors
from sdf_pose_bridge.cli.printing import units_from_arguments
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS

_FORMATS = ('.html', '.png')
_PICTURE_SIZE = {'width': 1600, 'height': 1000}
_POINT_THROUGH_SURFACES = """
const page = document.getElementById('{plot_id}');
function pointThroughSurfaces() {
  const scene = page._fullLayout.scene?._scene;
  for (const trace of page._fullData.filter(trace => trace.hoverinfo === 'skip')) {
    const drawn = scene?.traces?.[trace.uid];
    for (const part of [drawn?.mesh, drawn?.linePlot]) if (part) part.drawPick = () => {};
  }
  scene?.glplot?.update?.();
}
page.on('plotly_afterplot', pointThroughSurfaces);
pointThroughSurfaces();
"""
"""
Without this plotly finds what is nearest to the eye under the pointer, even if it has nothing to
show, and so would never find a frame inside a shape.
"""
_NEEDS_PLOTLY = ('this needs the library plotly: pip install plotly, or on Debian and Ubuntu '
                 'apt install python3-plotly')
_NEEDS_KALEIDO = ('a picture needs the library kaleido (pip install kaleido) and Chrome or '
                  'Chromium; a file that ends with .html does not')


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'view', help='show frames and shapes in 3D',
        description='Show the frames of a file as triads (x red, y green, z blue) and the shapes '
                    'of visuals and collisions, in a page that needs no network. The legend '
                    'switches kinds on and off; a frame under the pointer shows its pose. Without '
                    '-o the page opens in the browser. It needs the library plotly; boxes around '
                    'meshes need trimesh.')
    add_file_arguments(parser, takes_many=False)
    add_output_argument(parser, _FORMATS, 'a page for .html, or a picture for .png')
    add_frame_arguments(parser, DEFAULT_KINDS)
    add_unit_arguments(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """
    Show a file.

    :return: exit code: 0 if it is shown or written, else 1.
    """
    plotly = _imported('plotly.io')
    is_picture = options.output is not None and options.output.suffix.lower() == '.png'
    if plotly is None or (is_picture and _imported('kaleido') is None):
        return _fail(_NEEDS_PLOTLY if plotly is None else _NEEDS_KALEIDO)
    scene = scene_of(options.files[0], options, shapes=True)
    if scene is None:
        return 1
    figure = None
    with printed_errors():
        tree = tf_tree_of(scene, options)
        shapes, markers = drawn_shapes_from_scene(
            scene, tree, options.model, resource_finder(options.resource_paths, os.environ))
        for reason, count in Counter(marker.reason for marker in markers).items():
            what = '1 shape is' if count == 1 else f'{count} shapes are'
            print(f'sdf_pose view: {what} not drawn: {printable(reason)}', file=sys.stderr)
        figure = figure_from_scene(scene, tree, shapes, markers, units_from_arguments(options))
    if figure is None:
        return 1
    try:
        if is_picture:
            del figure['layout']['updatemenus']  # a picture has no use for buttons
            plotly.write_image(figure, options.output, **_PICTURE_SIZE)
        else:
            _write_page(plotly, figure, options.output)
    # kaleido raises these if there is no Chrome.
    except (OSError, RuntimeError, ValueError) as error:
        return _fail(f'cannot write {options.output or "the page"}: {error}'.split('\n')[0])
    return 0


def _imported(name: str) -> ModuleType | None:
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


def _fail(message: str) -> int:
    print(f'sdf_pose view: {printable(message)}', file=sys.stderr)
    return 1


def _write_page(plotly: ModuleType, figure: Mapping[str, Any], path: Path | None) -> None:
    """Write the page; to a temporary file that is opened in the browser if there is no path."""
    page = plotly.to_html(
        figure, include_plotlyjs=True, validate=False, config={'displaylogo': False},
        post_script=_POINT_THROUGH_SURFACES)
    if path is not None:
        path.write_text(page, encoding='utf-8')
        return
    # These are imported here because the other commands need not wait for them.
    import tempfile
    import webbrowser
    with tempfile.NamedTemporaryFile(
            'w', prefix='sdf_pose_view_', suffix='.html', encoding='utf-8', delete=False) as file:
        file.write(page)
    print(file.name)
    if not webbrowser.open(Path(file.name).as_uri()):
        print('sdf_pose view: there is no browser; open the file above in one', file=sys.stderr)
