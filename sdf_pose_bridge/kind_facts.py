# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Take out of the text of a document what only models, frames, joints or sensors have."""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Mapping
import itertools

import numpy as np

from sdf_pose_bridge.document import boolean_from_text
from sdf_pose_bridge.document import value_from_text
from sdf_pose_bridge.document import WHITE_SPACE
from sdf_pose_bridge.element_rows import Facts
from sdf_pose_bridge.elements import CAMERA_TYPES
from sdf_pose_bridge.elements import FrameFacts
from sdf_pose_bridge.elements import JOINT_TYPES
from sdf_pose_bridge.elements import JointFacts
from sdf_pose_bridge.elements import ModelFacts
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.elements import Reference
from sdf_pose_bridge.elements import SensorFacts
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import MODEL_FRAME
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.row_kinds import OUTSIDE
from sdf_pose_bridge.row_table import attributes_from_tag
from sdf_pose_bridge.row_table import CHANGED_BY_PARSER
from sdf_pose_bridge.row_table import firsts_of_rows
from sdf_pose_bridge.row_table import Flags
from sdf_pose_bridge.row_table import REPLACED_BY_PARSER
from sdf_pose_bridge.row_table import Rows
from sdf_pose_bridge.row_table import RowTable
from sdf_pose_bridge.tag_search import Positions
from sdf_pose_bridge.versions import has_frame_attributes
from sdf_pose_bridge.versions import turns_axes_with_model
from sdf_pose_bridge.versions import Version

_NO_REFERENCE = Reference('', 0)


