# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the part of a scene that is not hidden, and draw it by viser."""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import islice
import json
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
import viser

from sdf_pose_bridge import Kind
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.cli.viewer.surfaces import (
    boxes_of_surfaces,
    DrawnSurface,
    lines_from_not_drawn,
    surfaces_from_scene,
)
from sdf_pose_bridge.cli.viewer.view_point import (
    bounds_of_interest,
    bounds_of_points,
    bounds_with_axes,
    grid_spacing_m,
    home_view,
)
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.geometry.units import Unit
from sdf_pose_bridge.printed_text import printable, shortened
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import TfTree

MOST_NAMES = 500
"""Largest number of names that are shown at once."""

NAMES = 'names of frames'
GROUPS = ('visuals', 'collisions', 'all lines to parents', 'grid')
"""Groups that can be hidden, besides ``NAMES`` and the kinds of frames by their labels."""
HIDDEN_AT_FIRST = frozenset(('collisions', NAMES, 'all lines to parents'))
"""The groups that a page hides at first."""

_WXYZ = [6, 3, 4, 5]
_LINE_COLOR = (255, 146, 43)
_MEASURED_COLOR = (230, 73, 128)
_GRID_COLOR = (134, 141, 149)
_COLLISION_RGBA = (0.05, 0.62, 0.55, 1.0)
_LIGHT_FROM_BELOW = (120, 124, 130)
_LIGHTS = ((1.9, (0.35, -0.6, 1.0)), (0.8, (-0.6, 0.8, 0.4)))
"""The intensity of each light, and the direction to it."""


class VisiblePart:
    """
    The frames and bodies of a scene that are not hidden.

    :param hidden: the groups and kinds of frames that are hidden.
    :param hidden_ids: the ids of frames that are hidden, with all that is in them.
    """

    def __init__(
        self, shown: ShownScene, meshes: MeshReader,
        hidden: Collection[str] = HIDDEN_AT_FIRST, hidden_ids: Collection[str] = (),
    ) -> None:
        scene, tree = shown.scene, shown.tree
        self.shown, self.hidden = shown, frozenset(hidden)
        ids, elements = np.array(tree.frame_ids, object), tree.elements
        is_hidden = np.isin(ids, [*hidden_ids])
        is_shown = shown.is_in_model & ~scene.are_in(elements[is_hidden].tolist())
        # An optical frame is shown with its parent.
        elements = np.where(elements < 0, elements[np.maximum(tree.parents, 0)], elements)
        self.frames = np.flatnonzero(
            is_shown[elements] & ~np.isin(shown.labels, [*hidden]) & ~is_hidden)
        """The frames, indices into the TF tree."""
        bodies = [element for element in scene.shapes if is_shown[element]
                  and f'{Kind(scene.kinds[element]).label}s' not in hidden]
        origins = shown.poses[:, :3]
        self.surfaces, not_drawn = surfaces_from_scene(
            scene, bodies, _extent_m(origins, scene.poses[bodies, :3]), meshes)
        """The surfaces of visuals and collisions."""
        self.reasons = lines_from_not_drawn(not_drawn)
        """Lines that say which shapes cannot be drawn, or that there are no frames."""
        if not len(ids):
            self.reasons.append('this file has no frames')
        self.names = json.dumps({
            'frames': [printable(ids[frame]) for frame in self.frames],
            'bodies': [
                [printable(f'{shown.ids[tree.nearest_frames[element]]}, {surface.kind.label} '
                           f'{scene.own_name(element)}') for element in surface.elements]
                for surface in self.surfaces]})
        """The names that the page shows at the pointer: those of all axes, and of the copies of
        each surface, in the order of the nodes; of a copy its frame, and the body in it."""
        self.bodies = np.array(
            [element for surface in self.surfaces for element in surface.elements], int)
        """The visual or collision of each copy of each surface."""
        boxes = boxes_of_surfaces(scene, self.surfaces)
        self.size_m = _extent_m(origins, boxes)
        """The extent of everything."""
        self.range_m = 0.001 * self.size_m, 100.0 * self.size_m
        """The distances between which a camera sees."""
        origins = origins[self.frames]
        robot = np.concatenate([
            origins[shown.is_in_robot[elements[self.frames]]],
            # A model alone is shown as a whole.
            boxes[shown.is_in_robot[self.bodies]].mean(axis=1) if scene.world_names
            else boxes.reshape(-1, 3)])
        models = scene.parents[scene.parents[self.bodies]]
        is_part = np.bincount(scene.parents[scene.kinds == Kind.LINK], minlength=1)[models] > 1
        is_plane = np.array([scene.shapes[body].type == 'plane' for body in self.bodies], bool)
        bounds = bounds_of_interest(origins, boxes[~is_plane], is_part[~is_plane], robot)
        self.view_m = math.dist(*bounds) or self.size_m
        """The extent of the first view, without axes."""
        self.axes_length_m = _length_of_axes(tree, self.view_m)
        self.bounds = bounds_with_axes(bounds, shown.poses[self.frames], self.axes_length_m)
        """The lowest and the highest corner of the first view, shape (2, 3)."""
        self.home = home_view(self.bounds, origins, boxes)
        """The first view."""
        sizes_m = np.linalg.norm(boxes[:, 1] - boxes[:, 0], axis=1)
        self.ground_m = boxes[sizes_m <= self.view_m, 0, 2].min(initial=0.0)
        """The height of the ground, on which the grid is."""

    def bounds_of_frame(self, shown: ShownScene, frame: int) -> Floats:
        """Return the lowest and the highest corner of a frame and the bodies in its element."""
        is_in = shown.scene.are_in([shown.element_of(frame)])[self.bodies]
        reach_m = np.array([[-3.0], [3.0]]) * self.axes_length_m
        return bounds_of_points(
            shown.poses[frame, :3] + reach_m, boxes_of_surfaces(shown.scene, self.surfaces)[is_in])


