# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Random scenes for property tests, with poses calculated independently of the package.

An item refers only to items that were made before it, so there are no cycles. The order in the
file is another one. Every model names its canonical link, so the order changes nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.sax.saxutils import quoteattr

from matrices import matrix_from_degrees
import numpy as np
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import strategies as st

LENGTHS = st.integers(-40, 40).map(lambda value: value / 8)
ANGLES = st.integers(-24, 24).map(lambda value: value * 15)
POSES = st.one_of(st.none(), st.tuples(*[LENGTHS] * 3, *[ANGLES] * 3))
STEMS = ['part', 'a b', 'größe', 'x/y', 'world', 'n', '__v']
IN_MODELS = ['link', 'link', 'frame', 'frame', 'joint', 'joint', 'model', 'visual', 'sensor']
IN_WORLDS = ['model', 'model', 'frame', 'joint', 'light']
FRAMES = {'model', 'link', 'frame', 'joint'}


@dataclass(eq=False)
class Item:
    """One element; the root, of a world or of a model file, is an item without a kind."""

    kind: str
    name: str
    parent: Item | None
    """The item whose XML element contains that of this one."""
    scope: Item | None
    pose: tuple[float, ...] | None = None
    """x y z roll pitch yaw in metres and degrees, or x y z and a quaternion x y z w."""
    reference: Item | None = None
    attached_to: Item | None = None
    joint_parent: Item | None = None
    joint_child: Item | None = None
    placement: Item | None = None
    is_static: bool = False
    children: list[Item] = field(default_factory=list)

    @property
    def scoped_name(self):
        return '::'.join(item.name for item in reversed(self.chain()[:-1]))

    def chain(self):
        """Return the item, its parent, and so on; the root is the last."""
        return [self, *(self.parent.chain() if self.parent else [])]

    def text_in(self, scope):
        """Return a reference to this item in a scope."""
        if self is scope:
            return '__model__' if scope.kind else 'world'
        names = [item.name for item in self.chain()]
        return '::'.join(reversed(names[:self.chain().index(scope)]))

    def default_reference(self):
        return self.joint_child or self.attached_to or self.parent

    def body(self):
        """Return the link, static model or root that a frame is attached to."""
        if self.kind == 'model' and not self.is_static:
            return self.children[0]
        attached_to = self.joint_child or self.attached_to
        if self.kind == 'frame':
            attached_to = attached_to or self.scope
        return attached_to.body() if attached_to else self


class RandomScene:
    """Items, their text and their poses."""

    def __init__(self, root, items, *, is_world):
        self.root = root
        self.items = items
        self.is_world = is_world

    @property
    def models(self):
        return [item for item in self.items if item.kind == 'model']

    def text(self, order=None, *, wrapped_at=None):
        """
        Return the scene as SDFormat.

        :param order: key by which siblings are sorted; None for the order in which they were made.
        :param wrapped_at: for a model file, the pose of a frame in a world, to which the pose of
            the model becomes relative; None to leave it a model file.
        """
        content = ''.join(_xml(child, order) for child in _sorted(self.root.children, order))
        if wrapped_at is not None:
            content = f'<world name="w"><frame name="place">{_pose(wrapped_at)}</frame>' + \
                content.replace('<pose', '<pose relative_to="place"', 1) + '</world>'
        elif self.is_world:
            content = f'<world name="w">{content}</world>'
        return f'<sdf version="1.10">{content}</sdf>'

    def matrices(self):
        """Return the pose of every item in the root, by its scoped name."""
        return {item.scoped_name: in_frame(item, self.root) for item in self.items}


def in_frame(item, frame):
    """Multiply from an item up to a frame that its pose leads to."""
    matrix = np.eye(4)
    while item is not frame:
        edge = matrix_from_degrees(*item.pose) if item.pose else np.eye(4)
        if item.placement:
            edge = edge @ np.linalg.inv(in_frame(item.placement, item))
        matrix = edge @ matrix
        item = item.reference or item.default_reference()
    return matrix


def _sorted(items, order):
    return sorted(items, key=order) if order else items


def _pose(values, relative_to=''):
    reference = f' relative_to={quoteattr(relative_to)}' if relative_to else ''
    form = 'rotation_format="quat_xyzw"' if values and len(values) == 7 else 'degrees="true"'
    return f'<pose{reference} {form}>{" ".join(map(repr, values or ()))}</pose>'


def _xml(item, order):
    attributes = f' name={quoteattr(item.name)}'
    content = ''
    reference = item.reference.text_in(item.scope) if item.reference else ''
    if item.attached_to:
        attributes += f' attached_to={quoteattr(item.attached_to.text_in(item.scope))}'
    if item.kind in ('joint', 'sensor', 'light'):
        kinds = {'joint': 'revolute', 'sensor': 'camera', 'light': 'point'}
        attributes += f' type="{kinds[item.kind]}"'
    if item.kind == 'joint':
        content += f'<parent>{item.joint_parent.text_in(item.scope)}</parent>'
        content += f'<child>{item.joint_child.text_in(item.scope)}</child>'
    if item.kind == 'model':
        attributes += f' canonical_link={quoteattr(item.children[0].name)}'
        if item.placement:
            attributes += f' placement_frame={quoteattr(item.placement.text_in(item))}'
        content += f'<static>{"true" if item.is_static else "false"}</static>'
    content += _pose(item.pose, reference)
    content += ''.join(_xml(child, order) for child in _sorted(item.children, order))
    return f'<{item.kind}{attributes}>{content}</{item.kind}>'


@st.composite
def random_scenes(draw, *, is_world=None, most=14):
    """Draw a world, or a model file."""
    is_world = draw(st.booleans()) if is_world is None else is_world
    root = Item('', '', None, None)
    items = []

    def add(kind, parent, scope, **fields):
        name = draw(st.sampled_from(STEMS)) + str(len(items))
        item = Item(kind, name, parent, scope, draw(POSES), **fields)
        parent.children.append(item)
        items.append(item)
        return item

    def add_model(scope, reference):
        model = add('model', scope, scope, reference=reference)
        model.is_static = draw(st.sampled_from([False, False, False, True]))
        add('link', model, model)

    def one_of(candidates):
        return draw(st.sampled_from(candidates)) if candidates else None

    add_model(root, None)
    for _ in range(draw(st.integers(0, most))):
        scopes = [item for item in items if item.kind == 'model']
        scope = one_of([*scopes, *([root] if is_world else [])])
        kind = one_of(IN_MODELS if scope.kind else IN_WORLDS)
        visible = [
            item for item in items
            if item.kind in FRAMES and item is not scope and scope in item.chain()]
        reference = one_of([None, scope, *visible])
        if kind == 'model':
            add_model(scope, reference)
        elif kind == 'frame':
            attached_to = one_of([None, *visible, *([scope] if scope.kind or is_world else [])])
            add('frame', scope, scope, reference=reference, attached_to=attached_to)
        elif kind == 'joint':
            child = one_of([item for item in visible if item.body() is not root])
            parent = one_of([
                item for item in visible if child and item.body() is not child.body()])
            if parent and child:
                add('joint', scope, scope, reference=reference, joint_parent=parent,
                    joint_child=child)
        elif kind in ('visual', 'sensor'):
            link = one_of([child for child in scope.children if child.kind == 'link'])
            add(kind, link, scope, reference=reference)
        else:
            add(kind, scope, scope, reference=reference)
    for item in items:
        if item.kind == 'model':
            inside = [
                other for other in items
                if other.kind in FRAMES and other is not item and item in other.chain()]
            item.placement = one_of([None, None, None, *inside])
    return RandomScene(root, items, is_world=is_world)