class KindFacts:
    """
    What only rows of some kinds have; rows where that is unusual are marked as odd.

    :param table: the rows of a document.
    :param version: the version by whose rules it is written.
    """

    def __init__(self, table: RowTable, version: Version) -> None:
        self._table = table
        self._markup = table.markup
        self._version = version

    def models(self) -> Facts:
        """
        Read what only models have.

        :return: a :class:`ModelFacts` for each.
        """
        table = self._table
        rows = table.of_kind(Kind.MODEL)
        statics = table.references('static', Kind.MODEL)
        facts = dict.fromkeys(rows.tolist(), ModelFacts(False, '', ''))
        _, has_more = self._markup.second_values(table.elements[rows], b'')
        more = np.array(sorted({*rows[has_more].tolist(), *statics}), dtype=np.intp)
        for row, attributes in zip(more.tolist(), table.attributes(more), strict=True):
            text = statics[row].name if row in statics else ''
            is_static = boolean_from_text(text) if text else False
            frames = [attributes.get(key, '') for key in ('canonical_link', 'placement_frame')]
            if is_static is None or frames != [name.strip(WHITE_SPACE) for name in frames] or (
                    ROOT_FRAME in frames):
                table.mark_odd([row])
            facts[row] = ModelFacts(bool(is_static), *frames)
        return Facts(rows, list(facts.values()))

    def frames(self) -> Facts:
        """
        Read what only frames have.

        :return: a :class:`FrameFacts` for each.
        """
        table = self._table
        rows = table.of_kind(Kind.FRAME)
        attached_to = table.second_values(rows, 'attached_to')
        is_attached = np.array([bool(name) for name in attached_to], dtype=bool)
        table.mark_odd_references(rows[is_attached], list(filter(None, attached_to)))
        return Facts(rows, list(map(FrameFacts, attached_to)))

    # Joints

    def joints(self) -> Facts:
        """
        Read what only joints have.

        :return: a :class:`JointFacts` for each.
        """
        table = self._table
        rows = table.of_kind(Kind.JOINT)
        parents = self._joint_ends('parent', rows)
        children = self._joint_ends('child', rows)
        expressed_in = self._expressed_in()
        types = [value.lower() for value in table.second_values(rows, 'type')]
        axes: Iterable[tuple[Reference, ...]] = (
            [expressed_in.get(row, ()) for row in rows.tolist()] if expressed_in
            else itertools.repeat(()))
        if not JOINT_TYPES.issuperset(types):
            table.mark_odd(row for row, joint_type in zip(rows.tolist(), types, strict=True)
                           if joint_type not in JOINT_TYPES)
        return Facts(rows, list(map(JointFacts, types, parents, children, axes)))

    def _joint_ends(self, tag: str, joints: Rows) -> list[Reference]:
        """Read what joints join; mark those that do not say it in the usual way."""
        table = self._table
        rows, elements, _ = table.children(tag, Kind.JOINT)
        names, lines = self._markup.texts(elements), table.lines_of(elements).tolist()
        table.mark_odd_references(rows, names)
        ends = list(map(Reference, names, lines))
        if len(rows) == len(joints):
            return ends
        is_there = np.zeros(len(table.kinds), dtype=bool)
        is_there[rows] = True
        table.mark_odd(joints[~is_there[joints]].tolist())
        end_of = dict(zip(rows.tolist(), ends, strict=True))
        return [end_of.get(row, _NO_REFERENCE) for row in joints.tolist()]

    def _expressed_in(self) -> Mapping[int, tuple[Reference, ...]]:
        """Return the frames that axes of joints are given in, where one is named."""
        table, markup = self._table, self._markup
        found: dict[int, tuple[Reference, ...]] = {}
        xyzs = markup.of('xyz')
        is_old = has_frame_attributes(self._version)
        has_attributes = markup.has_attributes(xyzs)
        if not (is_old or has_attributes.any()):
            return found
        axes = markup.holders(xyzs)
        is_axis = self._marked_elements(np.append(markup.of('axis'), markup.of('axis2')))[axes]
        xyzs, axes, has_attributes = xyzs[is_axis], axes[is_axis], has_attributes[is_axis]
        joints = table.rows_of(markup.holders(axes))
        is_joint = table.kinds_of(joints) == Kind.JOINT
        xyzs, axes, joints, has_attributes = (
            column[is_joint] for column in (xyzs, axes, joints, has_attributes))
        is_turned = self._turned_axes(axes, joints) if is_old else np.zeros(len(axes), dtype=bool)
        chosen = np.flatnonzero(has_attributes | is_turned)
        for row, tag, line, turned in zip(
                joints[chosen].tolist(), markup.tags(xyzs[chosen]),
                table.lines_of(xyzs[chosen]).tolist(), is_turned[chosen].tolist(), strict=True):
            name = attributes_from_tag(tag).get('expressed_in', '') if not turned else MODEL_FRAME
            if name != name.strip(WHITE_SPACE) or not CHANGED_BY_PARSER.isdisjoint(tag):
                table.mark_odd([row])
            elif name:
                found[row] = (*found.get(row, ()), Reference(name, line))
        return found

    def _turned_axes(self, axes: Positions, joints: Rows) -> Flags:
        """Tell which axes are given in the model frame by the rules of old versions."""
        table, markup = self._table, self._markup
        firsts = firsts_of_rows(axes, axes)
        is_repeated = self._marked_elements(firsts.rows[firsts.counts > 1])[axes]
        flags = markup.of('use_parent_model_frame')
        flagged = markup.holders(flags)
        texts = markup.texts(flags)
        is_true = np.array([bool(boolean_from_text(text)) for text in texts], dtype=bool)
        is_odd = np.array(
            [not REPLACED_BY_PARSER.isdisjoint(text) for text in texts], dtype=bool)
        is_turned = self._marked_elements(flagged[is_true])[axes]
        has_flag = self._marked_elements(flagged)[axes]
        table.mark_odd(joints[is_repeated | self._marked_elements(flagged[is_odd])[axes]].tolist())
        if turns_axes_with_model(self._version):
            models = table.parents[joints]
            holders = table.kinds_of(np.append(table.parents, NOWHERE)[models])
            is_turned |= ~has_flag & (table.kinds_of(models) == Kind.MODEL) & (
                (holders == OUTSIDE) | (holders == Kind.WORLD))
        return is_turned

    def _marked_elements(self, elements: Positions) -> Flags:
        """Return flags for all elements, and one more for those that are none."""
        flags = np.zeros(len(self._markup.numbers) + 1, dtype=bool)
        flags[elements] = True
        flags[-1] = False
        return flags

    # Sensors

    def sensors(self) -> Facts:
        """
        Read what only sensors have.

        :return: a :class:`SensorFacts` for each.
        """
        table = self._table
        rows = table.of_kind(Kind.SENSOR)
        if not len(rows):
            return Facts(rows, [])
        types = table.second_values(rows, 'type')
        table.mark_holding(CHANGED_BY_PARSER, rows, types)
        cameras = table.children('camera', Kind.SENSOR)
        optical = self._optical_frame_ids(cameras.rows, cameras.elements)
        gz_ids = self._values('gz_frame_id')
        ignition_ids = self._values('ignition_frame_id')
        has_camera = set(cameras.rows.tolist())
        facts = [
            SensorFacts(
                sensor_type, gz_ids.get(row, '') or ignition_ids.get(row, ''),
                row in has_camera or sensor_type in CAMERA_TYPES, optical.get(row, ''))
            for row, sensor_type in zip(
                rows.tolist(), (text.strip(WHITE_SPACE) for text in types), strict=True)]
        return Facts(rows, facts)

    def _values(self, tag: str) -> dict[int, str]:
        """Return what children of sensors say; a sensor with several of them is odd."""
        rows, elements, counts = self._table.children(tag, Kind.SENSOR)
        self._table.mark_odd(rows[counts > 1].tolist())
        return self._values_of(rows, elements)

    def _optical_frame_ids(self, rows: Rows, cameras: Positions) -> dict[int, str]:
        elements = self._markup.of('optical_frame_id')
        if not len(elements) or not len(cameras):
            return {}
        row_of_camera = np.full(len(self._markup.numbers) + 1, NOWHERE, dtype=np.intp)
        row_of_camera[cameras] = rows
        holders = row_of_camera[self._markup.holders(elements)]
        held = firsts_of_rows(holders[holders >= 0], elements[holders >= 0])
        return self._values_of(held.rows, held.elements)

    def _values_of(self, rows: Rows, elements: Positions) -> dict[int, str]:
        texts = self._markup.texts(elements)
        self._table.mark_holding(REPLACED_BY_PARSER, rows, texts)
        return dict(zip(rows.tolist(), map(value_from_text, texts), strict=True))
