# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What an ``<include>`` stands for."""

from __future__ import annotations

from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import XmlElement

DEEPEST = 64
"""Files may include one another to this depth."""

TOP_TAGS = ('model', 'actor', 'light')
"""What a file can be included for, in the order in which libsdformat looks."""


class Inclusion(NamedTuple):
    """What an ``<include>`` stands for."""

    document: Document | None
    """The file that was read, changed where the include has parameters; None if there is none."""
    reason: str = ''
    """Why nothing could be found; empty if something was."""
    error: SdfError | None = None
    """What is wrong with the file that was found, or None."""
    warnings: tuple[SdfWarning, ...] = ()
    errors: tuple[SdfError, ...] = ()
    """What is wrong with the parameters that change the file."""


def tops_of(document: Document) -> list[XmlElement]:
    """
    Return what a file can be included for.

    :param document: a file.
    :return: the models, actors and lights at its top; only one of them should be there.
    """
    return [xml for xml in document.root.iterchildren(etree.Element) if xml.tag in TOP_TAGS]


def is_merge(include: XmlElement) -> bool:
    """
    Tell whether an include merges.

    :param include: the element.
    :return: whether its ``merge`` attribute is true.
    """
    return bool(boolean_from_text(include.get('merge', '')))
