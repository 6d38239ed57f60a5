# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Describe frames in HTML; texts from a file are escaped."""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
import html
import math
from pathlib import Path
import shlex
from xml.sax.saxutils import quoteattr

import numpy as np

from sdf_pose_bridge import Kind, Pose, Scene
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.export.pose_setting import place_of_pose
from sdf_pose_bridge.geometry.formats import converted_poses
from sdf_pose_bridge.geometry.pose_texts import TEXT_FORMATS
from sdf_pose_bridge.geometry.poses import relative_pose
from sdf_pose_bridge.geometry.rotations import Floats, matrix_from_quaternion
from sdf_pose_bridge.geometry.units import POSE_LABELS, Unit, Units
from sdf_pose_bridge.names import is_name_of_proxy, SEPARATOR
from sdf_pose_bridge.printed_text import printable, quoted_names
from sdf_pose_bridge.tf.parents import NO_PARENT, ROOT_IS_PARENT

MOST_ROWS = 300
"""Largest number of rows of the tree of frames in the page; a search finds the others."""

_SIGNS = {'model': '\u25a2', 'link': '\u25cf', 'sensor': '\u25c6'}
"""The signs of the kinds of frames; other frames have a cross."""
_EYES, _FOLDS = ('\u25c9', '\u25cb'), ('\u25be', '\u25b8')
"""The signs of a frame that is shown or hidden, and of one that is open or folded."""


def escaped(text: str) -> str:
    """Return a text for HTML, without control characters and without markup."""
    return html.escape(printable(text))


def html_of_data(name: str, value: str) -> str:
    """Return a hidden element that passes a value to the script."""
    return f'<meta data-{name}="{html.escape(value)}">'


def html_of_copy_button(text: str, label: str = '') -> str:
    """Return a button that copies a text, with a label of the text for those who do not see."""
    name = html.escape(f'copy {label or text}')
    return f'<button data-copy="{html.escape(text)}" aria-label="{name}">copy</button>'


def html_of_frame(shown: ShownScene, frame: int, reference: int, units: Units) -> str:
    """
    Describe a frame.

    :param reference: index of another one, or ``ROOT_IS_PARENT`` for the root frame.
    :param units: units of poses to read; poses to copy are in metres and radians.
    :return: names, place in the file, poses in the root, the parent and the other frame, and the
        last pose in formats to copy.
    """
    scene, tree, ids = shown.scene, shown.tree, shown.ids
    element = shown.element_of(frame)
    rows = [(ids[frame], f'<b>{escaped(ids[frame])}</b> {shown.labels[frame]}')]
    if element >= 0:
        rows += [(text, escaped(text)) for text in (
            scene.names[element], str(scene.place(element)))]
    lines = [html_of_copy_button(printable(text)) + row for text, row in rows]
    lines += [
        '<br>'.join((f'in <b>{escaped(ids[other])}</b>',
                     *_texts(units, shown.pose_in(other, frame))))
        for other in dict.fromkeys((reference, ROOT_IS_PARENT, int(tree.parents[frame])))
        if other not in (NO_PARENT, frame)]
    pose, other = shown.pose_in(reference, frame), shown.element_of(reference)
    # Smaller differences are rounding errors. Adding zero removes negative zeros.
    rpy, quat, franka = (
        (converted_poses([pose], 'sdf_quat_xyzw', name)[0].round(12) + 0.0).tolist()
        for name in ('sdf_rpy', 'sdf_quat_xyzw', 'franka_matrix'))
    publisher = 'static_transform_publisher'
    copied = {
        'SDF': f'<pose{_relative_to(scene, element, other)}>{_text(rpy)}</pose>',
        publisher: f'{TEXT_FORMATS[publisher].template.format(*quat)} ' + shlex.join(
            ['--frame-id', ids[reference], '--child-frame-id', ids[frame]]),
        'x y z, quaternion x y z w': _text(quat),
        'Franka matrix': str(franka),
    }
    forms = ''.join(
        f'<div>{html_of_copy_button(text, label)}{label}<code>{html.escape(text)}</code></div>'
        for label, text in copied.items())
    return f'<div class="description">{"<br>".join(lines)}{forms}</div>'


def _text(values: Sequence[float]) -> str:
    return ' '.join(map(repr, values))


def _texts(units: Units, pose: Pose) -> tuple[str, str]:
    texts = units.texts(pose)
    return (f'xyz {" ".join(texts[:3])} {units.length.name}',
            f'rpy {" ".join(texts[3:])} {units.angle.name}')


def _relative_to(scene: Scene, element: int, reference: int) -> str:
    """Return the attribute of a pose; empty if SDFormat has no name for the reference."""
    if reference < 0:
        return ''
    holder = int(scene.parents[element]) if element >= 0 else -1
    scope = scene.names[holder] + SEPARATOR if holder >= 0 else ''
    return f' relative_to={quoteattr(scene.names[reference].removeprefix(scope))}'


def html_of_selection(
    shown: ShownScene, drawn: ShownScene, frame: int, reference: int, units: Units,
) -> str:
    """
    Describe a frame in a few lines.

    :param drawn: the scene with the new pose that is drawn, if there is one.
    :return: its pose in another frame, the pose that places it in its file, and the other frames
        that the new pose moves.
    """
    is_moved = (np.abs(drawn.poses - shown.poses) > 1e-9).any(axis=1)
    names = [shown.ids[index] for index in np.flatnonzero(is_moved).tolist() if index != frame]
    moved = f'<div class="moved">moves with it: {escaped(quoted_names(names))}</div>'
    return (f'<b>{escaped(shown.ids[frame])}</b> in {escaped(shown.ids[reference])}: '
            f'{", ".join(_texts(units, drawn.pose_in(reference, frame)))}'
            f'<div>{escaped(_pose_in_file(shown, frame, units))}</div>{moved if names else ""}')


