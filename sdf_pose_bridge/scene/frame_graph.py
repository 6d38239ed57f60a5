# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Look up and check all references of poses, attachments and canonical links.

Source: ``FrameSemantics.cc`` of libsdformat. The graph that results has no cycles.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.errors import (
    AttachedToCycleError,
    AttachedToError,
    CanonicalLinkError,
    ModelWithoutLinkError,
    RelativeToCycleError,
    RelativeToError,
    SdfError,
)
from sdf_pose_bridge.geometry.chains import cycles_from_pointers, ends_from_pointers, Indices
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.printed_text import quoted_names
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.joints import JointChecks, JointEnds
from sdf_pose_bridge.scene.name_scopes import IS_FRAME_KIND, NameScopes
from sdf_pose_bridge.sdformat.elements import Elements, NO_ELEMENT
from sdf_pose_bridge.sdformat.grammar import Kind

_LONGEST_CYCLE_SHOWN = 12

_ERRORS = {
    'attached_to': AttachedToError,
    'canonical_link': CanonicalLinkError,
    'placement_frame': RelativeToError,
    'relative_to': RelativeToError,
}
"""The classes of errors about attributes that name no frame."""


class FrameGraph(NamedTuple):
    """
    The checked references of all elements, as in :class:`~sdf_pose_bridge.scene.scene.Scene`.

    Entry i of a sequence is about element i.
    """

    names: Sequence[str]
    roots: Sequence[int]
    references: Indices
    """-1 for roots and unresolved elements."""
    placements: Mapping[int, int]
    attachments: Indices
    bodies: Indices
    canonical_links: Indices
    joints: Sequence[JointEnds]
    """The joints that join two bodies, in file order."""
    unresolved: frozenset[int]
    """Elements without a pose in the root: those in links whose reference does not exist, which
    libsdformat loads all the same, and those that refer to an include that was not found."""


def frame_graph_from_elements(elements: Elements, problems: Problems) -> FrameGraph:
    """Look up and check every reference; a wrong one is replaced by the default of its kind."""
    return _Builder(elements, problems).graph()


def default_references(
    kinds: NDArray[np.uint8], parents: Indices, attachments: Indices,
) -> Indices:
    """
    Find the frame that the pose of each element is relative to by default.

    :param attachments: the frame that each frame is attached to, of a joint its child; -1 for
        none.
    :return: the child of a joint, the attachment of an explicit frame, the parent of any other
        element, also of a joint whose child is missing; -1 for worlds and implicit roots.
    """
    is_attached = np.isin(kinds, (Kind.JOINT, Kind.FRAME)) & (attachments != NO_ELEMENT)
    return np.where(is_attached, attachments, parents)


