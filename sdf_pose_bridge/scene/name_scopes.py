# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Look up the frames that references name: in their own scope and below, never above.

Source: ``ScopedGraph.hh`` of libsdformat. A reference in a scope is the absolute name
``scope::reference``; nothing is searched in outer scopes.
"""

from __future__ import annotations

from collections import defaultdict
from itertools import islice

import numpy as np

from sdf_pose_bridge.errors import DuplicateNameError
from sdf_pose_bridge.geometry.chains import ends_from_pointers
from sdf_pose_bridge.names import MODEL_FRAME, ROOT_FRAME, scoped_name, SEPARATOR, WORLD_FRAME
from sdf_pose_bridge.nearest_names import NameIndex
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.elements import Elements, NO_ELEMENT
from sdf_pose_bridge.sdformat.grammar import Kind

_OWN_FRAME = SEPARATOR + MODEL_FRAME
_MOST_NAMES_COMPARED = 2000
_MOST_STEPS = 300
"""Largest number of names in a reference into a missing include, like the limit of nesting."""

IS_FRAME_KIND = np.array([kind.is_frame for kind in Kind])
"""For each kind whether references can name elements of it."""


class NameScopes:
    """
    The absolute names of all elements, and the frames that they name.

    A scope is the index of the model, world or root in which a reference is written.

    ``names[i]`` is the absolute name of element i, such as ``robot::arm::hand``, without the name
    of the world, ``scope_of[i]`` the scope of its references, and ``roots[i]`` its world or
    implicit root; each of these is a name space of its own.
    """

    def __init__(self, elements: Elements, problems: Problems) -> None:
        self._elements = elements
        self._problems = problems
        self._indices: dict[int, NameIndex] = {}
        self.names = _absolute_names(elements)
        self.scope_of: list[int] = elements.scopes.tolist()
        self.roots: list[int] = ends_from_pointers(elements.parents).tolist()
        self._is_model: list[bool] = (elements.kinds == Kind.MODEL).tolist()
        self._frames = defaultdict[int, dict[str, int]](dict)
        for index in np.flatnonzero(IS_FRAME_KIND[elements.kinds]).tolist():
            frames, name = self._frames[self.roots[index]], self.names[index]
            for each in (name, name + _OWN_FRAME) if self._is_model[index] else (name,):
                other = frames.setdefault(each, index)
                # Only names with the separator, as old files may have, are not reported already.
                if other != index and SEPARATOR in elements.names[index] + elements.names[other]:
                    msg = f'the name "{each}" is in use already, see {elements.place(other)}'
                    problems.error(DuplicateNameError(msg, elements.place(index)))
        for world in np.flatnonzero(elements.kinds == Kind.WORLD).tolist():
            self._frames[world][WORLD_FRAME] = world

    def frame(self, scope: int, reference: str) -> int | None:
        """Find the frame that a reference names, as written and not empty."""
        outer = self.names[scope] if self._is_model[scope] else ''
        return self._frames[self.roots[scope]].get(scoped_name(outer, reference))

    def missing_uri(self, scope: int, reference: str) -> str:
        """Return the URI of the missing include that a reference leads into, or ''."""
        steps = reference.split(SEPARATOR, _MOST_STEPS)
        for count, step in enumerate(steps):
            outer = self.frame(scope, SEPARATOR.join(steps[:count])) if count else scope
            uris = self._elements.missing_includes.get(NO_ELEMENT if outer is None else outer, {})
            uri = uris.get(step) or uris.get('')
            if uri:
                return uri
        return ''

    def _described(self, scope: int) -> str:
        """Return a scope as part of a message: ``model "robot::arm"``."""
        kind = self._elements.kind(scope)
        if kind is Kind.ROOT:
            return 'the top of the file'
        name = self._elements.names[scope] if kind is Kind.WORLD else self.names[scope]
        return f'{kind.label} "{name}"'

    def reason_without_frame(self, scope: int, reference: str) -> str:
        """Return the scope of a reference that names no frame, and the likely reason."""
        hint = self._hint(scope, reference) if self._problems.allows_hint() else ''
        return f'names no frame in {self._described(scope)}{hint}'

    def _hint(self, scope: int, reference: str) -> str:
        first = reference.split(SEPARATOR, 1)[0]
        if self._is_model[scope] and first == self._elements.names[scope]:
            rest = reference[len(first) + len(SEPARATOR):]
            return (f'; inside a model its own name is not visible, write '
                    f'"{rest or MODEL_FRAME}"')
        if reference == WORLD_FRAME:  # a world has this frame, so this is a model
            return ('; in a model only joints can name the world, and the <pose> of the model '
                    'itself is relative to it')
        scoped = reference.replace('/', SEPARATOR)
        if self.frame(scope, scoped) is not None:
            return (f'; did you mean "{scoped}"?' if scoped != reference else
                    f'; a joint finds no name that begins with "{SEPARATOR}"')
        outer = int(self._elements.parents[scope])
        while outer >= 0:
            if self.frame(outer, scoped) is not None:
                return (f'; {self._described(outer)} has a frame "{scoped}", but names of '
                        'enclosing scopes cannot be used here')
            outer = int(self._elements.parents[outer])
        if scope not in self._indices:
            prefix = self.names[scope] + SEPARATOR if self._is_model[scope] else ''
            visible = (name[len(prefix):] for name in self._frames[self.roots[scope]]
                       if name.startswith(prefix))
            self._indices[scope] = NameIndex(islice(visible, _MOST_NAMES_COMPARED))
        return self._indices[scope].hint(reference)


def _absolute_names(elements: Elements) -> list[str]:
    names: list[str] = []
    parents, kinds = elements.parents.tolist(), elements.kinds.tolist()
    for name, parent, kind in zip(elements.names, parents, kinds, strict=True):
        if parent < 0:
            names.append(WORLD_FRAME if kind == Kind.WORLD else ROOT_FRAME)
        else:
            names.append(scoped_name('' if parents[parent] < 0 else names[parent], name))
    return names
