# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What commands read, growing: rows of a table, each with how often it repeats its part."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from sdf_texts import LINK, model_file, world_file

from growth.families import DEEP, each, model, nested, REPEATED


class Run(NamedTuple):
    """What a command is given."""

    arguments: Sequence[str]
    files: Mapping[str, str]
    stdin: str = ''


def of(text, *arguments, new=''):
    """Return a function that repeats a part of the text of a file, or of arguments, n times."""
    def run(n):
        texts = [each(n, part) if '|' in part or '#' in part else part
                 for part in (text, new, *arguments)]
        scene, other = (part if part.startswith('<sdf') else model(part) for part in texts[:2])
        return Run(('scene.sdf', *texts[2:]), {'scene.sdf': scene, 'new.sdf': other})
    return run


def plugin(text):
    """Return a model with a plugin for odometry."""
    return model_file(
        f'{LINK}<plugin name="gz::sim::systems::OdometryPublisher" filename="f">{text}</plugin>')


LINKS = REPEATED['links with poses']
MOVED = LINKS.replace('1 2 3', '1 2 4')
CONVERT = '--from', 'sdf_rpy'
POSE = '1 2 3 0 0 0'.split()
SET = ('p0', *POSE, '--dry-run')
JOINTS = REPEATED['joints'].replace('<axis/>', '<axis><xyz>0 0 1</xyz></axis>')
BALLS = REPEATED['joints'].replace('revolute', 'ball')
MESHES = ('<link name="l">|<visual name="v#"><geometry><mesh><uri>none#.stl</uri></mesh>'
          '</geometry></visual>|</link>')
MODELS = (f'|<model name="m#">{LINK}<plugin name="gz::sim::systems::PosePublisher" filename="f"/>'
          '</model>|')

ROWS: dict[str, dict[str, tuple[int, Callable[[int], Run]]]] = {
    'check': {
        'missing meshes': (600, of(MESHES)),
        'folders of includes': (300, lambda n: Run(
            ('scene.sdf', *['-I', '.'] * n),
            {'scene.sdf': model('<include><uri>model://none</uri></include>')})),
    },
    'poses': {
        'positions of joints': (400, lambda n: Run(
            ('scene.sdf', *(f'--joint=j{i}=0.1' for i in range(n))),
            {'scene.sdf': model(each(n, JOINTS))})),
    },
    'tree': {
        'models in one another': (2000, lambda n: Run(('scene.sdf',), {
            'scene.sdf': model(nested(n, DEEP, each(n, '<link name="d#"/>')))})),
        'stars of a pattern': (2000, of(f'<link name="{"a" * 2000}"/>', '--match', '|*a|b')),
    },
    'graph': {'joints': (600, of(JOINTS))},
    'view': {'links': (200, of(LINKS, '-o', 'page.html'))},
    'urdf': {
        'joints': (400, of(JOINTS)),
        'joints of several axes': (400, of(BALLS)),
    },
    'gz_bridge': {
        'plugins': (2500, of(plugin('').replace('<plugin', '|<plugin').replace(
            '</plugin>', '<odom_topic>t#</odom_topic></plugin>|'))),
        'a long topic': (60_000, of(plugin('<odom_topic>|a|</odom_topic>'))),
        'steps of a topic': (10_000, of(plugin('<odom_topic>|a/../|b</odom_topic>'))),
        'models': (400, of(world_file(MODELS))),
    },
    'convert': {
        'factors': (300, lambda n: Run(
            (*CONVERT, *POSE, *['--times', *POSE, '--times-inverse', *POSE] * n), {})),
        'lines': (5000, lambda n: Run(CONVERT, {}, '1 2 3 0.1 0.2 0.3\n' * n)),
        'numbers of a list': (10_000, lambda n: Run(CONVERT, {}, 'x:\n' + '- 0.1\n' * n)),
        'an open bracket': (20_000, lambda n: Run(CONVERT, {}, 'x: [\n' + '0.1,\n' * n)),
        'attributes': (5000, lambda n: Run(
            CONVERT, {}, '<pose ' + 'a="1" ' * n + '>1 2 3 0 0 0</pose>')),
        'poses': (1000, lambda n: Run(
            CONVERT, {}, 'a:\n' + '- {x: 1, y: 2, z: 3, rpy: [0, 0, 0]}\n' * n)),
    },
    'diff': {
        'moved links': (600, of(LINKS, 'new.sdf', new=MOVED)),
        'other links': (600, of(LINKS, 'new.sdf', new=LINKS.replace('p#', 'q#'))),
    },
    'set': {
        'links': (800, of(LINKS, *SET)),
        'white space in a pose': (10_000, of(
            '<link name="p0"><pose>1 2 3|          |0 0 0</pose></link>', *SET)),
        'comments in a pose': (4000, of(
            '<link name="p0"><pose>1 2 3 0 0 0|<!-- -->|</pose></link>', *SET)),
        'a long line': (4000, of('<link name="p0"><pose>1 2 4 0 0 0</pose></link>|<a/>|', *SET)),
    },
}
"""The rows of each command."""


def plain(command, n):
    """Return a run of a command with n links that have poses, or with n lines."""
    of_command = {
        'convert': lambda _: Run(CONVERT, {}, '1 2 3 0.1 0.2 0.3\n' * n), 'set': of(LINKS, *SET),
        'diff': of(LINKS, 'new.sdf', new=MOVED), 'view': of(LINKS, '-o', 'page.html')}
    return of_command.get(command, of(LINKS))(n)
