# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read what only models and frames have besides a name and a pose."""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.sdformat.values import boolean_from_text
from sdf_pose_bridge.sdformat.values import frame_of_attribute
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import value_of
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

PLACEMENT_OF_MERGED_MODEL = '{sdf_pose_bridge}placement_frame'
"""Attribute of the frame that replaces a merged model's frame: the model's placement frame."""


class ModelDetails(NamedTuple):
    """What only a model has."""

    is_static: bool
    canonical_link: str
    """Value of the attribute; empty for the default."""
    placement_frame: str
    """The frame that the pose places; empty for the model frame."""


class FrameDetails(NamedTuple):
    """What only an explicit frame has."""

    attached_to: str
    """Value of the attribute; empty for the frame of its scope."""
    placement_frame: str = ''
    """The frame that the pose places; empty for this one. Only proxies of merged models have
    one."""


def model_details_from_element(xml: XmlElement) -> ModelDetails:
    """
    Read a model.

    :return: its details.
    """
    static = first_child(xml, 'static')
    return ModelDetails(
        static is not None and bool(boolean_from_text(value_of(static))),
        frame_of_attribute(xml, 'canonical_link'), frame_of_attribute(xml, 'placement_frame'))


def frame_details_from_element(xml: XmlElement) -> FrameDetails:
    """
    Read an explicit frame.

    :return: its details.
    """
    return FrameDetails(
        frame_of_attribute(xml, 'attached_to'), xml.get(PLACEMENT_OF_MERGED_MODEL, ''))