def html_of_points(shown: ShownScene, points: Floats, frame: int, unit: Unit) -> str:
    """
    Write the distance of two points in the root frame, and their difference in it and in a frame.

    :param points: shape (n, 3); if there are no two of them, this says what to click.
    """
    if len(points) < 2:
        return f'<div>click on a shape for point {len(points) + 1} of 2; Escape ends it</div>'
    texts = [f'{unit.rounded(math.dist(*points))} {unit.name} from point 1 to 2']
    for other in dict.fromkeys((ROOT_IS_PARENT, frame)):
        xyz = (points[1] - points[0]) @ matrix_from_quaternion(shown.poses[other, 3:])
        texts.append(f'xyz {" ".join(map(unit.rounded, xyz))} in {escaped(shown.ids[other])}')
    return f'<div>{", ".join(texts)}</div>'


def _pose_in_file(shown: ShownScene, frame: int, units: Units) -> str:
    """Write the pose that places a frame in its file; empty for a frame without an element."""
    scene, element = shown.loaded, shown.element_of(frame)
    if element < 0:
        return ''
    path, line, is_written = place = place_of_pose(scene, element)
    reference = int(scene.references[element])
    if scene.kinds[reference] == Kind.JOINT and place_of_pose(scene, reference) == place:
        # The <origin> of a joint of URDF, which places the link too.
        element, reference = reference, int(scene.references[reference])
    pose = scene.relative_pose_of(scene.placements.get(element, element), reference)
    return (f'in the file {Path(path).resolve()}:{line}{_relative_to(scene, element, reference)}: '
            + (', '.join(_texts(units, pose)) if is_written else 'no pose'))


def html_of_difference(old: Pose, new: Pose, reference: Pose, units: Units) -> str:
    """
    Write the current and the new pose of a frame and their difference side by side.

    :param reference: the pose of the frame that they are shown relative to; all three are in the
        root frame.
    """
    columns = [units.texts(relative_pose(reference, pose)) for pose in (old, new)]
    rows = ''.join(
        f'<tr><td>{label} [{unit.name}]</td><td>{before}</td><td>{after}</td>'
        f'<td>{float(after) - float(before):+.{unit.digits}f}</td></tr>'
        for label, unit, before, after in zip(
            POSE_LABELS, units.of_pose, *columns, strict=True))
    return (f'<table class="difference"><tr><td></td><td>old</td><td>new</td><td>change</td></tr>'
            f'{rows}</table>')


def html_of_lines(name: str, lines: Iterable[str]) -> str:
    """Return lines in an element of this class; empty if there are none."""
    text = '\n'.join(map(escaped, lines))
    return text and f'<pre class="{name}">{text}</pre>'


def html_of_reasons(lines: Sequence[str]) -> str:
    """Return the reasons why shapes are not drawn: the first one, and the others on request."""
    if len(lines) < 2:
        return html_of_lines('reasons', lines)
    return (f'<details class="reasons"><summary>{escaped(lines[0])}; and {len(lines) - 1} more'
            f'</summary>{html_of_lines("others", lines[1:])}</details>')


def html_of_tree(
    shown: ShownScene, search: str, selected: str, folded: Container[str], hidden: Container[str],
) -> str:
    """
    List frames, each below its parent in TF, but not those that only a merge has named.

    :param search: a part of the ids of the frames to list; empty for all of them.
    :param selected: the id of the selected frame.
    :param folded: the ids of frames whose children are not listed, unless they are searched.
    :param hidden: the ids of frames that are hidden.
    """
    ids, children = shown.tree.frame_ids, dict[int, list[int]]()
    for index, parent in enumerate(shown.tree.parents.tolist()):
        children.setdefault(parent, []).append(index)
    waiting = [(index, 0) for other in (NO_PARENT, ROOT_IS_PARENT)
               for index in reversed(children.get(other, ()))]
    rows, wanted = list[str](), search.lower()
    while waiting and len(rows) < MOST_ROWS:
        index, depth = waiting.pop()
        frame_id, kind, below = ids[index], shown.labels[index], children.get(index, ())
        if wanted in frame_id.lower() and not is_name_of_proxy(
                frame_id.rpartition('/')[2]):
            text = frame_id if search else shown.short_names[index]
            name, data = escaped(text), html.escape(frame_id)
            sign = _FOLDS[frame_id in folded] if below and not search else ''
            rows.append(
                f'<div role=none style="padding-left:{0 if search else min(depth, 20)}em">'
                f'<button tabindex=-1 data-ask="fold {data}" aria-label="fold {name}"'
                f' aria-pressed={str(frame_id in folded).lower()}>{sign}</button>'
                f'<b title="{kind}" aria-hidden=true>{_SIGNS.get(kind, "+")}</b>'
                f'<button tabindex=-1 data-ask="select {data}" role=treeitem'
                f' title="{escaped(frame_id)}" aria-label="{name}, {kind}" aria-level={depth + 1}'
                f'{" class=selected aria-selected=true" if frame_id == selected else ""}>'
                f'{name}</button><button tabindex=-1 data-ask="hide {data}" title="show or hide"'
                f' aria-label="hide {name}" aria-pressed={str(frame_id in hidden).lower()}>'
                f'{_EYES[frame_id in hidden]}</button></div>')
        if search or frame_id not in folded:
            waiting += [(child, depth + 1) for child in reversed(below)]
    if not search and len(rows) < len(ids):
        rows.append(f'{len(ids) - len(rows)} more, to be found by the search')
    return ('<div class="rows" role=tree aria-label=frames tabindex=0 '
            f'data-search={quoteattr(search)}>{"".join(rows)}</div>')
