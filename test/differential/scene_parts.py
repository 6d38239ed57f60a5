# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a random scene is made of, and what its builder has to know of each part."""

from __future__ import annotations

from dataclasses import dataclass, field
import enum
from typing import Any, NamedTuple
from xml.etree import ElementTree

SCENE = '@SCENE@'
"""Stands for the folder of the scene wherever a file names another."""

OWN = 0
WORLD = 1
"""Bodies: what carries a frame. OWN is whatever carries the model frame; others are counted."""

MODEL = '__model__'


class Feature(enum.Enum):
    """Parts of SDFormat that a run may leave out."""

    INCLUDES = 'includes'
    MERGES = 'merges'
    OLD_VERSIONS = 'old-versions'
    WORLDS = 'several-worlds'
    AUTOMATIC_INERTIALS = 'automatic-inertials'
    NESTED_JOINTS = 'nested-joints'
    MERGED_OVERRIDES = 'merged-overrides'
    XML_ODDITIES = 'xml-oddities'
    URDF = 'urdf'
    DEFECTS = 'defects'
    ODD_VALUES = 'odd-values'
    CHAINS = 'chains'
    POSES_SET = 'poses-set'
    STATES_OF_1_12 = 'states-of-1.12'
    OLD_STATES = 'old-states'


def features_of_release(version):
    """Return the features that a release of libsdformat reads as the package does."""
    # Each grammar knows the parts of a state by one of two names.
    is_14 = version.startswith('14.')
    return frozenset(Feature) - {Feature.STATES_OF_1_12 if is_14 else Feature.OLD_STATES}


class Visible(NamedTuple):
    """A frame as it is named from some scope."""

    reference: str
    body: int
    is_model: bool = False


@dataclass(frozen=True)
class SceneFiles:
    """A scene as text."""

    files: dict[str, str]
    """Texts by path below the scene's folder; the scene itself is ``scene.sdf``."""
    traits: frozenset[str]
    """What is in it that comparing has to know of."""
    defect: str = ''
    """What is wrong with it, or nothing."""


@dataclass
class Built:
    """A model that is done, and what can be said of it from outside."""

    element: ElementTree.Element
    name: str
    static: bool
    canonical_body: int | None
    static_body: int
    inner: list[Visible] = field(default_factory=list)
    """Everything that can be named inside it, ``__model__`` first."""
    links: list[Visible] = field(default_factory=list)
    """Links that can be named inside it."""

    @property
    def body(self) -> int:
        """What carries the model frame."""
        if self.static or self.canonical_body is None:
            return self.static_body
        return self.canonical_body

    def seen_outside(self) -> list[Visible]:
        """Name the model and its content from the scope that it is in."""
        seen = [Visible(self.name, self.body, is_model=True)]
        for reference, body, is_model in self.inner:
            own = self.body if body == OWN else body
            seen.append(Visible(f'{self.name}::{reference}', own, is_model))
        return seen

    def seen_merged(self) -> list[Visible]:
        """Name the content from the scope that the model is merged into."""
        return [Visible(reference, self.body if body == OWN else body, is_model)
                for reference, body, is_model in self.inner if reference != MODEL]


def first_canonical_body(units: list[tuple[str, Any]]) -> int | None:
    """Return the body that a model's frame is attached to by default, if there is one."""
    for kind, unit in units:
        if kind == 'link':
            return unit.body
        if kind == 'merge':
            # Its first own link comes first in the document, whatever its canonical_link says.
            return next(body for reference, body, _ in unit.links if '::' not in reference)
    for _, unit in units:
        return unit.canonical_body
    return None
