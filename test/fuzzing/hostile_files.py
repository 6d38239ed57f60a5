# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Files of any elements in any order: includes, merges, parameters of includes, and URDF.

They are drawn from a grammar that knows what may stand where, and breaks that now and then.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

Choose = Callable[[Sequence[str]], str]
"""Returns one of some values; the first one when nothing is left to draw from."""

FILES = ('part.sdf', 'arm.urdf', 'scene.sdf', 'none.sdf')
NAMES = ('a', 'bb', 'cc', 'bb::cc', 'a::bb', '__model__', '__root__', 'world', 'a_frame', '',
         'x' * 90)
NUMBERS = ('1', '0', '-2.5', '1 2 3', '1 2 3 0.1 0.2 0.3', '1 2 3 0 0 0 1', 'nan', '1e999', 'x',
           '')
TYPES = ('revolute', 'fixed', 'ball', 'screw', 'universal', 'camera', 'imu', 'point', 'none')

CHILDREN = {
    'sdf': 'model world include light actor',
    'world': 'model include frame light joint plugin state none',
    'model': ('link model include frame joint pose static plugin gripper link include include'),
    'link': 'visual collision sensor light pose inertial projector none',
    'visual': 'pose geometry plugin', 'collision': 'pose geometry', 'sensor': 'pose camera',
    'joint': 'parent child axis axis2 pose sensor', 'axis': 'xyz mimic limit',
    'axis2': 'xyz mimic', 'inertial': 'pose mass', 'frame': 'pose', 'light': 'pose',
    'actor': 'pose link', 'geometry': 'box mesh', 'box': 'size', 'camera': 'pose',
    'include': 'uri uri uri name pose placement_frame static plugin params params',
    'params': 'link model visual joint frame include sensor pose',
    'robot': 'link joint gazebo joint link', 'gazebo': 'sensor light plugin joint static',
    'plugin': 'pose none',
}
"""What may stand in an element, by tag; what is not a key holds text."""

ATTRIBUTES = {
    'name': NAMES, 'type': TYPES, 'relative_to': NAMES, 'attached_to': NAMES, 'degrees': ('true',),
    'canonical_link': NAMES, 'placement_frame': NAMES, 'merge': ('true', '1', 'x'),
    'element_id': NAMES, 'action': ('add', 'modify', 'remove', 'replace', ''),
    'expressed_in': NAMES, 'joint': NAMES, 'axis': ('axis', 'axis2'), 'link': NAMES,
    'auto': ('true',), 'rotation_format': ('quat_xyzw', 'euler_rpy'), 'frame': NAMES,
    'reference': NAMES, 'xyz': NUMBERS, 'rpy': NUMBERS, 'value': NUMBERS,
}
IN_URDF = {
    'link': 'visual collision inertial', 'joint': 'origin parent child axis limit mimic',
    'visual': 'origin geometry', 'inertial': 'origin mass inertia', 'geometry': 'box sphere'}
USUAL = {
    'model': 'name', 'link': 'name', 'frame': 'name', 'joint': 'name type', 'visual': 'name',
    'collision': 'name', 'sensor': 'name type', 'light': 'name type', 'world': 'name',
    'mimic': 'joint', 'gazebo': 'reference', 'robot': 'name', 'origin': 'xyz rpy',
    'mass': 'value', 'actor': 'name', 'plugin': 'name'}
MOST_ELEMENTS = 60
DEEPEST = 9


class FileWriter:
    """
    Writes one file.

    :param choose: draws.
    :param is_urdf: whether the elements are those of URDF.
    """

    def __init__(self, choose: Choose, *, is_urdf: bool) -> None:
        self._choose = choose
        self._is_urdf = is_urdf
        self._count = 0

    def element(self, tag: str, depth: int = 0, attributes: str = '') -> str:
        """Return an element with all that it holds."""
        self._count += 1
        words = USUAL.get(tag, '').split()
        if self._is_urdf and tag in ('parent', 'child'):
            words = ['link']
        if self._choose(('', 'more')):
            words.append(self._choose(tuple(ATTRIBUTES)))
        for word in dict.fromkeys(words):
            attributes += f' {word}="{self._choose(ATTRIBUTES[word])}"'
        written = 'experimental:params' if tag == 'params' else tag
        return f'<{written}{attributes}>{self._content(tag, depth)}</{written}>'

    def _content(self, tag: str, depth: int) -> str:
        if tag == 'uri':
            return self._choose(FILES)
        children = (IN_URDF if self._is_urdf else {}).get(tag) or CHILDREN.get(tag)
        if children is None:
            return self._choose((*NUMBERS, *NAMES))
        parts = []
        while self._count < MOST_ELEMENTS and depth < DEEPEST and self._choose(('', 'more')):
            parts.append(self.element(self._choose(tuple(children.split())), depth + 1))
        return ''.join(parts)


def files_from_choices(choose: Choose) -> dict[str, str]:
    """Return the texts of a scene and of what it may include, by their paths."""
    version = ' version="{}"'
    return {
        **{path: FileWriter(choose, is_urdf=False).element('sdf', attributes=version.format(
            choose(('1.9', '1.6', '1.4', '1.11', '1.2')))) for path in ('scene.sdf', 'part.sdf')},
        'arm.urdf': FileWriter(choose, is_urdf=True).element('robot'),
    }
