# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Walk the XML of a document and fill the table of its elements that carry a pose."""

from __future__ import annotations

from lxml import etree

from sdf_pose_bridge.document import boolean_from_text
from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import value_of
from sdf_pose_bridge.document import WHITE_SPACE
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.element_builder import ElementBuilder
from sdf_pose_bridge.elements import Elements
from sdf_pose_bridge.elements import FrameFacts
from sdf_pose_bridge.elements import JointFacts
from sdf_pose_bridge.elements import ModelFacts
from sdf_pose_bridge.elements import Reference
from sdf_pose_bridge.elements import SensorFacts
from sdf_pose_bridge.elements import step
from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.errors import ElementIncorrectTypeError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import JointChildError
from sdf_pose_bridge.errors import JointParentError
from sdf_pose_bridge.errors import ReservedNameError
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.problems import Problems

_NO_REFERENCE = Reference('', 0)
_JOINT_TYPES = frozenset({
    'ball', 'continuous', 'fixed', 'gearbox', 'prismatic', 'revolute', 'revolute2', 'screw',
    'universal',
})
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
_NAMES_WITH_SEPARATOR = etree.XPath('//*[contains(@name, "::")]')


def elements_from_document(document: Document, problems: Problems) -> Elements:
    """
    Read all elements that carry a pose.

    :param document: a file in the newest grammar.
    :param problems: takes what is wrong with names, values and structure; references are not
        looked up here.
    :return: the elements. Where something is wrong the element is kept if it can be, so that
        other errors are found and none follows from the first.
    """
    table = ElementBuilder(document.path, problems)
    _ElementReader(table).read(document)
    return table.elements()


