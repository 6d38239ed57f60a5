# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Write large files that are as dense as those that people write.

In files of Gazebo's users about 300 bytes and seven elements come with each element that has a
pose. A unit here is a link with a mass, a visual and two written poses, of about 700 bytes.
"""

from __future__ import annotations

from collections.abc import Iterable
import random

LINKS_IN_MODEL = 10
DEPTH = 20


def wide_world(units: int) -> str:
    """
    Write a world of many models, each with ten links, five joints and a frame.

    :param units: how many links; about 2.2 poses are written for each.
    :return: SDFormat text.
    """
    numbers = random.Random(units)
    models = (_model(f'model_{first}', first, numbers)
              for first in range(0, units, LINKS_IN_MODEL))
    return _file('world', 'wide', models)


def nested_world(units: int) -> str:
    """
    Write a world of models that are nested twenty deep, each with a link.

    :param units: how many links; three poses are written for each.
    :return: SDFormat text.
    """
    numbers = random.Random(units)
    stacks = []
    for first in range(0, units, DEPTH):
        models = ''.join(
            f'<model name="model_{number}">\n<pose>{_pose(numbers)}</pose>\n'
            f'{_link(number, numbers)}' for number in range(first, first + DEPTH))
        stacks.append(models + '</model>\n' * DEPTH)
    return _file('world', 'nested', stacks)


def chain(units: int) -> str:
    """
    Write a model in which each link is placed in the one before.

    :param units: how many links; two poses are written for each.
    :return: SDFormat text.
    """
    numbers = random.Random(units)
    links = ''.join(
        _link(number, numbers, f' relative_to="link_{number - 1}"' if number else '')
        for number in range(units))
    return _file('model', 'chain', [links])


def including_world(files: Iterable[str]) -> str:
    """
    Write a world that includes files of models.

    :param files: their paths.
    :return: SDFormat text.
    """
    includes = (
        f'<include>\n<name>included_{number}</name>\n<uri>{file}</uri>\n'
        f'<pose>{number} 0 0 0 0 0.5</pose>\n</include>\n' for number, file in enumerate(files))
    return _file('world', 'including', includes)


def model_file(name: str, units: int) -> str:
    """
    Write a file with one model, such as worlds include.

    :param name: the name of the model.
    :param units: how many links it has.
    :return: SDFormat text.
    """
    numbers = random.Random(name)
    nested = ''.join(
        _model(f'model_{first}', first, numbers) for first in range(0, units, LINKS_IN_MODEL))
    return _file('model', name, [nested])


def old_world(units: int) -> str:
    """
    Write a wide world in version 1.4, in which axes turn with the model.

    :param units: how many links.
    :return: SDFormat text.
    """
    return wide_world(units).replace('<sdf version="1.10">', '<sdf version="1.4">')


def _file(tag: str, name: str, parts: Iterable[str]) -> str:
    return (f'<?xml version="1.0"?>\n<sdf version="1.10">\n<{tag} name="{name}">\n'
            + ''.join(parts) + f'</{tag}>\n</sdf>\n')


def _model(name: str, first: int, numbers: random.Random) -> str:
    parts = [f'<model name="{name}">\n  <pose>{_pose(numbers)}</pose>\n']
    for number in range(first, first + LINKS_IN_MODEL):
        parts.append(_link(number, numbers))
        if number % 2:
            parts.append(_joint(number, numbers))
    parts.append(
        f'  <frame name="tool" attached_to="link_{first + LINKS_IN_MODEL - 1}">\n'
        f'    <pose>{_pose(numbers)}</pose>\n  </frame>\n</model>\n')
    return ''.join(parts)


def _link(number: int, numbers: random.Random, attribute: str = '') -> str:
    mass = numbers.uniform(0.1, 20.0)
    size = ' '.join(f'{numbers.randint(1, 400) / 200:g}' for _ in range(3))
    grey = numbers.randint(1, 9) / 10
    return f"""\
  <link name="link_{number}">
    <pose{attribute}>{_pose(numbers)}</pose>
    <inertial>
      <mass>{mass:.3f}</mass>
      <inertia>
        <ixx>{mass / 10:.5f}</ixx>
        <iyy>{mass / 10:.5f}</iyy>
        <izz>{mass / 8:.5f}</izz>
      </inertia>
    </inertial>
    <visual name="visual_{number}">
      <pose>{_pose(numbers)}</pose>
      <geometry>
        <box>
          <size>{size}</size>
        </box>
      </geometry>
      <material>
        <diffuse>{grey} {grey} {grey} 1</diffuse>
      </material>
    </visual>
  </link>
"""


def _joint(number: int, numbers: random.Random) -> str:
    limit = numbers.uniform(1.0, 3.0)
    return f"""\
  <joint name="joint_{number}" type="revolute">
    <parent>link_{number - 1}</parent>
    <child>link_{number}</child>
    <axis>
      <xyz>0 0 1</xyz>
      <limit>
        <lower>{-limit:.4f}</lower>
        <upper>{limit:.4f}</upper>
      </limit>
    </axis>
  </joint>
"""


def _pose(numbers: random.Random) -> str:
    x, y, z = (numbers.uniform(-5.0, 5.0) for _ in range(3))
    if numbers.random() < 0.5:
        return f'{x:.3f} {y:.3f} {z:.2f} 0 0 {numbers.uniform(-3.14, 3.14):.4f}'
    roll, pitch, yaw = (numbers.uniform(-1.5, 1.5) for _ in range(3))
    return f'{x:.4f} {y:.4f} {z:.4f} {roll:.5f} {pitch:.5f} {yaw:.5f}'
