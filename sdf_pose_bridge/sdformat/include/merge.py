# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Merge an included model into the model or world that includes it.

The content of the model moves into the scope of its new parent. A proxy frame named
``_merged__NAME__model__`` takes the place of its model frame. A placement frame places the proxy
frame here: parameters of an outer include that change the placement frame later do not move the
proxy frame. Source: ``insertIncludedElement`` in libsdformat's ``parser.cc``.
"""

from __future__ import annotations

from collections.abc import Callable
import contextlib
from typing import NamedTuple, TypeAlias

from lxml import etree

from sdf_pose_bridge.errors import MergeIncludeError
from sdf_pose_bridge.geometry.pose_attributes import PoseTextError
from sdf_pose_bridge.geometry.poses import Pose, pose_product
from sdf_pose_bridge.names import MODEL_FRAME, PROXY_END, PROXY_START, WORLD_FRAME
from sdf_pose_bridge.sdformat.grammar import Definition, definition_of, Kind, PARTS_OF_MODEL
from sdf_pose_bridge.sdformat.poses import pose_format_of, pose_from_text, text_from_pose
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    described,
    first_child,
    is_foreign_itself,
    text_of,
    value_of,
    XmlElement,
)

_POSES_OF_PARTS = etree.XPath('*[not(self::inertial)]/pose')


class ModelByItself(NamedTuple):
    """The facts that a merge needs about the model of a valid file."""

    canonical_link: str
    """The name of its canonical link in it; empty if it has none."""
    pose: Pose
    """Its model frame in its placement frame."""


ModelCheck: TypeAlias = Callable[[XmlElement], ModelByItself | None]
"""
Checks a model file by itself, given its ``sdf`` element, in which the model has no pose.

If the file is not valid, it reports that and returns None.
"""


def merge(
    include: XmlElement, model: XmlElement, sources: Sources, model_by_itself: ModelCheck,
) -> None:
    """
    Replace an include by the content of the model that it merges, if that is valid.

    :param model: the included element, with the parts that the include overrides.
    """
    parent = next(include.iterancestors())
    if model.tag != 'model' or parent.tag not in ('model', 'world'):
        msg = (f'merge="true" on the include of {described(model)}: only a model can be merged, '
               'into a model or a world')
        sources.error(MergeIncludeError, include, msg)
        return
    proxy = _proxy_frame(include, model, parent, sources, model_by_itself)
    if proxy is None:
        return
    moved = [
        child for child in child_elements(model)
        if child.tag in PARTS_OF_MODEL or is_foreign_itself(child)]
    tags = PARTS_OF_MODEL.keys() - definition_of(str(parent.tag)).children.keys()
    misfits = [child for child in moved if child.tag in tags]
    for child in misfits:
        msg = f'{described(child)} cannot be merged into a world, which has no links of its own'
        sources.error(MergeIncludeError, child, msg)
    if misfits:
        return
    include.addprevious(proxy)
    for child in moved:
        if child.tag in PARTS_OF_MODEL:
            _replace_model_frame(
                child, PARTS_OF_MODEL[child.tag], attribute_of(proxy, 'name'), sources)
        sources.set_origin(child, file=sources.path(child), is_checked=True)
        include.addprevious(child)
    parent.remove(include)


def _proxy_frame(
    include: XmlElement, model: XmlElement, parent: XmlElement, sources: Sources,
    model_by_itself: ModelCheck,
) -> XmlElement | None:
    """Return the frame that takes the place of the model frame; None for an invalid model."""
    pose = first_child(model, 'pose')
    relative_to = '' if pose is None else attribute_of(pose, 'relative_to')
    proxy_pose = etree.Element('pose', relative_to=relative_to or (
        MODEL_FRAME if parent.tag == 'model' else WORLD_FRAME))
    root = etree.Element('sdf')
    root.append(model)
    placed = Pose()
    if pose is not None:
        sources.set_source(proxy_pose, pose)
        with contextlib.suppress(PoseTextError):  # it is an error of its file
            placed, doubts = pose_from_text(text_of(pose), pose_format_of(pose))
            for doubt in doubts:
                sources.warning(pose, doubt)
    # The rest does not depend on the pose, and is the same for many includes.
    for each in [*child_elements(model, 'pose')]:
        model.remove(each)
    known = model_by_itself(root)
    if known is None:
        return None
    proxy_pose.text = text_from_pose(pose_product(placed, known.pose))
    name = f'{PROXY_START}{attribute_of(model, "name")}{PROXY_END}'
    canonical_link = attribute_of(model, 'canonical_link') or known.canonical_link
    proxy = etree.Element('frame', {'name': name, 'attached_to': canonical_link})
    placement = attribute_of(model, 'placement_frame')
    proxy.append(proxy_pose)
    sources.set_source(
        proxy, model, include=sources.origin(model).include,
        pose_file=sources.origin(model).pose_file,
        is_named_by_include=first_child(include, 'name') is not None,
        placement_frame=name if placement == MODEL_FRAME else placement)
    return proxy


def _replace_model_frame(
    xml: XmlElement, definition: Definition, proxy: str, sources: Sources,
) -> None:
    """Let references to the model frame refer to the proxy frame."""
    # libsdformat does not adapt the poses of visuals and similar elements.
    for pose in _POSES_OF_PARTS(xml) if definition.kind not in (None, Kind.MODEL) else ():
        if attribute_of(pose, 'relative_to') == MODEL_FRAME:
            msg = ('relative_to="__model__" means the model that this is merged into, not the one '
                   'that it was written in')
            sources.warning(pose, msg)
    # By default, the poses of frames and joints are not relative to the model.
    is_in_model = definition.kind not in (None, Kind.FRAME, Kind.JOINT)
    if is_in_model and first_child(xml, 'pose') is None:
        xml.insert(0, etree.Element('pose'))
    for path, attribute in definition.references:
        for element in xml.iterfind(path):
            name = attribute_of(element, attribute) if attribute else value_of(element)
            if name == MODEL_FRAME or (not name and (is_in_model or attribute == 'attached_to')):
                if attribute:
                    element.set(attribute, proxy)
                else:
                    element[:] = []
                    element.text = proxy
