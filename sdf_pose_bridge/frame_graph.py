# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The frame graph: what each pose is relative to, and which body carries each frame.

Every reference is looked up and checked here; what comes out has no ring and no loose end.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sdf_pose_bridge.elements import Element
from sdf_pose_bridge.elements import Elements
from sdf_pose_bridge.elements import FrameFacts
from sdf_pose_bridge.elements import JointFacts
from sdf_pose_bridge.elements import ModelFacts
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.errors import AttachedToCycleError
from sdf_pose_bridge.errors import AttachedToError
from sdf_pose_bridge.errors import CanonicalLinkError
from sdf_pose_bridge.errors import ModelWithoutLinkError
from sdf_pose_bridge.errors import RelativeToCycleError
from sdf_pose_bridge.errors import RelativeToError
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.joint_checks import check_joints
from sdf_pose_bridge.joint_checks import JointEnds
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scopes import Scopes


class FrameGraph(NamedTuple):
    """The checked references of all elements; every field has an entry for each of them."""

    names: Sequence[str]
    """Absolute names, such as ``robot::arm::hand``."""
    roots: Sequence[int]
    """The world or implicit root that each element belongs to."""
    references: Sequence[int]
    """The frame that each pose is relative to; -1 for roots and for what cannot be placed."""
    placements: Sequence[int]
    """For a model the frame that its pose places; -1 where that is the model frame."""
    attachments: Sequence[int]
    """The frame that each frame is attached to directly; -1 for links, static models, roots."""
    bodies: Sequence[int]
    """The link, static model or root that carries each frame in the end; -1 for other kinds."""
    canonical_links: Sequence[int]
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
        self._elements = table.elements
        self._problems = problems
        self._scopes = Scopes(table)
        self._reported_rings: set[frozenset[int]] = set()
        self._lost: dict[int, str] = {}

    def graph(self) -> FrameGraph:
        joints = {
            index: self._joint_ends(index, element.scope, element.facts)
            for index, element in enumerate(self._elements)
            if isinstance(element.facts, JointFacts)
        }
        canonical = self._canonical_pointers()
        attachments = self._attachments(joints, canonical)
        bodies = _ends(attachments)
        for index, element in enumerate(self._elements):
            if element.kind not in FRAME_KINDS and element.parent >= 0:
                bodies[index] = NOWHERE
        kept_joints = [ends for ends in joints.values() if ends.joint not in self._lost]
        check_joints(self._table, self._scopes, kept_joints, bodies, self._problems)
        references = self._references(joints)
        placements = self._placements()
        self._lose_dependents(references, attachments, joints)
        return FrameGraph(
            self._scopes.names, self._scopes.roots, references, placements, attachments, bodies,
            self._canonical_links(canonical, bodies), tuple(joints.values()),
            frozenset(self._lost))

    # What carries what

    def _joint_ends(self, index: int, scope: int, facts: JointFacts) -> JointEnds:
        parent: int | None
        if facts.parent.name == 'world':
            parent = self._scopes.roots[scope]
        else:
            parent = self._scopes.frame(scope, facts.parent.name)
        child = self._scopes.frame(scope, facts.child.name)
        for end, name in ((parent, facts.parent.name), (child, facts.child.name)):
            if end is None and (uri := self._scopes.missing_uri(scope, name)):
                self._lost[index] = uri
        return JointEnds(
            index, NOWHERE if parent is None else parent, NOWHERE if child is None else child)

    def _attachments(
        self, joints: dict[int, JointEnds], canonical: dict[int, int],
    ) -> list[int]:
        attachments = [NOWHERE] * len(self._elements)
        for index, element in enumerate(self._elements):
            facts = element.facts
            if isinstance(facts, FrameFacts):
                attachments[index] = self._attached_to(index, element, facts)
            elif isinstance(facts, JointFacts):
                attachments[index] = joints[index].child
            elif isinstance(facts, ModelFacts) and not facts.is_static:
                attachments[index] = canonical[index]
        self._break_rings(attachments, AttachedToCycleError, 'attached to')
        return attachments

    def _attached_to(self, index: int, element: Element, facts: FrameFacts) -> int:
        if not facts.attached_to:
            return element.scope
        found = self._scopes.frame(element.scope, facts.attached_to)
        if found is None:
            self._unknown(AttachedToError, index, 'attached_to', facts.attached_to, element.scope)
            return element.scope
        return found

    def _canonical_pointers(self) -> dict[int, int]:
        """Find what each model's canonical link is said to be: a link, or what leads to one."""
        first_links: dict[int, int] = {}
        first_models: dict[int, int] = {}
        for index, element in enumerate(self._elements):
            if element.kind is Kind.LINK:
                first_links.setdefault(element.parent, index)
            elif element.kind is Kind.MODEL:
                first_models.setdefault(element.parent, index)
        pointers: dict[int, int] = {}
        for index in range(len(self._elements) - 1, -1, -1):
            facts = self._elements[index].facts
            if isinstance(facts, ModelFacts):
                first = first_links.get(index, first_models.get(index))
                # A nested model's own link is meant, even where that model is static and its
                # frame therefore not attached to the link.
                inside = NOWHERE if first is None else pointers.get(first, NOWHERE)
                if inside >= 0 and self._elements[inside].kind is Kind.LINK:
                    first = inside
                pointers[index] = self._canonical_pointer(index, facts, first)
        return pointers

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

    def _canonical_links(self, canonical: dict[int, int], bodies: Sequence[int]) -> list[int]:
        links = [NOWHERE] * len(self._elements)
        for index in canonical:  # inner models come first
            target = canonical[index]
            if target >= 0 and self._elements[target].kind is not Kind.MODEL:
                target = bodies[target]
            elif target > index:
                target = links[target]
            else:
                target = NOWHERE
            if target >= 0 and self._elements[target].kind is Kind.LINK:
                links[index] = target
        return links

    # What is placed in what

    def _references(self, joints: dict[int, JointEnds]) -> list[int]:
        references = [NOWHERE] * len(self._elements)
        for index, element in enumerate(self._elements):
            if element.parent < 0:
                continue
            if not element.relative_to:
                references[index] = self._default_reference(index, element, joints)
                continue
            found = self._scopes.frame(element.scope, element.relative_to)
            if found is not None:
                references[index] = found
            elif element.kind in FRAME_KINDS:
                self._unknown(RelativeToError, index, 'relative_to', element.relative_to,
                              element.scope, element.pose_line, 'pose')
                references[index] = element.parent
            else:
                self._lose(index, element)
        self._break_rings(references, RelativeToCycleError, 'relative to')
        return references

    def _default_reference(
        self, index: int, element: Element, joints: dict[int, JointEnds],
    ) -> int:
        facts = element.facts
        if isinstance(facts, JointFacts):
            child = joints[index].child
            return element.parent if child == NOWHERE else child
        if isinstance(facts, FrameFacts) and facts.attached_to:
            found = self._scopes.frame(element.scope, facts.attached_to)
            return element.parent if found is None else found
        return element.parent

    def _placements(self) -> list[int]:
        placements = [NOWHERE] * len(self._elements)
        for index, element in enumerate(self._elements):
            facts = element.facts
            if isinstance(facts, ModelFacts | FrameFacts) and facts.placement_frame:
                scope = index if element.kind is Kind.MODEL else element.scope
                found = self._scopes.frame(scope, facts.placement_frame)
                if found is None:
                    self._unknown(
                        RelativeToError, index, 'placement_frame', facts.placement_frame, scope)
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

    def _lose(self, index: int, element: Element) -> None:
        name = element.relative_to
        self._lost[index] = self._scopes.missing_uri(element.scope, name)
        if self._lost[index]:
            return
        msg = (f'relative_to="{name}" names no frame in {self._scopes.described(element.scope)}'
               f'{self._scopes.hint(element.scope, name)}; the {element.kind.label} is left out')
        self._problems.warning(
            RelativeToError.code, msg, self._table.place(index, element.pose_line, 'pose'))

    def _lose_dependents(
        self, references: Sequence[int], attachments: Sequence[int], joints: dict[int, JointEnds],
    ) -> None:
        """Leave out what stands on something that is left out, and say how much that is."""
        before = -1
        while before != len(self._lost):
            before = len(self._lost)
            for index, element in enumerate(self._elements):
                needed = [element.parent, references[index], attachments[index]]
                if index in joints:
                    needed.append(joints[index].parent)
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
        self, pointers: list[int], error_class: type[SdfError], verb: str,
    ) -> None:
        """Report each ring once, at its first element in the file, and open it there."""
        for ring in _rings(pointers):
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
            place = self._table.place(index, self._elements[index].pose_line)
            self._problems.error(error_class(msg, place))

    def _is_placed_in_child(self, index: int) -> bool:
        element = self._elements[index]
        return element.kind is Kind.JOINT and not element.relative_to


def _rings(pointers: Sequence[int]) -> list[list[int]]:
    """Find the rings of a graph in which every node points to one other or to none."""
    rings: list[list[int]] = []
    walk_of = [0] * len(pointers)
    for start, seen in enumerate(walk_of):
        if seen:
            continue
        walk = start + 1
        node = start
        while node >= 0 and not walk_of[node]:
            walk_of[node] = walk
            node = pointers[node]
        if node >= 0 and walk_of[node] == walk:
            ring = [node]
            node = pointers[node]
            while node != ring[0]:
                ring.append(node)
                node = pointers[node]
            rings.append(ring)
    return rings


def _ends(pointers: Sequence[int]) -> list[int]:
    """Follow every node to the end of its chain; there must be no rings."""
    ends = [NOWHERE] * len(pointers)
    for start in range(len(pointers)):
        chain: list[int] = []
        node = start
        while ends[node] < 0 and pointers[node] >= 0:
            chain.append(node)
            node = pointers[node]
        end = node if ends[node] < 0 else ends[node]
        ends[node] = end
        for passed in chain:
            ends[passed] = end
    return ends
