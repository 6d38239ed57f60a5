# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Take all elements that carry a pose out of the text of a document at once, column by column.

Only what is written as nearly everybody writes it is read here. All else is marked as odd, so
that the rules for it need not be known.
"""

from __future__ import annotations

import re

import numpy as np

from sdf_pose_bridge.document import WHITE_SPACE
from sdf_pose_bridge.element_rows import Columns
from sdf_pose_bridge.element_rows import Facts
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.kind_facts import KindFacts
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import is_reserved
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.row_kinds import INCLUDE
from sdf_pose_bridge.row_kinds import OUTSIDE
from sdf_pose_bridge.row_table import attributes_from_tag
from sdf_pose_bridge.row_table import CHANGED_BY_PARSER
from sdf_pose_bridge.row_table import firsts_of_rows
from sdf_pose_bridge.row_table import LinesOf
from sdf_pose_bridge.row_table import REPLACED_BY_PARSER
from sdf_pose_bridge.row_table import Rows
from sdf_pose_bridge.row_table import RowTable
from sdf_pose_bridge.tag_search import Positions
from sdf_pose_bridge.versions import has_frame_attributes
from sdf_pose_bridge.versions import Version

_IS_SCOPE = np.zeros(256, dtype=bool)
_IS_SCOPE[[Kind.WORLD, Kind.MODEL, OUTSIDE]] = True
_IS_SCOPE.setflags(write=False)
_SPACES = np.arange(256)
_SPACES[list(FRAME_KINDS)] = Kind.FRAME
_SPACES.setflags(write=False)

_SPREADING = 0x1E3779B97F4A7C15
"""Spreads numbers over all bits."""

_RELATIVE_TO = re.compile(r'pose relative_to="([^"&\t\n\r]*)"')

_ODD_IN_NAMES = ('\n\n', '__', '\nworld\n', '&', *WHITE_SPACE.replace('\n', ''))
_FORMS = {
    ('degrees', 'true'): 'degrees', ('degrees', '1'): 'degrees',
    ('degrees', 'false'): '', ('degrees', '0'): '',
    ('rotation_format', 'quat_xyzw'): 'quaternions', ('rotation_format', 'euler_rpy'): '',
}
_IS_NEVER_RELATIVE = np.zeros(256, dtype=bool)
_IS_NEVER_RELATIVE[[Kind.INERTIAL, Kind.ACTOR]] = True
_IS_NEVER_RELATIVE.setflags(write=False)


def columns_from_markup(markup: Markup, lines_of: LinesOf, version: Version) -> Columns:
    """
    Take all rows out of a document.

    :param markup: its elements, all of which stand in one file.
    :param lines_of: tells which lines they stand in.
    :param version: the version by whose rules it is written.
    :return: its rows, as they are in the newest version.
    """
    return _Extraction(RowTable(markup, lines_of), version).columns()


class _Extraction:

    def __init__(self, table: RowTable, version: Version) -> None:
        self._table = table
        self._markup = table.markup
        self._kinds = table.kinds
        self._is_odd = table.is_odd
        self._version = version
        self._has_frame_attributes = has_frame_attributes(version)
        self._relative_to: dict[int, str] = {}

    def columns(self) -> Columns:
        table = self._table
        names = self._names()
        has_odd_name = self._is_odd.copy()
        posed, poses = self._poses()
        quaternions, degrees = self._pose_attributes(posed, poses)
        texts = self._pose_texts(posed, poses)
        pose_lines = np.zeros(len(names), dtype=np.int32)
        pose_lines[posed] = table.lines_of(poses)
        parents = table.parents
        is_in_scope = _IS_SCOPE[table.kinds_of(parents)]
        scopes = np.where(is_in_scope, parents, np.append(parents, NOWHERE)[parents])
        facts = KindFacts(table, self._version)
        return Columns(
            table.elements, names, self._kinds, parents, scopes, table.lines_of(table.elements),
            pose_lines, self._is_odd, has_odd_name, posed, texts, quaternions, degrees,
            self._references(), facts.models(), facts.frames(), facts.joints(), facts.sensors())

    # Names

    def _names(self) -> list[str]:
        names = self._markup.first_values(self._table.elements)
        for kind, name in ((Kind.INERTIAL, Kind.INERTIAL.label), (INCLUDE, 'include')):
            for row in self._table.of_kind(kind).tolist():
                names[row] = name
        if '' in names:
            unread = np.array([row for row, name in enumerate(names) if not name])
            written = self._table.attributes(unread)
            for row, attributes in zip(unread.tolist(), written, strict=True):
                names[row] = attributes.get('name', '')
        joined = '\n'.join(['', *names, ''])
        if joined.count('\n') > len(names) + 1 or any(text in joined for text in _ODD_IN_NAMES):
            self._table.mark_odd(row for row, name in enumerate(names) if _is_odd_name(name))
        self._mark_equal(names)
        return names

    def _mark_equal(self, names: list[str]) -> None:
        """Mark what shares a name space and a name with another; and, if need be, a few others."""
        rows = np.flatnonzero((self._kinds != Kind.INERTIAL) & (self._kinds != INCLUDE))
        hashes = np.fromiter(map(hash, names), np.int64, len(names))
        spaces = self._table.parents[rows].astype(np.int64) * 256 + _SPACES[self._kinds[rows]]
        keys = hashes[rows] ^ (spaces * _SPREADING)
        order = np.argsort(keys, kind='stable')
        is_equal = keys[order[1:]] == keys[order[:-1]]
        if is_equal.any():
            self._is_odd[rows[order[1:][is_equal]]] = True
            self._is_odd[rows[order[:-1][is_equal]]] = True

    # Poses

    def _poses(self) -> tuple[Rows, Positions]:
        poses = self._markup.of('pose')
        rows = self._table.rows_of(self._markup.holders(poses))
        posed, first, counts = firsts_of_rows(rows, poses)
        is_row = (posed >= 0) & (self._table.kinds_of(posed) != INCLUDE)
        posed, first, counts = posed[is_row], first[is_row], counts[is_row]
        self._is_odd[posed[counts > 1]] = True
        return posed, first

    def _pose_attributes(self, posed: Rows, poses: Positions) -> tuple[Rows, Rows]:
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
            if not CHANGED_BY_PARSER.isdisjoint(tag):
                self._is_odd[row] = True
            attributes = attributes_from_tag(tag)
            if 'frame' in attributes and self._has_frame_attributes:
                attributes['relative_to'] = attributes.pop('frame')
            for attribute, value in attributes.items():
                if attribute == 'relative_to':
                    self._relative_to[row] = value
                elif (form := _FORMS.get((attribute, value))) is None:
                    self._is_odd[row] = True
                elif form:
                    forms[form].append(place)
        both = set(forms['degrees']).intersection(forms['quaternions'])
        self._table.mark_odd(int(posed[place]) for place in both)
        return (np.array(forms['quaternions'], dtype=np.intp),
                np.array(forms['degrees'], dtype=np.intp))

    def _references(self) -> Facts:
        """Return what poses are relative to."""
        rows = np.array(sorted(self._relative_to), dtype=np.intp)
        names = [self._relative_to[row] for row in rows.tolist()]
        self._table.mark_odd_references(rows, names)
        self._is_odd[rows[_IS_NEVER_RELATIVE[self._kinds[rows]]]] = True
        return Facts(rows, names)

    def _pose_texts(self, posed: Rows, poses: Positions) -> list[str]:
        texts = self._markup.texts(poses)
        self._table.mark_holding(REPLACED_BY_PARSER, posed, texts)
        return texts


def _is_odd_name(name: str) -> bool:
    return not name or name != name.strip(WHITE_SPACE) or is_reserved(name) or (
        not CHANGED_BY_PARSER.isdisjoint(name))
