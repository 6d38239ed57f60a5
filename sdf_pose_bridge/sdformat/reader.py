# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Walk the XML of a document and fill the table of its elements that carry a pose."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple
from typing import TYPE_CHECKING

from lxml import etree

from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ElementIncorrectTypeError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import MergeIncludeError
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import MODEL_FRAME
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.element_builder import ElementBuilder
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.elements import FrameFacts
from sdf_pose_bridge.sdformat.elements import ModelFacts
from sdf_pose_bridge.sdformat.elements import NOWHERE
from sdf_pose_bridge.sdformat.include.inclusions import DocumentSet
from sdf_pose_bridge.sdformat.joint_reader import joint_facts_from_xml
from sdf_pose_bridge.sdformat.sensor_facts import sensor_facts_from_xml
from sdf_pose_bridge.sdformat.sibling_names import NameClaims

if TYPE_CHECKING:
    from sdf_pose_bridge.sdformat.include.include_reader import Include
    from sdf_pose_bridge.sdformat.include.inclusion import Inclusion

_TOP_KINDS = {'model': Kind.MODEL, 'light': Kind.LIGHT, 'actor': Kind.ACTOR}
_LINK_CHILD_KINDS = {
    'visual': Kind.VISUAL,
    'collision': Kind.COLLISION,
    'sensor': Kind.SENSOR,
    'light': Kind.LIGHT,
    'inertial': Kind.INERTIAL,
    'particle_emitter': Kind.PARTICLE_EMITTER,
    'projector': Kind.PROJECTOR,
}


class _Scope(NamedTuple):
    """Where elements are being read into."""

    holder: int
    """Index of the model, world or root."""
    proxy: str = ''
    """For what a merge brings: the frame that stands for the merged model's own."""

    def name(self, reference: str) -> str:
        """Return a reference as it has to be written in the scope."""
        return self.proxy if self.proxy and reference == MODEL_FRAME else reference


def elements_from_documents(
    documents: DocumentSet,
    problems: Problems,
    *,
    broken: frozenset[str] = frozenset(),
    skips_missing: bool = False,
) -> Elements:
    """
    Read all elements that carry a pose.

    :param documents: a file and what it includes, in the newest grammar.
    :param problems: takes what is wrong with names, values and structure; references are not
        looked up here.
    :param broken: paths of files that are known not to be valid, which are not merged.
    :param skips_missing: whether an include that cannot be found is left out with a warning.
    :return: the elements. Where something is wrong the element is kept if it can be, so that
        other errors are found and none follows from the first.
    """
    table = ElementBuilder(documents.document, problems)
    _ElementReader(table, documents.inclusions, broken, skips_missing).read(documents.document)
    return table.elements()