class _Builder:

    def __init__(self, elements: Elements, problems: Problems) -> None:
        self._elements = elements
        self._problems = problems
        self._scopes = NameScopes(elements, problems)
        self._unresolved: dict[int, str] = {}
        """Unresolved elements, and for each the URI of the missing include that causes it."""

    def graph(self) -> FrameGraph:
        elements = self._elements
        joints = {joint: self._joint_ends(joint) for joint in elements.joints}
        canonical = self._canonical_pointers()
        attachments = self._attachments(joints, canonical)
        self._break_cycles(attachments, AttachedToCycleError, 'attached to')
        references = default_references(elements.kinds, elements.parents, attachments)
        bodies = ends_from_pointers(attachments)
        bodies[(elements.parents >= 0) & ~IS_FRAME_KIND[elements.kinds]] = NO_ELEMENT
        checks = JointChecks(elements, self._scopes, bodies, self._problems)
        joints_of_bodies = [
            ends for joint, (parent, child) in joints.items() if joint not in self._unresolved
            and (ends := checks.ends_of(joint, parent, child)) is not None]
        self._set_references(references)
        placements = self._placements()
        self._add_dependents(references, attachments, joints_of_bodies, placements)
        return FrameGraph(
            self._scopes.names, self._scopes.roots, references, placements, attachments, bodies,
            self._canonical_links(canonical, bodies), joints_of_bodies,
            frozenset(self._unresolved))

    # Attachment

    def _joint_ends(self, joint: int) -> tuple[int, int]:
        """Return the parent and the child of a joint; -1 for a name that names no frame."""
        details = self._elements.joints[joint]
        for axis in filter(None, details.axes):
            for reference in filter(None, (axis.expressed_in, axis.mimic and axis.mimic.leader)):
                self._frame(joint, reference.name, NO_ELEMENT)
        parent, child = details.parent.name, details.child.name
        return (
            self._scopes.roots[joint] if parent == WORLD_FRAME
            else self._frame(joint, parent, NO_ELEMENT), self._frame(joint, child, NO_ELEMENT))

    def _attachments(
        self, joints: Mapping[int, tuple[int, int]], canonical: Mapping[int, int],
    ) -> Indices:
        elements = self._elements
        attachments = np.full(len(elements.names), NO_ELEMENT, dtype=np.int32)
        for joint, (_, child) in joints.items():
            attachments[joint] = child
        for model, details in elements.models.items():
            if not details.is_static:
                attachments[model] = canonical[model]
        for frame, frame_details in elements.frames.items():
            name = frame_details.attached_to
            # The scope instead of a frame that is not there could close a cycle.
            attachments[frame] = self._frame(
                frame, name, NO_ELEMENT if name else self._scopes.scope_of[frame], 'attached_to')
        return attachments

    def _canonical_pointers(self) -> dict[int, int]:
        """Find the canonical link of each model, or the frame that leads to it."""
        elements = self._elements
        first_children: dict[int, int] = {}
        for kind in (Kind.MODEL, Kind.LINK):  # links are preferred
            indices = np.flatnonzero(elements.kinds == kind)[::-1]
            first_children.update(
                zip(elements.parents[indices].tolist(), indices.tolist(), strict=True))
        pointers: dict[int, int] = {}
        for model in sorted(elements.models, reverse=True):  # inner models come first
            default = first_children.get(model, NO_ELEMENT)
            # For a nested model, its own pointer counts, even if the model is static and its frame
            # is not attached to the link.
            inner = pointers.get(default, NO_ELEMENT)
            pointers[model] = self._canonical_pointer(model, default if inner < 0 else inner)
        return pointers

    def _canonical_pointer(self, model: int, default: int) -> int:
        details = self._elements.models[model]
        name = details.canonical_link
        if details.is_static:
            found = self._scopes.frame(model, name) if name else None
            return default if found is None else found
        if default == NO_ELEMENT and model not in self._elements.missing_includes:
            msg = (f'model "{self._scopes.names[model]}" has no link and no nested model; only a '
                   'static model may have none')
            self._problems.error(ModelWithoutLinkError(msg, self._elements.place(model)))
            return default
        return self._frame(model, name, default, 'canonical_link')

    def _canonical_links(self, canonical: Mapping[int, int], bodies: Indices) -> Indices:
        kinds: list[int] = self._elements.kinds.tolist()
        body_of: list[int] = bodies.tolist()
        links = [NO_ELEMENT] * len(kinds)
        for model, target in canonical.items():
            # Inner models come first, so a model outside the model does not lead to a link.
            link = links[target] if kinds[target] == Kind.MODEL else body_of[target]
            if target >= 0 and kinds[link] == Kind.LINK:
                links[model] = link
        return np.array(links, dtype=np.int32)

    # Placement

    def _set_references(self, references: Indices) -> None:
        """Replace the default references of elements by those in the file."""
        elements = self._elements
        links = [elements.parents[inertial] for inertial in elements.automatic_inertials]
        is_needed = IS_FRAME_KIND[elements.kinds] | (
            (elements.kinds == Kind.COLLISION) & np.isin(elements.parents, links))
        defaults = np.where(is_needed, elements.parents, NO_ELEMENT).tolist()
        for index, name in elements.relative_to.items():
            references[index] = self._frame(index, name, defaults[index], 'relative_to')
        self._break_cycles(references, RelativeToCycleError, 'relative to')

    def _placements(self) -> dict[int, int]:
        found = {
            model: self._frame(model, details.placement_frame, model, 'placement_frame')
            for model, details in self._elements.models.items()}
        # A frame was placed when its model was merged. The name may be gone since.
        found.update({
            frame: self._frame(frame, details.placement_frame, frame)
            for frame, details in self._elements.frames.items()})
        return {index: placed for index, placed in found.items() if placed != index}

    # Reports

    def _frame(self, index: int, name: str, default: int, attribute: str = '') -> int:
        """
        Return the frame that an attribute names, and the default if it is empty or wrong.

        :param attribute: its name; empty if a wrong value is not reported here.
        """
        if not name:
            return default
        elements, scopes = self._elements, self._scopes
        is_of_pose = attribute == 'relative_to'
        scope = index if index in elements.models and not is_of_pose else scopes.scope_of[index]
        found = scopes.frame(scope, name)
        if found is not None:
            return found
        uri = scopes.missing_uri(scope, name)
        if uri:
            self._unresolved[index] = uri
        elif attribute:
            msg = f'{attribute}="{name}" {scopes.reason_without_frame(scope, name)}'
            place = elements.place_of_pose(index) if is_of_pose else elements.place(index)
            if is_of_pose and default == NO_ELEMENT:
                self._unresolved[index] = ''
                msg += f'; the {elements.kind(index).label} is left out'
                self._problems.warning(msg, place, RelativeToError.code)
            else:
                self._problems.error(_ERRORS[attribute](msg, place))
        return default

    def _add_dependents(
        self, references: Indices, attachments: Indices, joints: Sequence[JointEnds],
        placements: Mapping[int, int],
    ) -> None:
        """Add the elements that depend on an unresolved one, and report their number."""
        if not self._unresolved:
            return
        pairs = chain(
            *(enumerate(column.tolist())
              for column in (self._elements.parents, references, attachments)),
            placements.items(),
            ((ends.joint, other) for ends in joints
             for other in (ends.parent, *chain.from_iterable(ends.axes))))
        dependents = defaultdict[int, set[int]](set)
        for index, other in pairs:
            dependents[other].add(index)
        found = list(self._unresolved)
        for other in found:
            new = sorted(each for each in dependents[other] if each not in self._unresolved)
            self._unresolved.update(dict.fromkeys(new, self._unresolved[other]))
            found += new
        for uri in sorted(set(self._unresolved.values()) - {''}):
            indices = sorted(index for index, cause in self._unresolved.items() if cause == uri)
            names = [self._scopes.names[index] for index in indices]
            msg = (f'"{uri}" is missing, so elements that refer to it are left out too: '
                   f'{quoted_names(names)}')
            self._problems.warning(msg, self._elements.place(indices[0]))

    def _break_cycles(self, pointers: Indices, error_class: type[SdfError], verb: str) -> None:
        """Report each cycle at its first element in the file, and clear its pointers."""
        is_of_poses = error_class is RelativeToCycleError
        for cycle in cycles_from_pointers(pointers):
            start = cycle.index(min(cycle))
            first = cycle[start]
            pointers[cycle] = NO_ELEMENT
            shown = [f'"{self._scopes.names[index]}"'
                     for index in [*cycle[start:], *cycle[:start], first]]
            if len(shown) > _LONGEST_CYCLE_SHOWN:
                shown = [*shown[:6], f'... ({len(shown) - 11} more)', *shown[-5:]]
            msg = f'this is {verb} itself: {" -> ".join(shown)}'
            if is_of_poses and any(
                    index in self._elements.joints and index not in self._elements.relative_to
                    for index in cycle):
                msg += '; the default reference of a joint is its child'
            line = int(self._elements.pose_lines[first]) if is_of_poses else 0
            self._problems.error(error_class(msg, self._elements.place(first, line)))
