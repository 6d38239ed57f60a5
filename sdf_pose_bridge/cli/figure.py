# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Describe a picture of frames and shapes in the terms of plotly (https://plotly.com/python).

The description is made of dictionaries, so this module does not import plotly.
"""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Sequence
import html
from typing import Any

import numpy as np

from sdf_pose_bridge.cli.drawn_shapes import DrawnShape
from sdf_pose_bridge.cli.drawn_shapes import Marker
from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.scene.triangles import Points
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import TfTree

_AXIS_COLORS = ('#e03131', '#2b8a3e', '#1c5fd6')
_POINT_COLORS = {
    'root': 'black', 'model': '#7048c6', 'link': '#2f9e44', 'frame': '#0c8599',
    'joint': '#e67700', 'sensor': '#c2255c', 'optical frame': '#e8590c'}
_OTHER_COLOR = '#495057'
# Frames of different kinds are often in one place, where their names must not cover one another.
_TEXT_POSITIONS = {
    'model': 'bottom center', 'link': 'top center', 'sensor': 'middle left',
    'optical frame': 'bottom left', 'joint': 'top left', 'root': 'top right'}
_OPACITY = {'visual': 0.25, 'collision': 0.2}
_DIRECTION_OF_EYE = np.array([0.75, -0.5, 0.45])
_MOST_AT_A_PLACE = 4
_LABELS = (*(kind.label for kind in Kind), 'optical frame')


def figure_from_scene(
    scene: Scene, tree: TfTree, shapes: Sequence[DrawnShape], markers: Sequence[Marker],
    units: Units,
) -> dict[str, Any]:
    """
    Describe a picture of a scene.

    :param units: units of the poses that are shown at frames.
    :return: a figure of plotly, as a dictionary.
    """
    labels = ['root', *kind_labels_of(scene, tree)]
    poses = np.concatenate([np.array([Pose()]), tree.poses])
    points = np.concatenate([poses[:, :3], *(shape.triangles.points for shape in shapes)])
    lowest, highest = points.min(axis=0), points.max(axis=0)
    size_m = float((highest - lowest).max()) or 1.0
    length_m = _length_of_axes(tree, size_m)
    names = [_text(frame_id.rpartition('/')[2]) for frame_id in (tree.root_frame, *tree.frame_ids)]
    places = np.round(poses[:, :3] / (1e-6 * size_m)).tolist()
    hovers = _joined_by_place(
        [f'<b>{_text(tree.root_frame)}</b><br>root', *_hovers(tree, labels[1:], units)], places,
        '<br>')
    data = [_surface(kind, [shape for shape in shapes if shape.kind == kind])
            for kind in dict.fromkeys(shape.kind for shape in shapes)]
    data.append(_lines_to_parents(tree))
    for label in sorted(set(labels), key=_LABELS.index):
        chosen = [index for index, other in enumerate(labels) if other == label]
        data += [
            _axes(poses[chosen], label, length_m),
            _origins(
                poses[chosen], label, _joined_by_place(
                    [names[index] for index in chosen], [places[index] for index in chosen], ', '),
                [hovers[index] for index in chosen])]
    if markers:
        data.append(_markers(markers))
    named = [index for index, trace in enumerate(data) if trace.get('mode') == 'markers+text']
    return {'data': data, 'layout': {
        'title': {'text': _text(scene.path), 'x': 0.01, 'y': 0.985, 'font': {'size': 14}},
        'margin': {'l': 0, 'r': 0, 't': 30, 'b': 0},
        'paper_bgcolor': 'white',
        'legend': {'itemsizing': 'constant', 'groupclick': 'togglegroup'},
        'hoverlabel': {'align': 'left', 'font': {'family': 'monospace'}},
        'scene': _layout_of_axes(lowest, highest, poses[:, :3]),
        'updatemenus': [{
            'type': 'buttons', 'direction': 'right', 'x': 0.01, 'y': 0.01, 'xanchor': 'left',
            'yanchor': 'bottom', 'buttons': [
                {'label': label, 'method': 'restyle', 'args': [{'mode': mode}, named]}
                for label, mode in (('names', 'markers+text'), ('no names', 'markers'))]}]}}


def _text(value: str) -> str:
    """Return a text from a file for plotly, which reads HTML in texts."""
    return html.escape(printable(shortened(value)))


def _joined_by_place(
    texts: Sequence[str], places: Iterable[Sequence[float]], separator: str,
) -> list[str]:
    """Replace each text by all texts of its place, where they would cover one another."""
    keys = [tuple(place) for place in places]
    together: dict[tuple[float, ...], list[str]] = {}
    for key, text in zip(keys, texts, strict=True):
        together.setdefault(key, []).append(text)
    joined = {
        key: separator.join([*those[:_MOST_AT_A_PLACE], *(
            [f'and {len(those) - _MOST_AT_A_PLACE} more'] if len(those) > _MOST_AT_A_PLACE
            else [])])
        for key, those in together.items()}
    return [joined[key] for key in keys]


def _layout_of_axes(lowest: Points, highest: Points, origins: Points) -> dict[str, Any]:
    """
    Give the three axes the same scale, and look at the frames.

    The scale is set here, as with the one that plotly chooses the picture would jump whenever a
    kind is switched on or off.

    :param lowest: shape (3,), the lowest coordinates of all that is drawn.
    :param highest: shape (3,), the highest ones.
    :param origins: shape (n, 3), the origins of the frames.
    :return: the layout of the scene.
    """
    size_m = float((highest - lowest).max()) or 1.0
    middle = 0.5 * (lowest + highest)
    # plotly cuts off parts of what lies at the very limit of an axis.
    sides_m = np.maximum(1.02 * (highest - lowest), 0.1 * size_m)
    first, last = origins.min(axis=0), origins.max(axis=0)
    # For the camera the largest side has the length 1.
    target = (0.5 * (first + last) - middle) / size_m
    distance = 1.7 * max(float((last - first).max()) / size_m, 0.3)
    axis = {
        'showbackground': False, 'showspikes': False, 'gridcolor': '#dee2e6',
        'zerolinecolor': '#adb5bd'}
    return {
        'aspectmode': 'manual',
        'aspectratio': dict(zip('xyz', (sides_m / size_m).tolist(), strict=True)),
        'camera': {
            'center': dict(zip('xyz', target.tolist(), strict=True)),
            'eye': dict(zip(
                'xyz', (target + distance * _DIRECTION_OF_EYE).tolist(), strict=True))},
        **{f'{name}axis': {'title': {'text': f'{name} [m]'}, 'range': limits, **axis}
           for name, limits in zip('xyz', np.transpose(
               [middle - 0.5 * sides_m, middle + 0.5 * sides_m]).tolist(), strict=True)}}


def _length_of_axes(tree: TfTree, size_m: float) -> float:
    """Return the length of axes, in metres: short where frames are near to one another."""
    distances_m = np.linalg.norm(tree.transforms[:, :3], axis=1)
    distances_m = distances_m[distances_m > 1e-6 * size_m]
    typical_m = float(np.median(distances_m)) if len(distances_m) else size_m
    return min(max(0.4 * typical_m, 0.01 * size_m), 0.1 * size_m)


def _hovers(tree: TfTree, labels: Sequence[str], units: Units) -> list[str]:
    hovers = []
    for frame_id, parent_id, label, pose, transform in zip(
            tree.frame_ids, tree.parent_ids, labels, tree.poses.tolist(),
            tree.transforms.tolist(), strict=True):
        lines = [f'<b>{_text(frame_id)}</b>', label, *_pose_lines(tree.root_frame, pose, units)]
        if parent_id not in ('', tree.root_frame):
            lines += _pose_lines(parent_id, transform, units)
        hovers.append('<br>'.join(lines))
    return hovers


def _pose_lines(reference: str, pose: Sequence[float], units: Units) -> list[str]:
    texts = units.texts(Pose(*pose))
    return [
        f'in {_text(reference)}:', f'  xyz {" ".join(texts[:3])} {units.length}',
        f'  rpy {" ".join(texts[3:])} {units.angle}']


def _surface(kind: str, shapes: Sequence[DrawnShape]) -> dict[str, Any]:
    """Join the surfaces of a kind, because each trace takes time in the browser."""
    counts = [len(shape.triangles.points) for shape in shapes]
    offsets = np.cumsum([0, *counts[:-1]])
    points = np.concatenate([shape.triangles.points for shape in shapes])
    faces = np.concatenate([
        shape.triangles.faces + offset for shape, offset in zip(shapes, offsets, strict=True)])
    colors = [
        f'rgb({",".join(str(round(255 * part)) for part in shape.rgb)})'
        for shape in shapes for _ in shape.triangles.faces]
    return {
        'type': 'mesh3d', 'name': f'{kind}s ({len(shapes)})', 'showlegend': True,
        **_columns(points, 'xyz'), **_columns(faces, 'ijk'), 'facecolor': colors,
        'color': '#adb5bd', 'opacity': _OPACITY[kind], 'flatshading': True, 'hoverinfo': 'skip',
        # Collisions are most often where visuals are.
        'visible': True if kind == 'visual' else 'legendonly'}


def _lines_to_parents(tree: TfTree) -> dict[str, Any]:
    has_parent = tree.parents != NO_PARENT
    # The last entry is the root frame, which the index of the root as a parent means.
    origins = np.concatenate([tree.poses[:, :3], np.zeros((1, 3))])
    assert ROOT_IS_PARENT == -1
    return {
        'type': 'scatter3d', 'mode': 'lines', 'name': 'lines to TF parents',
        **_segments(origins[tree.parents[has_parent]], tree.poses[has_parent, :3]),
        'line': {'color': '#868e96', 'width': 1}, 'hoverinfo': 'skip'}


def _axes(poses: PoseArray, label: str, length_m: float) -> dict[str, Any]:
    starts = np.repeat(poses[:, :3], 3, axis=0)
    # The columns of a rotation matrix are the axes.
    directions = np.swapaxes(matrix_from_quaternion(poses[:, 3:]), 1, 2).reshape(-1, 3)
    colors = [color for color in _AXIS_COLORS for _ in range(3)] * len(poses)
    return {
        'type': 'scatter3d', 'mode': 'lines', 'legendgroup': label, 'showlegend': False,
        **_segments(starts, starts + length_m * directions),
        'line': {'color': colors, 'width': 5}, 'hoverinfo': 'skip'}


def _origins(
    poses: PoseArray, label: str, names: Sequence[str], hovers: Sequence[str],
) -> dict[str, Any]:
    color = _POINT_COLORS.get(label, _OTHER_COLOR)
    return {
        'type': 'scatter3d', 'mode': 'markers+text', 'legendgroup': label,
        'name': f'{label} ({len(names)})', **_columns(poses, 'xyz'), 'text': names,
        'textposition': _TEXT_POSITIONS.get(label, 'middle right'),
        'textfont': {'size': 11, 'color': color}, 'marker': {'size': 3, 'color': color},
        'customdata': hovers, 'hovertemplate': '%{customdata}<extra></extra>'}


def _markers(markers: Sequence[Marker]) -> dict[str, Any]:
    return {
        'type': 'scatter3d', 'mode': 'markers', 'name': f'not drawn ({len(markers)})',
        **_columns(np.array([marker.pose for marker in markers]), 'xyz'),
        'marker': {'symbol': 'x', 'size': 4, 'color': '#868e96'},
        'customdata': [
            f'<b>{_text(marker.name)}</b><br>{_text(marker.reason)}' for marker in markers],
        'hovertemplate': '%{customdata}<extra></extra>'}


def _segments(starts: Points, ends: Points) -> dict[str, Any]:
    """Return the coordinates of lines, with NaN between them."""
    gaps = np.full_like(starts, np.nan)
    return _columns(np.stack([starts, ends, gaps], axis=1).reshape(-1, 3), 'xyz')


def _columns(values: np.ndarray[Any, np.dtype[Any]], names: str) -> dict[str, Any]:
    return {name: values[:, index] for index, name in enumerate(names)}