class _ElementReader:
    """Walks the XML; one method for each element of the grammar."""

    def __init__(
        self,
        table: ElementBuilder,
        inclusions: Mapping[XmlElement, Inclusion],
        broken: frozenset[str],
        skips_missing: bool,  # noqa: FBT001
    ) -> None:
        self._table = table
        self._names = NameClaims(table)
        self._inclusions = inclusions
        self._broken = broken
        self._skips_missing = skips_missing

    # The file

    def read(self, document: Document) -> None:
        for warning in document.warnings:
            self._table.note_warning(warning)
        self._table.check_separators(document)
        first = ''
        for xml in document.root.iterchildren(etree.Element):
            if xml.tag == 'world':
                self._world(xml)
            elif xml.tag in _TOP_KINDS or xml.tag == 'include':
                if first:
                    self._second_at_top(xml, first)
                    continue
                first = self._table.described(xml)
                root = _Scope(self._table.add(Kind.ROOT, xml, ROOT_FRAME, NOWHERE, NOWHERE))
                if xml.tag == 'model':
                    self._table.check_top_pose(xml, root.holder)
                    self._model(xml, root)
                elif xml.tag == 'include':
                    self._include(xml, root)
                else:
                    self._leaf(_TOP_KINDS[str(xml.tag)], xml, root.holder, root)

    def _second_at_top(self, xml: XmlElement, first: str) -> None:
        this = self._table.described(xml)
        if this == first:
            msg = f'{this} stands at the top of this file already'
            self._table.error(DuplicateNameError, xml, msg, NOWHERE, this)
        else:
            msg = (f'{this} stands at the top of this file after {first}; only one model, light '
                   'or actor may')
            self._table.error(ElementIncorrectTypeError, xml, msg, NOWHERE, this)

    # Includes

    def _include(self, xml: XmlElement, scope: _Scope) -> None:
        # Many files include nothing, and need not wait for this.
        from sdf_pose_bridge.sdformat.include.include_reader import include_from_xml
        include = include_from_xml(
            xml, self._inclusions[xml], self._table, scope.holder,
            skips_missing=self._skips_missing)
        if include is None:
            return
        top = include.top
        kind = _TOP_KINDS[str(top.tag)]
        if include.is_merge:
            self._merge(include, scope)
        elif kind is Kind.MODEL:
            self._included_model(include, scope)
        elif self._table.columns.kind(scope.holder) is not Kind.MODEL:
            name = self._names.claim(kind, xml, scope.holder, include.name)
            if name is not None and include.has_pose:
                self._table.add(kind, xml, name, scope.holder, scope.holder)
            elif name is not None:
                with self._table.reading(include.document):
                    self._table.add(kind, top, name, scope.holder, scope.holder)
        else:
            msg = f'the included {kind.label} is left out; a model can include only models'
            self._table.warning(xml, msg, scope.holder, 'include')

    def _included_model(self, include: Include, scope: _Scope) -> None:
        name = self._names.claim(Kind.MODEL, include.xml, scope.holder, include.name)
        if name is None:
            return
        model = NOWHERE
        if include.has_pose:
            model = self._table.add(Kind.MODEL, include.xml, name, scope.holder, scope.holder)
        with self._table.reading(include.document):
            if not include.has_pose:
                model = self._table.add(Kind.MODEL, include.top, name, scope.holder, scope.holder)
            self._complete_model(include.top, model, scope, include)

    def _merge(self, include: Include, scope: _Scope) -> None:
        holder = self._table.columns.kind(scope.holder)
        if include.top.tag != 'model' or holder not in (Kind.MODEL, Kind.WORLD):
            msg = (f'merge="true" on the include of {self._table.described(include.top)}: only a '
                   'model can be merged, into a model or a world')
            self._table.error(MergeIncludeError, include.xml, msg, scope.holder, 'include')
            return
        proxy = f'_merged__{include.name}__model__'
        if (include.document.path in self._broken
                or self._names.claim(
                    Kind.FRAME, include.xml, scope.holder, proxy) is None):
            return
        frame = NOWHERE
        if include.has_pose:
            frame = self._table.add(
                Kind.FRAME, include.xml, proxy, scope.holder, scope.holder)
        with self._table.reading(include.document):
            if not include.has_pose:
                frame = self._table.add(
                    Kind.FRAME, include.top, proxy, scope.holder, scope.holder)
            own_frame = MODEL_FRAME if holder is Kind.MODEL else WORLD_FRAME
            columns = self._table.columns
            relative_to = columns.relative_to.get(frame, own_frame)
            columns.relative_to[frame] = scope.name(relative_to)
            placement = include.placement_frame or self._table.reference(
                include.top, 'placement_frame', frame)
            merged = _Scope(scope.holder, proxy)
            self._model_children(include.top, merged, is_in_world=holder is Kind.WORLD)
            columns.frames[frame] = FrameFacts(
                self._table.reference(include.top, 'canonical_link', frame)
                or self._table.first_link_name(frame + 1, scope.holder),
                merged.name(placement))

    # World and model

    def _world(self, xml: XmlElement) -> None:
        name = self._names.claim(Kind.WORLD, xml, NOWHERE)
        if name is None:
            return
        scope = _Scope(self._table.add(Kind.WORLD, xml, name, NOWHERE, NOWHERE))
        for child in xml.iterchildren(etree.Element):
            tag = child.tag
            if tag == 'model':
                self._model(child, scope)
            elif tag == 'frame':
                self._frame(child, scope)
            elif tag == 'joint':
                self._joint(child, scope)
            elif tag == 'light':
                self._leaf(Kind.LIGHT, child, scope.holder, scope)
            elif tag == 'actor':
                self._leaf(Kind.ACTOR, child, scope.holder, scope)
            elif tag == 'include':
                self._include(child, scope)

    def _model(self, xml: XmlElement, scope: _Scope) -> None:
        name = self._names.claim(Kind.MODEL, xml, scope.holder)
        if name is None:
            return
        model = self._table.add(Kind.MODEL, xml, name, scope.holder, scope.holder)
        self._complete_model(xml, model, scope)

    def _complete_model(
        self, xml: XmlElement, model: int, scope: _Scope, include: Include | None = None,
    ) -> None:
        self._hang_on_proxy(model, scope)
        placement = '' if include is None else include.placement_frame
        is_static = None if include is None else include.is_static
        self._table.columns.models[model] = ModelFacts(
            self._static(xml, model) if is_static is None else is_static,
            self._table.reference(xml, 'canonical_link', model),
            placement or self._table.reference(xml, 'placement_frame', model))
        self._model_children(xml, _Scope(model))

    def _model_children(
        self, xml: XmlElement, scope: _Scope, *, is_in_world: bool = False,
    ) -> None:
        for child in xml.iterchildren(etree.Element):
            tag = child.tag
            if tag == 'link':
                if is_in_world:
                    msg = (f'{self._table.described(child)} cannot be merged into a world, which '
                           'has no links of its own')
                    self._table.error(MergeIncludeError, child, msg, scope.holder, '')
                else:
                    self._link(child, scope)
            elif tag == 'joint':
                self._joint(child, scope)
            elif tag == 'frame':
                self._frame(child, scope)
            elif tag == 'model':
                self._model(child, scope)
            elif tag == 'include':
                self._include(child, scope)

    def _hang_on_proxy(self, index: int, scope: _Scope) -> None:
        """Place what a merge brings in the frame that stands for the merged model's own."""
        if not scope.proxy:
            return
        columns = self._table.columns
        relative_to = columns.relative_to.get(index)
        has_own_default = columns.kind(index) in (Kind.FRAME, Kind.JOINT)
        if relative_to == MODEL_FRAME or not (relative_to or has_own_default):
            columns.relative_to[index] = scope.proxy

    def _static(self, xml: XmlElement, model: int) -> bool:
        static = next(xml.iterchildren('static'), None)
        text = '' if static is None else value_of(static)
        value = boolean_from_text(text) if text else False
        if static is not None and value is None:
            msg = f'"{text}" is no boolean; it must be true, false, 1 or 0'
            self._table.error(ElementInvalidError, static, msg, model, 'static')
        return bool(value)

    # What a model and a world hold

    def _link(self, xml: XmlElement, scope: _Scope) -> None:
        name = self._names.claim(Kind.LINK, xml, scope.holder)
        if name is None:
            return
        link = self._table.add(Kind.LINK, xml, name, scope.holder, scope.holder)
        self._hang_on_proxy(link, scope)
        for child in xml.iterchildren(etree.Element):
            kind = _LINK_CHILD_KINDS.get(str(child.tag))
            if kind is Kind.SENSOR:
                self._sensor(child, link, scope)
            elif kind is Kind.INERTIAL:
                self._table.add(kind, child, kind.label, link, scope.holder)
            elif kind is not None:
                self._leaf(kind, child, link, scope)

    def _frame(self, xml: XmlElement, scope: _Scope) -> None:
        name = self._names.claim(Kind.FRAME, xml, scope.holder)
        if name is None:
            return
        frame = self._table.add(Kind.FRAME, xml, name, scope.holder, scope.holder)
        self._hang_on_proxy(frame, scope)
        attached_to = self._table.reference(xml, 'attached_to', frame)
        self._table.columns.frames[frame] = FrameFacts(scope.name(attached_to) or scope.proxy)

    def _joint(self, xml: XmlElement, scope: _Scope) -> None:
        name = self._names.claim(Kind.JOINT, xml, scope.holder)
        if name is None:
            return
        joint = self._table.add(Kind.JOINT, xml, name, scope.holder, scope.holder)
        self._hang_on_proxy(joint, scope)
        self._table.columns.joints[joint] = joint_facts_from_xml(
            xml, self._table, joint, scope.name)
        for child in xml.iterchildren('sensor'):
            self._sensor(child, joint, scope)

    def _sensor(self, xml: XmlElement, parent: int, scope: _Scope) -> None:
        sensor = self._leaf(Kind.SENSOR, xml, parent, scope)
        if sensor is not None:
            self._table.columns.sensors[sensor] = sensor_facts_from_xml(xml)

    def _leaf(self, kind: Kind, xml: XmlElement, parent: int, scope: _Scope) -> int | None:
        name = self._names.claim(kind, xml, parent)
        if name is None:
            return None
        leaf = self._table.add(kind, xml, name, parent, scope.holder)
        if scope.proxy and self._table.columns.relative_to.get(leaf) == MODEL_FRAME:
            msg = ('relative_to="__model__" means the model that this is merged into, not the one '
                   'that it was written in')
            self._table.warning(xml, msg, leaf, 'pose')
        return leaf
