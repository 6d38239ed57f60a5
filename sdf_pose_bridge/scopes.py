# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look up the frames that references name: siblings and downwards, never upwards."""

from __future__ import annotations

from collections.abc import Iterator

from sdf_pose_bridge.elements import Elements
from sdf_pose_bridge.elements import NOWHERE
from sdf_pose_bridge.errors import hint_from_names
from sdf_pose_bridge.names import FRAME_KINDS
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.names import MODEL_FRAME
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.names import WORLD_FRAME

_OWN_FRAME = SEPARATOR + MODEL_FRAME
_MOST_NAMES_COMPARED = 2000


class Scopes:
    """
    The absolute names of all elements, and the frames that they name.

    :param table: the elements.

    ``names[i]`` is the absolute name of element i, such as ``robot::arm::hand``: the names of the
    models that hold it and its own, without the world's. ``roots[i]`` is the index of the world
    or implicit root that it belongs to; each of these has names of its own.
    """

    def __init__(self, table: Elements) -> None:
        self._elements = table.elements
        self._missing = table.missing
        self.names: list[str] = []
        self.roots: list[int] = []
        self._frames: dict[int, dict[str, int]] = {}
        prefixes: list[str] = []
        for index, (kind, own_name, parent, *_) in enumerate(self._elements):
            if parent < 0:
                self.roots.append(index)
                self.names.append(WORLD_FRAME if kind is Kind.WORLD else ROOT_FRAME)
                self._frames[index] = {}
                prefixes.append('')
                continue
            root = self.roots[parent]
            name = prefixes[parent] + own_name
            self.roots.append(root)
            self.names.append(name)
            prefixes.append(name + SEPARATOR)
            if kind in FRAME_KINDS:
                self._frames[root].setdefault(name, index)

    def frame(self, scope: int, reference: str) -> int | None:
        """
        Find the frame that a reference means.

        :param scope: index of the model, world or root in which it is written.
        :param reference: the name as written, not empty.
        :return: index of the frame, or None if there is none of that name.
        """
        if self._elements[scope].kind is Kind.MODEL:
            if reference == MODEL_FRAME:
                return scope
            name = scoped_name(self.names[scope], reference)
        else:
            if reference == WORLD_FRAME and self._elements[scope].kind is Kind.WORLD:
                return scope
            name = reference
        frames = self._frames[self.roots[scope]]
        found = frames.get(name)
        if found is None and name.endswith(_OWN_FRAME):
            found = frames.get(name[:-len(_OWN_FRAME)])
            if found is not None and self._elements[found].kind is not Kind.MODEL:
                return None
        return found

    def missing_uri(self, scope: int, reference: str) -> str:
        """
        Tell whether a reference means something that could not be included.

        :param scope: index of the model, world or root in which it is written.
        :param reference: the name as written.
        :return: the URI of the include; empty if it is none of those.
        """
        if not self._missing:
            return ''
        steps = reference.split(SEPARATOR)
        for count in range(len(steps)):
            outer = self.frame(scope, SEPARATOR.join(steps[:count])) if count else scope
            names = self._missing.get(NOWHERE if outer is None else outer, {})
            uri = names.get(steps[count]) or names.get('')
            if uri:
                return uri
        return ''

    def described(self, scope: int) -> str:
        """
        Name a scope for a sentence.

        :param scope: index of a model, world or root.
        :return: such as ``model "robot::arm"``.
        """
        element = self._elements[scope]
        if element.kind is Kind.ROOT:
            return 'the top of the file'
        name = element.name if element.kind is Kind.WORLD else self.names[scope]
        return f'{element.kind.label} "{name}"'

    def hint(self, scope: int, reference: str) -> str:
        """
        Return the end of a sentence about a reference that means nothing.

        :param scope: index of the model, world or root in which it is written.
        :param reference: the name as written.
        :return: the reason or the nearest name there is, or an empty string.
        """
        own = self._elements[scope]
        first = reference.split(SEPARATOR)[0]
        if own.kind is Kind.MODEL:
            if first == own.name:
                rest = reference[len(first) + len(SEPARATOR):]
                return (f'; inside a model its own name is not visible, write '
                        f'"{rest or MODEL_FRAME}"')
            outer = own.parent
            while outer >= 0:
                if self.frame(outer, reference) is not None:
                    return (f'; {self.described(outer)} has a frame of that name, but names of '
                            'enclosing scopes cannot be used')
                outer = self._elements[outer].parent
        return hint_from_names(reference, self._visible_names(scope))

    def _visible_names(self, scope: int) -> Iterator[str]:
        is_model = self._elements[scope].kind is Kind.MODEL
        prefix = self.names[scope] + SEPARATOR if is_model else ''
        yield MODEL_FRAME if is_model else WORLD_FRAME
        count = 0
        for name in self._frames[self.roots[scope]]:
            if name.startswith(prefix):
                yield name[len(prefix):]
                count += 1
                if count == _MOST_NAMES_COMPARED:
                    return
