# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Take all elements that carry a pose out of the text of a document at once, column by column.

Only what is written as nearly everybody writes it is read here. All else is marked as odd, so
that the rules for it need not be known.
"""

from __future__ import annotations

from collections.abc import Iterable
import re
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.document import boolean_from_text
from sdf_pose_bridge.document import WHITE_SPACE
from sdf_pose_bridge.element_rows import Columns
from sdf_pose_bridge.element_rows import ElementRows
from sdf_pose_bridge.element_rows import Facts
from sdf_pose_bridge.elements import FrameFacts
from sdf_pose_bridge.elements import Indices
from sdf_pose_bridge.elements import JOINT_TYPES
from sdf_pose_bridge.elements import JointFacts
from sdf_pose_bridge.elements import ModelFacts
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.elements import Reference
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.markup import COMMENT
from sdf_pose_bridge.markup import Positions
from sdf_pose_bridge.markup_index import MarkupIndex
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import is_reserved
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sensor_facts import sensor_facts_from_xml

if TYPE_CHECKING:
    import numpy.typing as npt

_Flags: TypeAlias = 'npt.NDArray[np.bool_]'
_Rows: TypeAlias = 'npt.NDArray[np.intp]'

_INCLUDE = 253
_NO_KIND = 254
_OUTSIDE = 255
_KINDS = {kind.label: int(kind) for kind in Kind if kind is not Kind.ROOT} | {'include': _INCLUDE}
_CHILDREN = {
    _OUTSIDE: (Kind.WORLD, Kind.MODEL, Kind.LIGHT, Kind.ACTOR, _INCLUDE),
    Kind.WORLD: (Kind.MODEL, Kind.FRAME, Kind.JOINT, Kind.LIGHT, Kind.ACTOR, _INCLUDE),
    Kind.MODEL: (Kind.LINK, Kind.JOINT, Kind.FRAME, Kind.MODEL, _INCLUDE),
    Kind.LINK: (
        Kind.VISUAL, Kind.COLLISION, Kind.SENSOR, Kind.LIGHT, Kind.INERTIAL,
        Kind.PARTICLE_EMITTER, Kind.PROJECTOR),
    Kind.JOINT: (Kind.SENSOR,),
}
_TOP_TAGS = tuple(tag for tag, kind in _KINDS.items() if kind in _CHILDREN[_OUTSIDE])
_MAY_HOLD = np.zeros((256, 256), dtype=bool)
for _holder, _held in _CHILDREN.items():
    _MAY_HOLD[_holder, list(_held)] = True
_MAY_HOLD.setflags(write=False)
_IS_SCOPE = np.zeros(256, dtype=bool)
_IS_SCOPE[[Kind.WORLD, Kind.MODEL, _OUTSIDE]] = True
_IS_SCOPE.setflags(write=False)
_SPACES = np.arange(256)
_SPACES[list(FRAME_KINDS)] = Kind.FRAME
_SPACES.setflags(write=False)

_KIND_OF_NUMBER = np.full(len(KNOWN_TAGS.tags), _NO_KIND, dtype=np.uint8)
_KIND_OF_NUMBER[[KNOWN_TAGS.number_of[tag] for tag in _KINDS]] = list(_KINDS.values())
_KIND_OF_NUMBER.setflags(write=False)
_NO_ROW = -2
_SPREADING = 0x1E3779B97F4A7C15
"""Spreads numbers over all bits."""

_ATTRIBUTE = r'([^\s=\'"]+)\s*=\s*(?:"([^"]*)"|\'([^\']*)\')'
"""Left for `re` to compile when it is first needed."""
_RELATIVE_TO = re.compile(r'pose relative_to="([^"&\t\n\r]*)"')
_CHANGED_BY_PARSER = frozenset('&\t\n\r' + COMMENT)
"""Characters of which an XML parser makes something else."""

_ODD_IN_NAMES = ('\n\n', '__', '\nworld\n', '&', *WHITE_SPACE.replace('\n', ''))
_ODD_IN_REFERENCES = (*WHITE_SPACE.replace('\n', ''), '\n\n', '&', COMMENT, f'\n{ROOT_FRAME}\n')
_FORMS = {
    ('degrees', 'true'): 'degrees', ('degrees', '1'): 'degrees',
    ('degrees', 'false'): '', ('degrees', '0'): '',
    ('rotation_format', 'quat_xyzw'): 'quaternions', ('rotation_format', 'euler_rpy'): '',
}
_IS_NEVER_RELATIVE = np.zeros(256, dtype=bool)
_IS_NEVER_RELATIVE[[Kind.INERTIAL, Kind.ACTOR]] = True
_IS_NEVER_RELATIVE.setflags(write=False)


def rows_from_index(index: MarkupIndex) -> ElementRows:
    """
    Take all rows out of a document.

    :param index: the elements of a file in the newest grammar, all of which stand in that file.
    :return: its rows.
    """
    return _Extraction(index).rows()


class _Extraction:

    def __init__(self, index: MarkupIndex) -> None:
        self._index = index
        self._markup = markup = index.markup
        kinds = _KIND_OF_NUMBER[markup.numbers]
        elements = np.flatnonzero(kinds != _NO_KIND)
        kinds = kinds[elements]
        places = np.arange(len(elements))
        holders = markup.holders(elements)
        self._number_rows(elements)
        is_valid = _valid_rows(kinds, self._rows_of(holders))
        if not is_valid.all():
            elements, holders, places = (
                column[is_valid] for column in (elements, holders, places))
            kinds = kinds[is_valid]
            self._number_rows(elements)
        self._elements = elements
        self._kinds = kinds
        self._places = places
        self._parents = self._rows_of(holders)
        self._is_odd: _Flags = kinds == _INCLUDE
        self._relative_to: dict[int, str] = {}

    def _number_rows(self, elements: Positions) -> None:
        self._row_of_element = np.full(len(self._markup.numbers) + 1, _NO_ROW, dtype=np.int32)
        self._row_of_element[elements] = np.arange(len(elements))
        self._row_of_element[0] = NOWHERE  # the outermost one

    def _rows_of(self, elements: Positions) -> Indices:
        """Return the rows of elements: -1 for the outermost one, -2 for what has no row."""
        rows: Indices = self._row_of_element[elements]
        return rows

    def rows(self) -> ElementRows:
        names = self._names()
        posed, poses = self._poses()
        quaternions, degrees = self._pose_attributes(posed, poses)
        texts = self._pose_texts(posed, poses)
        pose_lines = np.zeros(len(names), dtype=np.int32)
        pose_lines[posed] = self._index.lines(poses)
        parents = self._parents
        holder_kinds = np.append(self._kinds, _OUTSIDE)[parents]
        scopes = np.where(_IS_SCOPE[holder_kinds], parents, np.append(parents, NOWHERE)[parents])
        facts = self._models(), self._frames(), self._joints(), self._sensors()
        columns = Columns(
            names, self._kinds, parents, scopes, self._index.lines(self._elements), pose_lines,
            self._is_odd, posed, texts, quaternions, degrees, self._references(), *facts)
        return ElementRows(columns, self._index.root, tuple(_KINDS), _TOP_TAGS, self._places)

    def _of_kind(self, kind: int) -> _Rows:
        return np.flatnonzero(self._kinds == kind)

    def _mark_odd(self, rows: Iterable[int]) -> None:
        self._is_odd[list(rows)] = True

    def _attributes(self, rows: _Rows) -> list[dict[str, str]]:
        """Read what is written in the start tags of rows; mark those where that is unusual."""
        tags = self._markup.tags(self._elements[rows])
        if not _CHANGED_BY_PARSER.isdisjoint(''.join(tags)):
            self._mark_odd(row for row, tag in zip(rows.tolist(), tags, strict=True)
                           if not _CHANGED_BY_PARSER.isdisjoint(tag))
        return [_attributes_from_tag(tag) for tag in tags]

    def _second_values(self, rows: _Rows, attribute: str) -> list[str]:
        """Read an attribute that mostly comes second, behind the name."""
        values, has_more = self._markup.second_values(self._elements[rows], attribute.encode())
        places = np.flatnonzero(has_more)
        for place, attributes in zip(places.tolist(), self._attributes(rows[places]), strict=True):
            values[place] = attributes.get(attribute, '')
        return values

    # Names

    def _names(self) -> list[str]:
        names = self._markup.first_values(self._elements)
        for kind, name in ((Kind.INERTIAL, Kind.INERTIAL.label), (_INCLUDE, 'include')):
            for row in self._of_kind(kind).tolist():
                names[row] = name
        if '' in names:
            unread = np.array([row for row, name in enumerate(names) if not name])
            for row, attributes in zip(unread.tolist(), self._attributes(unread), strict=True):
                names[row] = attributes.get('name', '')
        joined = '\n'.join(['', *names, ''])
        if joined.count('\n') > len(names) + 1 or any(text in joined for text in _ODD_IN_NAMES):
            self._mark_odd(row for row, name in enumerate(names) if _is_odd_name(name))
        self._mark_equal(names)
        return names

    def _mark_equal(self, names: list[str]) -> None:
        """Mark what shares a name space and a name with another; and, if need be, a few others."""
        rows = np.flatnonzero((self._kinds != Kind.INERTIAL) & (self._kinds != _INCLUDE))
        hashes = np.fromiter(map(hash, names), np.int64, len(names))
        spaces = self._parents[rows].astype(np.int64) * 256 + _SPACES[self._kinds[rows]]
        keys = hashes[rows] ^ (spaces * _SPREADING)
        order = np.argsort(keys, kind='stable')
        is_equal = keys[order[1:]] == keys[order[:-1]]
        if is_equal.any():
            self._is_odd[rows[order[1:][is_equal]]] = True
            self._is_odd[rows[order[:-1][is_equal]]] = True

    # Poses

    def _poses(self) -> tuple[_Rows, Positions]:
        poses = self._markup.of('pose')
        rows = self._rows_of(self._markup.holders(poses))
        posed, first, counts = _firsts(rows)
        is_row = (posed >= 0) & (np.append(self._kinds, _INCLUDE)[posed] != _INCLUDE)
        posed, first, counts = posed[is_row], first[is_row], counts[is_row]
        self._is_odd[posed[counts > 1]] = True
        return posed.astype(np.intp), poses[first]

    def _pose_attributes(self, posed: _Rows, poses: Positions) -> tuple[_Rows, _Rows]:
        """Read how poses are written, and what they are relative to."""
        forms: dict[str, list[int]] = {'degrees': [], 'quaternions': []}
        having = np.flatnonzero(self._markup.has_attributes(poses))
        for place, row, tag in zip(
                having.tolist(), posed[having].tolist(), self._markup.tags(poses[having]),
                strict=True):
            plain = _RELATIVE_TO.fullmatch(tag)
            if plain:
                self._relative_to[row] = plain.group(1)
                continue
            if not _CHANGED_BY_PARSER.isdisjoint(tag):
                self._is_odd[row] = True
            for attribute, value in _attributes_from_tag(tag).items():
                if attribute == 'relative_to':
                    self._relative_to[row] = value
                elif (form := _FORMS.get((attribute, value))) is None:
                    self._is_odd[row] = True
                elif form:
                    forms[form].append(place)
        both = set(forms['degrees']).intersection(forms['quaternions'])
        self._mark_odd(int(posed[place]) for place in both)
        return (np.array(forms['quaternions'], dtype=np.intp),
                np.array(forms['degrees'], dtype=np.intp))

    def _references(self) -> Facts:
        """Return what poses are relative to."""
        rows = np.array(sorted(self._relative_to), dtype=np.intp)
        names = [self._relative_to[row] for row in rows.tolist()]
        self._mark_odd_references(rows, names)
        self._is_odd[rows[_IS_NEVER_RELATIVE[self._kinds[rows]]]] = True
        return Facts(rows, names)

    def _mark_odd_references(self, rows: _Rows, names: list[str]) -> None:
        joined = '\n'.join(['', *names, ''])
        if joined.count('\n') > len(names) + 1 or any(
                text in joined for text in _ODD_IN_REFERENCES):
            self._mark_odd(
                row for row, name in zip(rows.tolist(), names, strict=True)
                if not name or '\n' in name or (
                    any(text in f'\n{name}\n' for text in _ODD_IN_REFERENCES)))

    def _pose_texts(self, posed: _Rows, poses: Positions) -> list[str]:
        texts = self._markup.texts(poses)
        joined = ''.join(texts)
        if '&' in joined or COMMENT in joined:
            self._mark_odd(
                row for row, text in zip(posed.tolist(), texts, strict=True)
                if '&' in text or COMMENT in text)
        return texts

    # What only some kinds have

    def _models(self) -> Facts:
        rows = self._of_kind(Kind.MODEL)
        statics = self._children('static', Kind.MODEL)
        facts = dict.fromkeys(rows.tolist(), ModelFacts(False, '', ''))
        _, has_more = self._markup.second_values(self._elements[rows], b'')
        more = np.array(sorted({*rows[has_more].tolist(), *statics}), dtype=np.intp)
        for row, attributes in zip(more.tolist(), self._attributes(more), strict=True):
            text = statics[row].name if row in statics else ''
            is_static = boolean_from_text(text) if text else False
            frames = [attributes.get(key, '') for key in ('canonical_link', 'placement_frame')]
            if is_static is None or frames != [name.strip(WHITE_SPACE) for name in frames] or (
                    ROOT_FRAME in frames):
                self._is_odd[row] = True
            facts[row] = ModelFacts(bool(is_static), *frames)
        return Facts(rows, list(facts.values()))

    def _frames(self) -> Facts:
        rows = self._of_kind(Kind.FRAME)
        attached_to = self._second_values(rows, 'attached_to')
        is_attached = np.array([bool(name) for name in attached_to], dtype=bool)
        self._mark_odd_references(rows[is_attached], list(filter(None, attached_to)))
        return Facts(rows, list(map(FrameFacts, attached_to)))

    def _joints(self) -> Facts:
        rows = self._of_kind(Kind.JOINT)
        parents = self._children('parent', Kind.JOINT)
        children = self._children('child', Kind.JOINT)
        expressed_in = self._expressed_in()
        types = [value.lower() for value in self._second_values(rows, 'type')]
        facts = list(map(
            JointFacts, types,
            (parents.get(row, _NO_REFERENCE) for row in rows.tolist()),
            (children.get(row, _NO_REFERENCE) for row in rows.tolist()),
            (expressed_in.get(row, ()) for row in rows.tolist())))
        if not JOINT_TYPES.issuperset(types) or not len(parents) == len(children) == len(rows):
            self._mark_odd(
                row for row, joint in zip(rows.tolist(), facts, strict=True)
                if joint.type not in JOINT_TYPES or _NO_REFERENCE in joint)
        for ends in (parents, children):
            self._mark_odd_references(
                np.fromiter(ends, np.intp, len(ends)), [name for name, _ in ends.values()])
        return Facts(rows, facts)

    def _expressed_in(self) -> dict[int, tuple[Reference, ...]]:
        markup = self._markup
        found: dict[int, tuple[Reference, ...]] = {}
        elements = markup.of('xyz')
        elements = elements[markup.has_attributes(elements)]
        axes = markup.holders(elements)
        is_axis = np.zeros(len(markup.numbers) + 1, dtype=bool)
        is_axis[markup.of('axis')] = is_axis[markup.of('axis2')] = True
        is_axis = is_axis[axes]
        elements, axes = elements[is_axis], axes[is_axis]
        rows = self._rows_of(markup.holders(axes)).tolist()
        for row, tag, line in zip(
                rows, markup.tags(elements), self._index.lines(elements).tolist(), strict=True):
            name = _attributes_from_tag(tag).get('expressed_in', '')
            if row >= 0 and (name != name.strip(WHITE_SPACE) or (
                    not _CHANGED_BY_PARSER.isdisjoint(tag))):
                self._is_odd[row] = True
            elif row >= 0 and name:
                found[row] = (*found.get(row, ()), Reference(name, line))
        return found

    def _sensors(self) -> Facts:
        rows = self._of_kind(Kind.SENSOR)
        xmls = self._index.xmls_of(Kind.SENSOR.label, self._elements[rows])
        return Facts(rows, list(map(sensor_facts_from_xml, xmls)))

    def _children(self, tag: str, kind: Kind) -> dict[int, Reference]:
        """Find the first child of that tag of each row of that kind."""
        elements = self._markup.of(tag)
        rows = self._rows_of(self._markup.holders(elements))
        is_kind = np.append(self._kinds, (_NO_KIND, _NO_KIND))[rows] == kind
        rows, first, _ = _firsts(rows[is_kind])
        elements = elements[is_kind][first]
        texts, lines = self._markup.texts(elements), self._index.lines(elements).tolist()
        return dict(zip(rows.tolist(), map(Reference, texts, lines), strict=True))


_NO_REFERENCE = Reference('', 0)


def _firsts(rows: Indices) -> tuple[Indices, _Rows, _Rows]:
    """Return the rows that there are, in ascending order, where each is first, and how often."""
    if len(rows) > 1 and (rows[1:] > rows[:-1]).all():
        return rows, np.arange(len(rows)), np.ones(len(rows), dtype=np.intp)
    order = np.argsort(rows, kind='stable')
    in_order = rows[order]
    starts = np.flatnonzero(np.append(True, in_order[1:] != in_order[:-1])[:len(rows)])
    return in_order[starts], order[starts], np.diff(np.append(starts, len(rows)))


def _attributes_from_tag(tag: str) -> dict[str, str]:
    return {name: a or b for name, a, b in re.findall(_ATTRIBUTE, tag)}


def _valid_rows(kinds: npt.NDArray[np.uint8], parents: Indices) -> _Flags:
    """Tell which elements stand where the grammar has them, as does all that holds them."""
    holder_kinds = np.append(kinds, _OUTSIDE)[np.maximum(parents, NOWHERE)]
    is_valid: _Flags = _MAY_HOLD[holder_kinds, kinds] & (parents != _NO_ROW)
    count = -1
    while count != (count := int(is_valid.sum())):
        is_valid &= np.append(is_valid, True)[np.maximum(parents, NOWHERE)]
    return is_valid


def _is_odd_name(name: str) -> bool:
    return not name or name != name.strip(WHITE_SPACE) or is_reserved(name) or (
        not _CHANGED_BY_PARSER.isdisjoint(name))
