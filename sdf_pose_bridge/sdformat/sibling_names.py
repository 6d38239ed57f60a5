# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Judge the names of elements: reserved ones, duplicates, and clashes of old files."""

from __future__ import annotations

import itertools

from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ReservedNameError
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import is_reserved
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.elements import step
from sdf_pose_bridge.sdformat.reading import Reading
from sdf_pose_bridge.sdformat.versions import renames_clashes

_PROXY = '_merged__'
_ARTICLE = {Kind.ACTOR: 'an', Kind.INERTIAL: 'an'}


class NameClaims:
    """
    The names that are taken, by scope and kind.

    :param reading: knows the elements, and takes what is wrong with their names.
    """

    def __init__(self, reading: Reading) -> None:
        self._reading = reading
        self._claims: dict[tuple[int, int, str], tuple[int, int]] = {}

    def claim(
        self, kind: Kind, xml: XmlElement, parent: int, name: str = '',
    ) -> str | None:
        """
        Read a name that no other element of its name space may have.

        Links, joints, frames and models of one parent share a name space; each other kind has its
        own. In old files one that clashes with another kind's gets a new name instead.

        :param kind: kind of the element.
        :param xml: the element.
        :param parent: index of the element that holds it; -1 for the file.
        :param name: the name to give it; empty for the one that it has.
        :return: the name, or None if it is missing or taken, which is then reported.
        """
        judged = self._judged_name(kind, xml, parent, name)
        if judged is None:
            return None
        space = Kind.FRAME if kind in FRAME_KINDS else kind
        key = (parent, space, judged)
        if key not in self._claims:
            self._claims[key] = (kind, len(self._reading.columns))
            return judged
        other_kind, index = self._claims[key]
        other = Kind(other_kind)
        if other is not kind and self._renames_clashes(kind, parent):
            return self._renamed(kind, xml, parent, judged)
        msg = (f'the name "{judged}" belongs to {_ARTICLE.get(other, "a")} {other.label} of this '
               f'scope already, {self._place_of_claim(index)}')
        self._reading.error(DuplicateNameError, xml, msg, parent, step(kind.label, judged))
        return None

    def _renames_clashes(self, kind: Kind, parent: int) -> bool:
        if parent < 0 or kind not in FRAME_KINDS or kind is Kind.MODEL:
            return False
        return renames_clashes(self._reading.version_of_element(parent)) and (
            self._reading.columns.kind(parent) is Kind.MODEL or kind is Kind.FRAME)

    def _renamed(self, kind: Kind, xml: XmlElement, parent: int, name: str) -> str:
        tries = itertools.chain(
            [f'{name}_{kind.label}'], (f'{name}_{kind.label}{i}' for i in itertools.count()))
        new_name = next(
            new_name for new_name in tries if (parent, Kind.FRAME, new_name) not in self._claims)
        self._claims[parent, Kind.FRAME, new_name] = (kind, len(self._reading.columns))
        msg = (f'the name "{name}" is that of another kind of element in this scope; this '
               f'{kind.label} is called "{new_name}" instead, and references to "{name}" mean the '
               'other one')
        self._reading.warning(xml, msg, parent, step(kind.label, name))
        return new_name

    def _place_of_claim(self, index: int) -> str:
        if index >= len(self._reading.columns):
            return 'which is not valid itself'
        return f'see {self._reading.place_of(index)}'

    def _judged_name(
        self, kind: Kind, xml: XmlElement, parent: int, given: str,
    ) -> str | None:
        written = given or xml.get('name')
        if written is None:
            msg = f'the {kind.label} has no name'
            self._reading.error(AttributeMissingError, xml, msg, parent, kind.label)
            return None
        name = written.strip(WHITE_SPACE)
        if not name:
            msg = f'the name of the {kind.label} is empty'
            self._reading.error(AttributeInvalidError, xml, msg, parent, kind.label)
            return None
        if given and SEPARATOR in name and not self._reading.allows_flat_names():
            msg = f'the name "{name}" holds "{SEPARATOR}", which sets scopes apart'
            self._reading.error(ReservedNameError, xml, msg, parent, kind.label)
            return None
        if kind is not Kind.ACTOR and is_reserved(name) and not name.startswith(_PROXY):
            rule = ('it means the frame of the world' if name == WORLD_FRAME else
                    'so are all that begin and end with two underscores')
            msg = f'the name "{name}" is reserved; {rule}'
            self._reading.error(ReservedNameError, xml, msg, parent, step(kind.label, name))
        return name