class Drawing:
    """
    The nodes that show a part of a scene, until they are removed.

    :param name: the name of their parent node. It must differ from the previous one, as a browser
        mixes up nodes that are removed and added again at once.
    :param select: called with the id of the clicked frame.
    """

    def __init__(
        self, nodes: viser.SceneApi, name: str, visible: VisiblePart,
        select: Callable[[str], None],
    ) -> None:
        self._nodes, self._name, self._select = nodes, name, select
        self._node = nodes.add_frame(name, show_axes=False)
        self.visible, length_m = visible, visible.axes_length_m
        """The part that is drawn."""
        self._add_surroundings()
        self._marker = nodes.add_frame(
            f'{name}/selected', axes_length=2.0 * length_m, axes_radius=0.06 * length_m,
            visible=False)
        self._lines, self._measured = (
            nodes.add_line_segments(
                f'{name}/{lines}', np.zeros((0, 2, 3)), color, thickness=width,
                thickness_units='screen')
            for lines, color, width in (
                ('lines to parents', _LINE_COLOR, 2.0), ('measured', _MEASURED_COLOR, 3.0)))
        self._axes = nodes.add_batched_axes(
            f'{name}/frames', *_places(visible.shown.poses[visible.frames]),
            axes_length=length_m, axes_radius=0.035 * length_m)
        self._select_by_click(self._axes, visible.frames)
        self._copies = [
            (self._add_surface(number, surface), surface.elements)
            for number, surface in enumerate(visible.surfaces)]

    def remove(self) -> None:
        """Remove the nodes."""
        self._node.remove()

    def show(self, shown: ShownScene, frame: int, ends: Floats, unit: Unit) -> str:
        """
        Show other positions of joints, larger axes for a frame, and lines to its ancestors.

        :param frame: its index, or -1 for none.
        :param ends: shape (n, 3): points to mark, with a line between the two if there are two.
        :param unit: the unit of the length of this line.
        :return: in JSON, the labels: for each name of a frame or a missing mesh, and for the
            length of the line, its text, whether names do not cover it, and x, y and z of the
            point that it is right of and below; and the number of names that are too many.
        """
        scene, visible, origins = shown.scene, self.visible, shown.poses[:, :3]
        self._axes.batched_wxyzs, self._axes.batched_positions = _places(
            shown.poses[visible.frames])
        for copies, elements in self._copies:
            copies.batched_wxyzs, copies.batched_positions = _places(scene.poses[elements])
        children = visible.frames.tolist()
        if 'all lines to parents' in visible.hidden:
            # Those from the frame to its root.
            children = [frame]
            while children[-1] >= 0:
                children.append(int(shown.tree.parents[children[-1]]))
            children.pop()
        parents = shown.tree.parents[children]
        self._lines.points = np.stack(
            [origins[parents], origins[children]], axis=1)[parents != NO_PARENT]
        missing = (element for surface in visible.surfaces if surface.reason
                   for element in surface.elements)
        labels = [
            (printable(shortened(scene.shapes[element].mesh_uri.rpartition('/')[2])) + '?', True,
             *scene.poses[element, :3])
            for element in islice(missing, MOST_NAMES)]
        arms = 0.3 * visible.axes_length_m * np.eye(3)
        measured = [np.zeros((0, 2, 3)), *(np.stack([end - arms, end + arms], 1) for end in ends)]
        if len(ends) == 2:
            measured.append(ends[np.newaxis])
            labels.insert(0, (
                f'{unit.rounded(math.dist(*ends))} {unit.name}', True, *ends.mean(axis=0)))
        self._measured.points = np.concatenate(measured)
        named = visible.frames[:0 if NAMES in visible.hidden else None].tolist()
        labels += [
            (printable(shortened(shown.short_names[index])), index == frame, *origins[index])
            for index in dict.fromkeys((*named[:MOST_NAMES], frame)) if index >= 0]
        self._marker.visible = frame >= 0
        self._marker.wxyz, self._marker.position = _places(shown.poses[frame])
        return json.dumps(
            {'labels': labels, 'unlisted': len({*named} - {*named[:MOST_NAMES], frame})})

    def _add_surroundings(self) -> None:
        """Add light from above and from two sides, and a grid on the ground."""
        nodes, name, visible = self._nodes, self._name, self.visible
        nodes.add_light_hemisphere(
            f'{name}/sky', ground_color=_LIGHT_FROM_BELOW, intensity=1.7)
        # Far away and without decay, so that their rays are parallel.
        for number, (intensity, direction) in enumerate(_LIGHTS):
            nodes.add_light_point(
                f'{name}/sun {number}', intensity=intensity, decay=0.0,
                position=tuple(100.0 * visible.size_m * np.array(direction)))
        if 'grid' in visible.hidden:
            return
        spacing_m = grid_spacing_m(visible.view_m)
        per_m, unit = (1.0, 'm') if spacing_m >= 0.01 else (
            (1e3, 'mm') if spacing_m >= 1e-4 else (1e6, '\u03bcm'))
        middle = np.round(visible.bounds.mean(axis=0)[:2] / spacing_m) * spacing_m
        width_m = 2.0 * spacing_m * np.ceil(visible.view_m / spacing_m)
        # A little above the floors of many files.
        height_m = visible.ground_m + 0.001 * visible.view_m
        nodes.add_grid(
            f'{name}/grid', width_m, width_m, cell_size=spacing_m, section_size=spacing_m,
            section_color=_GRID_COLOR, shadow_opacity=0.0, fade_distance=4.0 * visible.view_m,
            position=(*middle, height_m))
        to_camera = 0.2 * (visible.home.position - visible.home.look_at)[:2]
        nodes.add_label(
            f'{name}/grid spacing', f'grid {per_m * spacing_m:g} {unit}', font_screen_scale=0.8,
            position=(*(middle + spacing_m * np.round(to_camera / spacing_m)), height_m))

    def _add_surface(self, number: int, surface: DrawnSurface) -> Any:
        is_collision, shown = surface.kind == Kind.COLLISION, self.visible.shown
        # The script counts the children of the drawing.
        name = f'{self._name}/{surface.kind.label} {number}'
        places = _places(shown.scene.poses[surface.elements])
        if surface.part.glb:
            return self._nodes.add_batched_glb(
                name, surface.part.glb, *places, batched_scales=surface.scales, lod='off')
        rgba = np.clip(surface.rgba, 0.0, 1.0)
        if is_collision:
            rgba[:] = _COLLISION_RGBA
        copies = self._nodes.add_batched_meshes_simple(
            name, surface.part.points, surface.part.faces, *places,
            batched_scales=surface.scales,
            batched_colors=np.round(255.0 * rgba[:, :3]).astype(np.uint8),
            batched_opacities=rgba[:, 3] if (rgba[:, 3] < 1.0).any() else None,
            lod='off', wireframe=is_collision, flat_shading=not is_collision, side='double')
        self._select_by_click(copies, shown.tree.nearest_frames[surface.elements])
        return copies

    def _select_by_click(self, copies: Any, frames: NDArray[Any]) -> None:
        ids = self.visible.shown.ids
        copies.on_click(lambda event: self._select(ids[frames[event.instance_index or 0]]))


def _places(poses: Floats) -> tuple[Floats, Floats]:
    """Return quaternions w x y z and positions, as viser takes them, of poses (..., 7)."""
    return poses[..., _WXYZ], poses[..., :3]


def _extent_m(*points: Floats) -> float:
    """Return the extent of the root frame and of points, each of shape (..., 3)."""
    return float(np.ptp(bounds_of_points(np.zeros(3), *points), axis=0).max()) or 1.0


def _length_of_axes(tree: TfTree, size_m: float) -> float:
    """Return the length of axes, in metres: short where frames are many, or near to others."""
    distances_m = np.linalg.norm(tree.transforms[:, :3], axis=1)
    distances_m = distances_m[distances_m > 1e-6 * size_m]
    typical_m = np.median(distances_m) if len(distances_m) else size_m
    largest = np.clip(0.25 / math.sqrt(max(len(tree.poses), 1)), 0.01, 0.1)
    return float(np.clip(0.4 * typical_m, 0.01 * size_m, largest * size_m))
