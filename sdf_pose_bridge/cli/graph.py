# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
``sdf_pose graph``: draw references of poses, attachments and joints.

The graph is written in the language DOT; the program ``dot`` of Graphviz lays it out and draws it.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
import shutil
import subprocess

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.cli.arguments import (
    add_file_arguments,
    add_kinds_argument,
    add_model_argument,
    add_output_argument,
)
from sdf_pose_bridge.cli.input_files import scene_of
from sdf_pose_bridge.cli.printing import CommandError, write_text
from sdf_pose_bridge.file_change import replace_file
from sdf_pose_bridge.limited_process import end_with_parent
from sdf_pose_bridge.printed_text import printable, shortened
from sdf_pose_bridge.process_limits import lift_limits
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.tree import elements_in_model

_FORMATS = ('.svg', '.png', '.pdf', '.dot')
_KINDS = (Kind.MODEL, Kind.LINK, Kind.JOINT, Kind.FRAME)
_HEAD = """\
digraph frames {
  ranksep=0.3; nodesep=0.2; fontname=Helvetica; fontsize=11; labelloc=t; labeljust=l
  node [fontname=Helvetica fontsize=11 height=0.3 margin="0.1,0.04" style=filled color=gray40]
  edge [arrowsize=0.6]
"""
_LEGEND = (
    'Arrows start at the frame that a pose is relative to: blue for relative_to in the file, gray '
    'by default.\\lGreen: attached_to, and also relative to unless a blue arrow leads there.\\l'
    'Bold: from the parent of a joint to the joint, and on to its child, the default reference of '
    'a joint.\\lBoxes: violet for models, green for links, light blue for frames, gray for worlds,'
    ' white for others. Yellow ellipses are joints.\\l')
_STYLES = {
    Kind.ROOT: 'shape=box style="filled,bold" fillcolor=gray90',
    Kind.WORLD: 'shape=box style="filled,bold" fillcolor=gray90',
    Kind.MODEL: 'shape=box fillcolor="#ded6f5" fontname="Helvetica-Bold"',
    Kind.LINK: 'shape=box fillcolor="#d5efd0"', Kind.JOINT: 'shape=ellipse fillcolor="#fff3bf"',
    Kind.FRAME: 'shape=box style="filled,rounded" fillcolor="#d4eef7"'}
_OTHER_STYLE = 'shape=box fillcolor=whitesmoke'
_DEFAULT, _RELATIVE_TO, _ATTACHED_TO, _JOINT = 'gray70', 'royalblue', 'forestgreen', 'black'

HELP = 'draw references of poses, attachments and joints'
DESCRIPTION = (
    'Draw the frames of a file: the frame that each pose is relative to, '
    'attachments, and joints with their types. Without -o the graph is printed in '
    'the language DOT. Drawing needs the program dot of Graphviz, which takes '
    'long for thousands of frames: --model draws one model.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_file_arguments(parser, takes_many=False)
    add_output_argument(
        parser, _FORMATS, f'the graph; the ending says the format: {", ".join(_FORMATS)}')
    add_kinds_argument(parser, 'draw', _KINDS)
    add_model_argument(parser)


def run(options: argparse.Namespace) -> int:
    """Draw the graph of a file; return 0."""
    scene = scene_of(options.files[0], options)
    _write(dot_from_scene(scene, options.kinds, options.model), options.output, scene.files)
    return 0


def dot_from_scene(scene: Scene, kinds: Sequence[Kind] = _KINDS, model: str = '') -> str:
    """
    Write the graph of a scene in the language DOT.

    :param model: scoped name of the only model to draw; empty for everything.
    :return: the text, one node or arrow in a line.
    :raises UnknownFrameError: if there is no such model.
    """
    is_chosen = elements_in_model(scene, model) & np.isin(scene.kinds, kinds)
    edges = _edges(scene, is_chosen)
    # Both ends of each arrow are drawn too, such as the world.
    shown = sorted({*np.flatnonzero(is_chosen).tolist(), *chain.from_iterable(edges)})
    lines = [f'  label="{_LEGEND}"', *_nodes(scene, shown)]
    for (start, end), colors in edges.items():
        width = ' penwidth=2.5' if colors[0] == _JOINT else ''
        # Several colors make several parallel lines.
        lines.append(f'  n{start} -> n{end} [color="{":".join(colors)}"{width}]')
    return _HEAD + '\n'.join(lines) + '\n}\n'


def _edges(scene: Scene, is_chosen: NDArray[np.bool_]) -> dict[tuple[int, int], list[str]]:
    """Return the colors of the arrows from one element to another."""
    edges: defaultdict[tuple[int, int], list[str]] = defaultdict(list)
    joints = {joint.element for joint in scene.joints}
    for joint in scene.joints:
        if is_chosen[joint.element]:
            edges[joint.parent, joint.element] = [_JOINT]
            edges[joint.element, joint.child] = [_JOINT]
    for element in np.flatnonzero(is_chosen & (scene.references >= 0)).tolist():
        reference, default = scene.references.item(element), scene.default_references.item(element)
        is_attached = scene.kinds[element] == Kind.FRAME and default != scene.parents[element]
        if is_attached:
            edges[default, element].append(_ATTACHED_TO)
        if reference != default:
            edges[reference, element].append(_RELATIVE_TO)
        elif not is_attached and element not in joints:
            edges[reference, element].append(_DEFAULT)
    return edges


def _nodes(scene: Scene, shown: Sequence[int]) -> Iterator[str]:
    """Write the nodes; a box contains the nodes of a model and of its nested models."""
    joint_types = {joint.element: joint.type for joint in scene.joints}
    boxes: list[int] = []
    for element in shown:
        kind = Kind(scene.kinds[element])
        models_around = set(scene.with_ancestors(element))
        while boxes and boxes[-1] not in models_around:
            boxes.pop()
            yield f'{"  " * len(boxes)}  }}'
        if kind is Kind.MODEL:
            yield f'{"  " * len(boxes)}  subgraph cluster_{element} {{ label=""; color=gray60'
            boxes.append(element)
        label = _escaped(scene.own_name(element))
        if element in joint_types:
            label += f'\\n{_escaped(joint_types[element])}'
        yield (f'{"  " * len(boxes)}  n{element} [label="{label}" '
               f'{_STYLES.get(kind, _OTHER_STYLE)}]')
    yield from (f'{"  " * depth}}}' for depth in range(len(boxes), 0, -1))


def _escaped(name: str) -> str:
    return printable(shortened(name)).replace('\\', '\\\\').replace('"', '\\"')


def _write(text: str, path: Path | None, inputs: Sequence[str]) -> None:
    """Write a graph in the format of the path."""
    if path is None or path.suffix.lower() == '.dot':
        write_text(text, path, inputs)
        return
    if shutil.which('dot') is None:
        msg = ('the program dot is not installed; install the package graphviz, or write a file '
               'that ends with .dot')
        raise CommandError(msg)
    done = subprocess.run(
        ['dot', f'-T{path.suffix[1:].lower()}'],
        input=text.encode(), capture_output=True, check=False, preexec_fn=_prepare_dot)
    if done.returncode:
        msg = f'dot cannot draw the graph: {done.stderr.decode(errors="replace").strip()}'
        raise CommandError(msg)
    replace_file(str(path), None, done.stdout, inputs)


def _prepare_dot() -> None:
    lift_limits()
    end_with_parent()
