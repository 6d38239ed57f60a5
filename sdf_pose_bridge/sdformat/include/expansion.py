# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Put what a file includes in the place of its includes, in a copy of the file.

Only a file whose content is to be changed from outside needs this; others keep their includes.
"""

from __future__ import annotations

from collections.abc import Mapping
import copy
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import set_line
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.include.inclusion import Inclusion
from sdf_pose_bridge.sdformat.include.inclusion import is_merge
from sdf_pose_bridge.sdformat.include.inclusion import tops_of
from sdf_pose_bridge.sdformat.versions import may_hold_flat_names
from sdf_pose_bridge.sdformat.versions import version_of


class Expansion(NamedTuple):
    """A copy of a file, with what it includes in the place of its includes."""

    document: Document
    inclusions: dict[XmlElement, Inclusion]
    """What the includes stand for that are left: those that merge, and those with errors."""
    origins: dict[XmlElement, Document]
    """The ``origins`` of the document and of those that are merged into it, to be added to."""
    errors: tuple[SdfError, ...]
    """What was wrong with the includes that are gone."""
    warnings: tuple[SdfWarning, ...]
    """What was warned about at the includes that are gone."""


def expanded(document: Document, inclusions: Mapping[XmlElement, Inclusion]) -> Expansion:
    """
    Copy a file and expand the copy.

    :param document: a file in the newest grammar; it is not changed.
    :param inclusions: what its includes stand for, and those of the files that it includes.
    :return: the copy; what is included by what it merges is expanded too.
    """
    expander = _Expander(inclusions)
    return Expansion(
        expander.copy_of(document), expander.left, expander.origins, tuple(expander.errors),
        tuple(expander.warnings))


class _Expander:

    def __init__(self, inclusions: Mapping[XmlElement, Inclusion]) -> None:
        self.left: dict[XmlElement, Inclusion] = {}
        self.origins: dict[XmlElement, Document] = {}
        self.errors: list[SdfError] = []
        self.warnings: list[SdfWarning] = []
        self._inclusions = inclusions

    def copy_of(self, document: Document) -> Document:
        root = copy.deepcopy(document.root)
        if document.origins:
            for old, new in zip(document.root.iter(), root.iter(), strict=True):
                if old in document.origins:
                    self.origins[new] = document.origins[old]
        result = document._replace(
            root=root, origins=self.origins, may_hold_separators=True)
        # Listed first, for the copy changes on the way.
        pairs = list(zip(document.root.iter('include'), root.iter('include'), strict=True))
        for old, new in pairs:
            if old in self._inclusions:
                self._expand(new, self._inclusions[old], result)
        return result

    def _expand(self, include: XmlElement, inclusion: Inclusion, document: Document) -> None:
        if inclusion.document is None:
            self.left[include] = inclusion
            return
        included = self.copy_of(inclusion.document)
        holder = include.getparent()
        if holder is None or not _is_replaceable(include, included, str(holder.tag)):
            self.left[include] = inclusion._replace(document=included)
            if is_merge(include):
                _give_poses(included)
            return
        self.errors += inclusion.errors
        self.warnings += inclusion.warnings
        top = tops_of(included)[0]
        origin = self.origins.setdefault(top, inclusion.document)
        if _override(include, top):
            # As everywhere, an element stands where its pose is written.
            for child in top.iterchildren(etree.Element):
                self.origins.setdefault(child, origin)
            set_line(top, include.sourceline)
            self.origins[top] = self.origins[_pose_of(top)] = document.origin(include)
        holder.replace(include, top)


def _is_replaceable(include: XmlElement, included: Document, holder: str) -> bool:
    """Tell whether an include can go; one that has an error stays, so that it is reported."""
    tops = tops_of(included)
    if is_merge(include) or boolean_from_text(include.get('merge', 'false')) is None or (
            len(tops) != 1 or (holder == 'model' and tops[0].tag != 'model')):
        return False
    values = {
        str(child.tag): value_of(child)
        for child in include.iterchildren('name', 'placement_frame', 'static')}
    placement = values.get('placement_frame', '')
    is_sound = '' not in values.values() and placement != ROOT_FRAME and (
        boolean_from_text(values.get('static', 'false')) is not None) and not (
        placement and next(include.iterchildren('pose'), None) is None)
    return is_sound and _is_included_soundly(tops[0], included)


def _is_included_soundly(top: XmlElement, included: Document) -> bool:
    pose = next(top.iterchildren('pose'), None)
    is_own = top not in included.origins
    if is_own and pose is not None and pose.get('relative_to', '').strip(WHITE_SPACE):
        return False
    return may_hold_flat_names(version_of(included)) or not any(
        SEPARATOR in xml.get('name', '') for xml in top.iter(etree.Element))


def _override(include: XmlElement, top: XmlElement) -> bool:
    """Write into an element what its include says differently; tell whether that is a pose."""
    is_model = top.tag == 'model'
    for tag in ('name', 'placement_frame', 'static', 'pose') if is_model else ('name', 'pose'):
        new = next(include.iterchildren(tag), None)
        if new is None:
            continue
        if tag in ('name', 'placement_frame'):
            top.set(tag, value_of(new))
            continue
        new = copy.deepcopy(new)
        old = next(top.iterchildren(tag), None)
        if old is None:
            top.insert(0, new)
        else:
            top.replace(old, new)
    return next(include.iterchildren('pose'), None) is not None


def _give_poses(merged: Document) -> None:
    """Let each link and model that is merged have a pose, as it has when libsdformat did it."""
    for top in tops_of(merged):
        for xml in top.iterchildren('link', 'model'):
            if next(xml.iterchildren('pose'), None) is None:
                pose = etree.Element('pose')
                xml.insert(0, pose)
                set_line(pose, xml.sourceline)


def _pose_of(top: XmlElement) -> XmlElement:
    return next(top.iterchildren('pose'))
