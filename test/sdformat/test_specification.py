# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The definitions of elements refer to others that exist; the table of the types of joints."""

import re

import pytest

from sdf_pose_bridge import Kind
from sdf_pose_bridge.scene.scene import Joint
from sdf_pose_bridge.sdformat.grammar import definition_of, ValueType
from sdf_pose_bridge.sdformat.joints import JointAxis
from sdf_pose_bridge.sdformat.specification import CHOICES, ELEMENTS, JOINT_TYPES, URDF_JOINT_TYPES
from sdf_pose_bridge.tf.joint_motion import dofs_from_joint

CONTENTS = {**ELEMENTS, **{kind.label: kind.content for kind in Kind if kind is not Kind.ROOT}}
"""The content of each element, by its identifier."""


def identifiers_reachable_from(top):
    """Return the identifiers of all definitions that a definition leads to."""
    found, waiting = set(), [top]
    while waiting:
        identifier = waiting.pop()
        if identifier not in found:
            found.add(identifier)
            waiting += [
                child.identifier for child in definition_of(identifier).children.values()
                if has_definition(child)]
    return found


def has_definition(child):
    """Return whether a child element is one with a definition, and not one with a value alone."""
    if child.identifier not in CONTENTS:
        return False
    definition = definition_of(child.identifier)
    return (child.value_type, child.attributes, set(child.children)) == (
        definition.value_type, definition.attributes, set(definition.children))


def parents_of_kind(tag):
    """Return the elements in which a tag is a kind; those need no item for it."""
    return next((kind.parents for kind in Kind if kind.label == tag), ())


@pytest.mark.parametrize('identifier', sorted(CONTENTS))
def test_every_item_of_a_definition_is_read(identifier):
    words = [name for word in CONTENTS[identifier].split()
             for name in re.sub(':.*', '', word).split(',')]
    definition = definition_of(identifier)
    own = [tag for tag in definition.children if identifier not in parents_of_kind(tag)]
    read = [*(f'@{name}' for name in definition.attributes), *own]
    named = [re.match(r'@?\w*', word)[0] for word in words if word[:1] not in '!*/']
    assert sorted(read) == sorted(named)


def test_every_type_exists():
    types = re.findall(r':(\w+)', ' '.join(CONTENTS.values()))
    plain = {each.label for each in ValueType} - {ValueType.CHOICE.label}
    assert set(types) <= plain | set(CHOICES)


def test_every_definition_that_is_referred_to_exists():
    assert set(re.findall(r'=(\S+)', ' '.join(CONTENTS.values()))) <= set(CONTENTS)


@pytest.mark.parametrize('identifier', [name for name in sorted(CONTENTS) if '/' in name])
def test_definition_for_one_parent_is_used_there(identifier):
    parent, tag = identifier.split('/')
    assert definition_of(parent).children[tag].identifier == identifier


def test_every_parent_of_a_kind_exists():
    assert {parent for kind in Kind for parent in kind.parents} <= set(CONTENTS)


def test_every_element_is_reachable():
    assert identifiers_reachable_from('sdf') | identifiers_reachable_from('robot') == set(CONTENTS)


@pytest.mark.parametrize('kind', [kind for kind in Kind if kind.parents and kind != Kind.WORLD])
def test_every_kind_has_a_pose(kind):
    assert definition_of(kind.label).children['pose'].is_pose


X, Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


def dofs_of(joint_type):
    return dofs_from_joint(Joint(0, joint_type, 1, 2, (JointAxis(X), JointAxis(Z)), 0.5))


def test_unknown_type_raises():
    with pytest.raises(KeyError):
        dofs_of('hinge')


@pytest.mark.parametrize('joint_type', JOINT_TYPES)
def test_names_of_the_degrees_of_freedom_of_a_joint_differ(joint_type):
    suffixes = [dof.suffix for dof in dofs_of(joint_type)]
    assert len(set(suffixes)) == len(suffixes)


@pytest.mark.parametrize('joint_type', JOINT_TYPES)
def test_every_degree_of_freedom_moves(joint_type):
    assert all(dof.rad_per_unit or dof.m_per_unit for dof in dofs_of(joint_type))


def test_only_joints_with_a_thread_turn_and_slide_at_once():
    both = {name for name in JOINT_TYPES for dof in dofs_of(name)
            if dof.rad_per_unit and dof.m_per_unit}
    assert both == {'screw'}


def test_types_of_urdf_become_types_of_sdformat():
    assert {each.sdformat for each in URDF_JOINT_TYPES.values()} <= {'', *JOINT_TYPES}
