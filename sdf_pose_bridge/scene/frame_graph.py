# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The frame graph: what each pose is relative to, and which body carries each frame.

Every reference is looked up and checked here; what comes out has no ring and no loose end.
"""

from collections.abc import Mapping
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import AttachedToCycleError
from sdf_pose_bridge.errors import AttachedToError
from sdf_pose_bridge.errors import CanonicalLinkError
from sdf_pose_bridge.errors import ModelWithoutLinkError
from sdf_pose_bridge.errors import RelativeToCycleError
from sdf_pose_bridge.errors import RelativeToError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.joints import check_joints
from sdf_pose_bridge.scene.joints import JointEnds
from sdf_pose_bridge.scene.pointer_chains import ends_from_pointers
from sdf_pose_bridge.scene.pointer_chains import rings_from_pointers
from sdf_pose_bridge.scene.scopes import IS_FRAME_KIND
from sdf_pose_bridge.scene.scopes import Scopes
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.elements import FrameFacts
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.elements import ModelFacts
from sdf_pose_bridge.sdformat.elements import NOWHERE


class FrameGraph(NamedTuple):
    """The checked references of all elements; each column has an entry for each of them."""

    names: Sequence[str]
    """Absolute names, such as ``robot::arm::hand``."""
    roots: Sequence[int]
    """The world or implicit root that each element belongs to."""
    references: Indices
    """The frame that each pose is relative to; -1 for roots and for what cannot be placed."""
    placements: Mapping[int, int]
    """For models the frame that their pose places, where that is not the model frame."""
    attachments: Indices
    """The frame that each frame is attached to directly; -1 for links, static models, roots."""
    bodies: Indices
    """The link, static model or root that carries each frame in the end; -1 for other kinds."""
    canonical_links: Indices
    """For a model its canonical link; -1 for a model without one and for other kinds."""
    joints: Sequence[JointEnds]
    """The ends of every joint, in file order."""
    lost: frozenset[int]
    """Elements that cannot be placed: link children whose reference does not exist, which
    libsdformat loads all the same, and what refers to something that was left out."""


def frame_graph_from_elements(table: Elements, problems: Problems) -> FrameGraph:
    """
    Look up and check every reference.

    :param table: the elements.
    :param problems: takes what is wrong with the references.
    :return: the graph; what is wrong in it stands at the default of its kind.
    """
    return _Builder(table, problems).graph()


class _Builder:

    def __init__(self, table: Elements, problems: Problems) -> None:
        self._table = table
        self._problems = problems
        self._scopes = Scopes(table)
        self._reported_rings: set[frozenset[int]] = set()
        self._lost: dict[int, str] = {}
        self._scope_of: list[int] = table.scopes.tolist()

    def graph(self) -> FrameGraph:
        table = self._table
        joints = self._joint_ends()
        canonical = self._canonical_pointers()
        attachments = self._attachments(joints, canonical)
        bodies = ends_from_pointers(attachments)
        bodies[(table.parents >= 0) & ~IS_FRAME_KIND[table.kinds]] = NOWHERE
        kept_joints = [ends for ends in joints.values() if ends.joint not in self._lost]
        check_joints(table, self._scopes, kept_joints, bodies, self._problems)
        references = self._references(joints)
        placements = self._placements()
        self._lose_dependents(references, attachments, joints)
        return FrameGraph(
            self._scopes.names, self._scopes.roots, references, placements, attachments, bodies,
            self._canonical_links(canonical, bodies), tuple(joints.values()),
            frozenset(self._lost))

    # What carries what

    def _joint_ends(self) -> dict[int, JointEnds]:
        joints = self._table.joints
        scopes = [self._scope_of[index] for index in joints]
        names = [facts.parent.name for facts in joints.values()]
        parents = self._scopes.frames(scopes, names)
        for place, name in enumerate(names):
            if name == WORLD_FRAME:
                parents[place] = self._scopes.roots[scopes[place]]
        child_names = [facts.child.name for facts in joints.values()]
        children = self._scopes.frames(scopes, child_names)
        for ends, end_names in ((parents, names), (children, child_names)):
            if self._table.missing and None in ends:
                for index, scope, end, name in zip(joints, scopes, ends, end_names, strict=True):
                    if end is None and (uri := self._scopes.missing_uri(scope, name)):
                        self._lost[index] = uri
        return {
            index: JointEnds(
                index, NOWHERE if parent is None else parent, NOWHERE if child is None else child)
            for index, parent, child in zip(joints, parents, children, strict=True)}

    def _attachments(self, joints: dict[int, JointEnds], canonical: dict[int, int]) -> Indices:
        table = self._table
        attached = {index: ends.child for index, ends in joints.items()}
        attached |= {
            index: canonical[index] for index, facts in table.models.items()
            if not facts.is_static}
        attached |= {index: self._attached_to(index, facts)
                     for index, facts in table.frames.items()}
        attachments = np.full(len(table.names), NOWHERE, dtype=np.int32)
        _put(attachments, attached)
        self._break_rings(attachments, AttachedToCycleError, 'attached to')
        return attachments

    def _attached_to(self, index: int, facts: FrameFacts) -> int:
        scope = self._scope_of[index]
        if not facts.attached_to:
            return scope
        found = self._scopes.frame(scope, facts.attached_to)
        if found is None:
            self._unknown(AttachedToError, index, 'attached_to', facts.attached_to, scope)
            return scope
        return found

    def _canonical_pointers(self) -> dict[int, int]:
        """Find what each model's canonical link is said to be: a link, or what leads to one."""
        table = self._table
        is_link: list[bool] = (table.kinds == Kind.LINK).tolist()
        first_links = self._first_of_kind(Kind.LINK)
        first_models = self._first_of_kind(Kind.MODEL)
        pointers: dict[int, int] = {}
        for index in sorted(table.models, reverse=True):
            facts = table.models[index]
            first = first_links.get(index, first_models.get(index))
            # A nested model's own link is meant, even where that model is static and its frame
            # therefore not attached to the link.
            inside = NOWHERE if first is None else pointers.get(first, NOWHERE)
            if inside >= 0 and is_link[inside]:
                first = inside
            pointers[index] = self._canonical_pointer(index, facts, first)
        return pointers

    def _first_of_kind(self, kind: Kind) -> dict[int, int]:
        """Find the first child of a kind of each element that holds one."""
        indices = np.flatnonzero(self._table.kinds == kind)[::-1]
        return dict(zip(self._table.parents[indices].tolist(), indices.tolist(), strict=True))

    def _canonical_pointer(self, index: int, facts: ModelFacts, first: int | None) -> int:
        name = facts.canonical_link
        if name:
            found = self._scopes.frame(index, name)
            if found is not None:
                return found
            if not facts.is_static:
                self._unknown(CanonicalLinkError, index, 'canonical_link', name, index)
        elif first is None and not facts.is_static and index not in self._table.missing:
            msg = (f'model "{self._scopes.names[index]}" has no link and no nested model; only a '
                   'static model may have none')
            self._problems.error(ModelWithoutLinkError(msg, self._table.place(index)))
        return NOWHERE if first is None else first

    def _canonical_links(self, canonical: dict[int, int], bodies: Indices) -> Indices:
        kinds: list[int] = self._table.kinds.tolist()
        body_of: list[int] = bodies.tolist()
        links: dict[int, int] = {}
        for index, target in canonical.items():  # inner models come first
            if target >= 0 and kinds[target] != Kind.MODEL:
                target = body_of[target]
            elif target > index:
                target = links.get(target, NOWHERE)
            else:
                target = NOWHERE
            if target >= 0 and kinds[target] == Kind.LINK:
                links[index] = target
        result = np.full(len(kinds), NOWHERE, dtype=np.int32)
        _put(result, links)
        return result

    # What is placed in what

    def _references(self, joints: dict[int, JointEnds]) -> Indices:
        table = self._table
        references: Indices = table.parents.copy()
        _put(references, {
            index: ends.child for index, ends in joints.items() if ends.child != NOWHERE})
        _put(references, {
            index: found for index, facts in table.frames.items() if facts.attached_to
            and (found := self._scopes.frame(self._scope_of[index], facts.attached_to))
            is not None})
        scopes = [self._scope_of[index] for index in table.relative_to]
        frames = self._scopes.frames(scopes, list(table.relative_to.values()))
        _put(references, {
            index: self._without_reference(index, name) if found is None else found
            for (index, name), found in zip(table.relative_to.items(), frames, strict=True)})
        self._break_rings(references, RelativeToCycleError, 'relative to')
        return references

    def _without_reference(self, index: int, name: str) -> int:
        """Report that the name of a frame means nothing; return what to use instead."""
        table = self._table
        scope = self._scope_of[index]
        if IS_FRAME_KIND[table.kinds[index]]:
            self._unknown(
                RelativeToError, index, 'relative_to', name, scope, int(table.pose_lines[index]),
                'pose')
            return int(table.parents[index])
        self._lose(index, name)
        return NOWHERE

    def _placements(self) -> dict[int, int]:
        placements: dict[int, int] = {}
        table = self._table
        scoped = [(index, index, facts.placement_frame) for index, facts in table.models.items()]
        scoped += [(index, self._scope_of[index], facts.placement_frame)
                   for index, facts in table.frames.items()]
        for index, scope, name in scoped:
            if not name:
                continue
            found = self._scopes.frame(scope, name)
            if found is None:
                self._unknown(RelativeToError, index, 'placement_frame', name, scope)
            elif found != index:
                placements[index] = found
        return placements

    # Reports

    def _unknown(
        self, error_class: type[SdfError], index: int, attribute: str, name: str, scope: int,
        line: int = 0, part: str = '',
    ) -> None:
        uri = self._scopes.missing_uri(scope, name)
        if uri:
            self._lost[index] = uri
            return
        msg = (f'{attribute}="{name}" names no frame in {self._scopes.described(scope)}'
               f'{self._scopes.hint(scope, name)}')
        self._problems.error(error_class(msg, self._table.place(index, line, part)))

    def _lose(self, index: int, name: str) -> None:
        scope = self._scope_of[index]
        self._lost[index] = self._scopes.missing_uri(scope, name)
        if self._lost[index]:
            return
        msg = (f'relative_to="{name}" names no frame in {self._scopes.described(scope)}'
               f'{self._scopes.hint(scope, name)}; the {self._table.kind(index).label} is left '
               'out')
        place = self._table.place(index, int(self._table.pose_lines[index]), 'pose')
        self._problems.warning(RelativeToError.code, msg, place)

    def _lose_dependents(
        self, references: Indices, attachments: Indices, joints: dict[int, JointEnds],
    ) -> None:
        """Leave out what stands on something that is left out, and say how much that is."""
        if not self._lost:
            return
        before = 0
        columns = self._table.parents.tolist(), references.tolist(), attachments.tolist()
        while before != len(self._lost):
            before = len(self._lost)
            for index, pointers in enumerate(zip(*columns, strict=True)):
                needed = [*pointers, joints[index].parent] if index in joints else pointers
                for other in needed:
                    if other in self._lost:
                        self._lost.setdefault(index, self._lost[other])
        if self._problems.errors:
            return
        for uri in sorted(set(self._lost.values()) - {''}):
            lost = [index for index, cause in self._lost.items() if cause == uri]
            names = ', '.join(f'"{self._scopes.names[index]}"' for index in sorted(lost)[:5])
            rest = f' and {len(lost) - 5} more' if len(lost) > 5 else ''
            msg = (f'because "{uri}" is missing, {len(lost)} more elements are left out, which '
                   f'refer to it: {names}{rest}')
            self._problems.warning('WARNING', msg, self._table.place(min(lost)))

    def _break_rings(
        self, pointers: Indices, error_class: type[SdfError], verb: str,
    ) -> None:
        """Report each ring once, at its first element in the file, and open it there."""
        for ring in rings_from_pointers(pointers):
            start = ring.index(min(ring))
            pointers[ring[start]] = NOWHERE
            if frozenset(ring) in self._reported_rings:
                continue
            self._reported_rings.add(frozenset(ring))
            chain = [*ring[start:], *ring[:start], ring[start]]
            shown = [f'"{self._scopes.names[i]}"' for i in chain]
            if len(shown) > 12:
                shown = [*shown[:6], f'... ({len(shown) - 11} more)', *shown[-5:]]
            index = ring[start]
            msg = f'this is {verb} itself: {" -> ".join(shown)}'
            if error_class is RelativeToCycleError and any(map(self._is_placed_in_child, ring)):
                msg += '; a joint that says nothing else is placed in its child'
            place = self._table.place(index, int(self._table.pose_lines[index]))
            self._problems.error(error_class(msg, place))

    def _is_placed_in_child(self, index: int) -> bool:
        return index in self._table.joints and index not in self._table.relative_to


def _put(column: Indices, values: dict[int, int]) -> None:
    column[list(values)] = list(values.values())