class _ElementReader:
    """Walks the XML; one method for each element of the grammar."""

    def __init__(self, table: ElementBuilder) -> None:
        self._table = table

    # The file

    def read(self, document: Document) -> None:
        self._check_separators(document.root)
        root = -1
        first = ''
        for xml in document.root.iterchildren(etree.Element):
            tag = xml.tag
            if tag == 'world':
                self._world(xml)
            elif tag == 'include':
                self._include(xml, -1)
            elif tag in _TOP_KINDS:
                if first:
                    self._second_at_top(xml, first)
                    continue
                first = step(tag, xml.get('name', '').strip(WHITE_SPACE))
                root = self._table.add(Kind.ROOT, xml, ROOT_FRAME, -1, -1)
                if tag == 'model':
                    self._top_model(xml, root)
                else:
                    self._leaf(_TOP_KINDS[tag], xml, root, root)

    def _second_at_top(self, xml: XmlElement, first: str) -> None:
        this = step(str(xml.tag), xml.get('name', '').strip(WHITE_SPACE))
        if this == first:
            msg = f'{this} stands at the top of this file already'
            self._table.error(DuplicateNameError, xml, msg, -1, this)
        else:
            msg = (f'{this} stands at the top of this file after {first}; only one model, light '
                   'or actor may')
            self._table.error(ElementIncorrectTypeError, xml, msg, -1, this)

    def _top_model(self, xml: XmlElement, root: int) -> None:
        model = self._model(xml, root)
        relative_to = '' if model is None else self._table.element(model).relative_to
        if model is not None and relative_to:
            msg = (f'relative_to="{relative_to}": the model at the top of a file is placed in the '
                   'implicit root, which has no frames')
            self._table.error(AttributeInvalidError, xml, msg, model, 'pose')
            self._table.forget_relative_to(model)

    def _check_separators(self, root: XmlElement) -> None:
        found: list[XmlElement] = _NAMES_WITH_SEPARATOR(root)
        for xml in found:
            path = [xml, *xml.iterancestors()]
            if any(':' in str(step.tag) or step.tag == 'plugin' for step in path):
                continue
            msg = f'the name "{xml.get("name")}" holds "{SEPARATOR}", which stands between scopes'
            part = '/'.join(str(step.tag) for step in path[-2::-1])
            self._table.error(ReservedNameError, xml, msg, -1, part)

    def _include(self, xml: XmlElement, parent: int) -> None:
        uri = next((value_of(child) for child in xml.iterchildren('uri')), '')
        msg = f'the include of "{uri}" cannot be read: includes are not supported yet'
        self._table.error(ElementInvalidError, xml, msg, parent, 'include')

    # World and model

    def _world(self, xml: XmlElement) -> None:
        name = self._table.claimed_name(Kind.WORLD, xml, -1)
        if name is None:
            return
        world = self._table.add(Kind.WORLD, xml, name, -1, -1)
        for child in xml.iterchildren(etree.Element):
            tag = child.tag
            if tag == 'model':
                self._model(child, world)
            elif tag == 'frame':
                self._frame(child, world)
            elif tag == 'joint':
                self._joint(child, world)
            elif tag == 'light':
                self._leaf(Kind.LIGHT, child, world, world)
            elif tag == 'actor':
                self._leaf(Kind.ACTOR, child, world, world)
            elif tag == 'include':
                self._include(child, world)

    def _model(self, xml: XmlElement, parent: int) -> int | None:
        name = self._table.claimed_name(Kind.MODEL, xml, parent)
        if name is None:
            return None
        model = self._table.add(Kind.MODEL, xml, name, parent, parent)
        self._table.set_facts(model, ModelFacts(
            self._static(xml, model),
            self._table.reference(xml, 'canonical_link', model),
            self._table.reference(xml, 'placement_frame', model)))
        for child in xml.iterchildren(etree.Element):
            tag = child.tag
            if tag == 'link':
                self._link(child, model)
            elif tag == 'joint':
                self._joint(child, model)
            elif tag == 'frame':
                self._frame(child, model)
            elif tag == 'model':
                self._model(child, model)
            elif tag == 'include':
                self._include(child, model)
        return model

    def _static(self, xml: XmlElement, model: int) -> bool:
        static = next(xml.iterchildren('static'), None)
        text = '' if static is None else value_of(static)
        value = boolean_from_text(text) if text else False
        if static is not None and value is None:
            msg = f'"{text}" is no boolean; it must be true, false, 1 or 0'
            self._table.error(ElementInvalidError, static, msg, model, 'static')
        return bool(value)

    # What a model and a world hold

    def _link(self, xml: XmlElement, model: int) -> None:
        name = self._table.claimed_name(Kind.LINK, xml, model)
        if name is None:
            return
        link = self._table.add(Kind.LINK, xml, name, model, model)
        for child in xml.iterchildren(etree.Element):
            kind = _LINK_CHILD_KINDS.get(str(child.tag))
            if kind is Kind.SENSOR:
                self._sensor(child, link, model)
            elif kind is Kind.INERTIAL:
                self._table.add(kind, child, kind.label, link, model)
            elif kind is not None:
                self._leaf(kind, child, link, model)

    def _frame(self, xml: XmlElement, scope: int) -> None:
        name = self._table.claimed_name(Kind.FRAME, xml, scope)
        if name is None:
            return
        frame = self._table.add(Kind.FRAME, xml, name, scope, scope)
        attached_to = self._table.reference(xml, 'attached_to', frame)
        self._table.set_facts(frame, FrameFacts(attached_to))

    def _joint(self, xml: XmlElement, scope: int) -> None:
        name = self._table.claimed_name(Kind.JOINT, xml, scope)
        if name is None:
            return
        joint = self._table.add(Kind.JOINT, xml, name, scope, scope)
        joint_type = self._joint_type(xml, joint)
        self._table.set_facts(joint, JointFacts(
            joint_type,
            self._joint_end(xml, 'parent', joint, joint_type),
            self._joint_end(xml, 'child', joint, joint_type),
            tuple(
                Reference(xyz.get('expressed_in', '').strip(WHITE_SPACE), xyz.sourceline or 0)
                for axis in xml.iterchildren('axis', 'axis2')
                for xyz in axis.iterchildren('xyz')
                if xyz.get('expressed_in', '').strip(WHITE_SPACE))))
        for child in xml.iterchildren('sensor'):
            self._sensor(child, joint, scope)

    def _joint_type(self, xml: XmlElement, joint: int) -> str:
        written = xml.get('type')
        if written is None:
            self._table.error(AttributeMissingError, xml, 'the joint has no type', joint, '')
            return ''
        joint_type = written.strip(WHITE_SPACE).lower()
        if joint_type not in _JOINT_TYPES:
            known = ', '.join(sorted(_JOINT_TYPES))
            msg = f'"{written}" is no type of joint; known are {known}'
            self._table.error(AttributeInvalidError, xml, msg, joint, '')
        return joint_type

    def _joint_end(self, xml: XmlElement, end: str, joint: int, joint_type: str) -> Reference:
        element = next(xml.iterchildren(end), None)
        name = '' if element is None else value_of(element)
        if element is None or not name:
            missing = JointParentError if end == 'parent' else JointChildError
            self._table.error(
                missing if joint_type == 'ball' else ElementMissingError,
                xml, f'the joint has no <{end}>; it must name a frame', joint, '')
            return _NO_REFERENCE
        if name == ROOT_FRAME:
            msg = f'"{name}" is reserved; it cannot be the {end} of a joint'
            self._table.error(ReservedNameError, element, msg, joint, end)
            return _NO_REFERENCE
        return Reference(name, element.sourceline or 0)

    def _sensor(self, xml: XmlElement, parent: int, scope: int) -> None:
        sensor = self._leaf(Kind.SENSOR, xml, parent, scope)
        if sensor is None:
            return
        frame_ids = xml.iterchildren('gz_frame_id', 'ignition_frame_id')
        camera = next(xml.iterchildren('camera'), None)
        optical = None if camera is None else next(camera.iterchildren('optical_frame_id'), None)
        self._table.set_facts(sensor, SensorFacts(
            xml.get('type', '').strip(WHITE_SPACE),
            next(filter(None, map(value_of, frame_ids)), ''),
            camera is not None,
            '' if optical is None else value_of(optical)))

    def _leaf(self, kind: Kind, xml: XmlElement, parent: int, scope: int) -> int | None:
        name = self._table.claimed_name(kind, xml, parent)
        return None if name is None else self._table.add(kind, xml, name, parent, scope)
