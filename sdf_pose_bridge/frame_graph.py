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

NOWHERE = -1
"""Stands for an index where there is none."""


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
    """Elements whose reference does not exist, which libsdformat loads but cannot place."""


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
        check_joints(self._table, self._scopes, joints.values(), bodies, self._problems)
        references, lost = self._references(joints)
        placements = self._placements()
        return FrameGraph(
            self._scopes.names, self._scopes.roots, references, placements, attachments, bodies,
            self._canonical_links(canonical, bodies), tuple(joints.values()), lost)

    # What carries what

    def _joint_ends(self, index: int, scope: int, facts: JointFacts) -> JointEnds:
        parent: int | None
        if facts.parent.name == 'world':
            parent = self._scopes.roots[scope]
        else:
            parent = self._scopes.frame(scope, facts.parent.name)
        child = self._scopes.frame(scope, facts.child.name)
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
        return {
            index: self._canonical_pointer(
                index, element.facts, first_links.get(index, first_models.get(index)))
            for index, element in enumerate(self._elements)
            if isinstance(element.facts, ModelFacts)
        }

    def _canonical_pointer(self, index: int, facts: ModelFacts, first: int | None) -> int:
        name = facts.canonical_link
        if name:
            found = self._scopes.frame(index, name)
            if found is not None:
                return found
            if not facts.is_static:
                self._unknown(CanonicalLinkError, index, 'canonical_link', name, index)
        elif first is None and not facts.is_static:
            msg = (f'model "{self._scopes.names[index]}" has no link and no nested model; only a '
                   'static model may have none')
            self._problems.error(index, ModelWithoutLinkError(msg, self._table.place(index)))
        return NOWHERE if first is None else first

    def _canonical_links(self, canonical: dict[int, int], bodies: Sequence[int]) -> list[int]:
        links = [NOWHERE] * len(self._elements)
        for index in reversed(canonical):
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

    def _references(self, joints: dict[int, JointEnds]) -> tuple[list[int], frozenset[int]]:
        references = [NOWHERE] * len(self._elements)
        lost = set()
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
                lost.add(index)
                self._warn_lost(index, element)
        self._break_rings(references, RelativeToCycleError, 'relative to')
        return references, frozenset(lost)

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
            if isinstance(facts, ModelFacts) and facts.placement_frame:
                found = self._scopes.frame(index, facts.placement_frame)
                if found is None:
                    self._unknown(
                        RelativeToError, index, 'placement_frame', facts.placement_frame, index)
                elif found != index:
                    placements[index] = found
        return placements

    # Reports

    def _unknown(
        self, error_class: type[SdfError], index: int, attribute: str, name: str, scope: int,
        line: int = 0, part: str = '',
    ) -> None:
        msg = (f'{attribute}="{name}" names no frame in {self._scopes.described(scope)}'
               f'{self._scopes.hint(scope, name)}')
        self._problems.error(index, error_class(msg, self._table.place(index, line, part)))

    def _warn_lost(self, index: int, element: Element) -> None:
        name = element.relative_to
        msg = (f'relative_to="{name}" names no frame in {self._scopes.described(element.scope)}'
               f'{self._scopes.hint(element.scope, name)}; the {element.kind.label} is left out')
        self._problems.warning(
            index, RelativeToError.code, msg, self._table.place(index, element.pose_line, 'pose'))

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
            self._problems.error(index, error_class(msg, place))

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
