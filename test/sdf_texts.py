# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Short SDF texts for tests, and what is wrong with them."""

from matrices import assert_close
import pytest

from sdf_pose_bridge import load, load_text, SdfError
from sdf_pose_bridge.sdformat.grammar import Kind

TYPES = {'joint': 'fixed', 'sensor': 'camera', 'light': 'point', 'particle_emitter': 'point'}
LINK = '<link name="l"/>'
LINK_CHILDREN = ('visual', 'collision', 'sensor', 'light', 'particle_emitter', 'projector')
KINDS_IN_MODELS = [kind for kind in Kind if 'model' in kind.parents]
JOINTS = '<plugin filename="gz-sim-joint-state-publisher-system" name=""/>'
TWO_LINKS = '<link name="a"/><link name="b"/>'


def model_file(content, *, attributes='', version='1.9'):
    """Put content into the one model, ``m``, of a model file."""
    return f'<sdf version="{version}"><model name="m" {attributes}>{content}</model></sdf>'


def world_file(content, *, version='1.10'):
    """Put content into the one world, ``w``, of a file."""
    return f'<sdf version="{version}"><world name="w">{content}</world></sdf>'


INCLUDES_LEAF = world_file('<include><uri>leaf.sdf</uri></include>')


def link_with(content):
    """Put content into the one link, ``l``, of a model file."""
    return model_file(f'<link name="l">{content}</link>')


def joint(content, name='j', joint_type='fixed'):
    return f'<joint name="{name}" type="{joint_type}">{content}</joint>'


def model(name, content):
    """Return a model with the link ``l``, for a world."""
    return f'<model name="{name}">{LINK}{content}</model>'


def plugin(system, parameters=''):
    """Return a plugin of Gazebo."""
    return f'<plugin filename="f" name="gz::sim::systems::{system}">{parameters}</plugin>'


def fixed_joint(name, parent, child, pose=''):
    return joint(f'<parent>{parent}</parent><child>{child}</child>{pose}', name)


def element(tag, name, content=''):
    """Return an element, with the type that some must have."""
    attribute = f' type="{TYPES[tag]}"' if tag in TYPES else ''
    return f'<{tag} name="{name}"{attribute}>{content}</{tag}>'


def posed(tag, name, pose, relative_to=''):
    """Return an element with a pose."""
    reference = f' relative_to="{relative_to}"' if relative_to else ''
    return element(tag, name, f'<pose{reference}>{pose}</pose>')


def part_of_model(kind, name, relative_to=''):
    """Return an element of a kind that a model with the links ``a`` and ``b`` may contain."""
    content = {'model': LINK, 'joint': '<parent>a</parent><child>b</child>'}.get(kind.label, '')
    return posed(kind.label, name, '0 1 0 0 0 2', relative_to).replace(
        '</pose>', '</pose>' + content)


def write_files(folder, **texts):
    """Write a file ``NAME.sdf`` for each text."""
    for name, text in texts.items():
        (folder / f'{name}.sdf').write_text(text)


def errors_of(text):
    """Load a text that must be refused; return all its errors."""
    with pytest.raises(SdfError) as caught:
        load_text(text, 'file.sdf')
    return caught.value.errors


def errors_of_file(path, **options):
    """Load a file that must be refused; return all its errors."""
    with pytest.raises(SdfError) as caught:
        load(path, **options)
    return caught.value.errors


def scene_from_files(folder, **texts):
    """Write files, and load ``main.sdf``."""
    write_files(folder, **texts)
    return load(folder / 'main.sdf')


def errors_of_files(folder, **texts):
    """Write files, and load ``main.sdf``, which must be refused; return all its errors."""
    write_files(folder, **texts)
    return errors_of_file(folder / 'main.sdf')


def codes_of(text):
    return [error.code for error in errors_of(text)]


def only_error(text):
    errors = errors_of(text)
    assert len(errors) == 1, [str(error) for error in errors]
    return errors[0]


def names_of(scene):
    """Return the names of all elements but worlds and implicit roots."""
    return [
        name for name, parent in zip(scene.names, scene.parents.tolist(), strict=True)
        if parent >= 0]


def warning_codes(scene):
    return [warning.code for warning in scene.warnings]


def assert_at(scene, name, expected):
    """Check the pose of an element: as many of x y z, qx qy qz qw as are given."""
    assert_close(scene.pose(name)[:len(expected)], expected, 1e-12)
