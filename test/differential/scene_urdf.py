# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Draw robots in URDF, which libsdformat converts."""

from __future__ import annotations

from xml.etree import ElementTree

from differential.scene_text import (
    LENGTHS,
    new_name,
    new_pose,
    number_from,
    sub_element,
    text_from_number,
    TURNS,
)

Element = ElementTree.Element

JOINT_TYPES = ('fixed', 'fixed', 'fixed', 'revolute', 'continuous', 'prismatic')
MOVED = ('sensor', 'sensor', 'light', 'projector')
SHAPES = {'box': {'size': '1 2 3'}, 'sphere': {'radius': '1'}, 'mesh': {'filename': 'm.dae'},
          'cylinder': {'radius': '1', 'length': '2'}}
NUMBERED = {
    'origin': ('xyz', 'rpy'), 'axis': ('xyz',), 'limit': ('lower', 'upper', 'effort', 'velocity'),
    'mass': ('value',), 'inertia': ('ixx', 'ixy'), 'box': ('size',), 'sphere': ('radius',),
    'cylinder': ('radius', 'length')}
# No tabs: XML makes blanks of them, but libsdformat keeps them, and they separate nothing there.
ODD_NUMBERS = (
    '', ' ', '1,0', '0x10', '1e', 'nan', 'inf', '1.5abc', '1e999', '1e-400', '1 2', '1 2 3 4',
    '1 2 x', '1,2,3', '1 2 nan', ' 1  2 3 ', '1.2.3 4 5', '1 2 3abc', '+1', '.5', '5.', '\u0661')


class RobotBuilder:
    """Draws one robot."""

    def __init__(self, dice):
        self.dice = dice
        self.root = Element('robot')

    def robot(self, taken, names):
        """
        Draw a robot.

        :param taken: names that it must not have; its own is added.
        :param names: names that its links and joints must not have; theirs are added.
        :return: the element, its name, and the frames and links that can be named in the model
            that it becomes, if its fixed joints keep them.
        """
        self.root.set('name', self.name(taken))
        links = [self.name(names) for _ in range(self.dice.randint(1, 6))]
        if self.dice.random() < 0.2 and 'world' not in names:
            links = ['world', *links]
        for number, link in enumerate(links):
            is_lumped = False
            if number:
                parent = self.dice.choice(links[:number])
                is_lumped = self.joint(self.name(names), parent, link)
            self.link(link, is_massless=link == 'world' or (
                is_lumped and self.dice.random() < 0.3))
        links = [link for link in links if link != 'world']
        self.extensions(links, names)
        if self.dice.random() < 0.15:
            self.write_odd_number()
        return self.root, self.root.get('name', ''), ['__model__', *links], links

    def write_odd_number(self):
        """Replace one number by what may be none."""
        robot_origin = self.root.find('origin')  # an overflow there ends libsdformat
        places = [(element, name) for element in self.root.iter() for name in element.attrib
                  if element.tag in NUMBERED and name in NUMBERED[element.tag]
                  and element is not robot_origin]
        if places:
            element, name = self.dice.choice(places)
            element.set(name, self.dice.choice(ODD_NUMBERS))

    def name(self, taken):
        """Draw a name on which libsdformat does not crash."""
        return next(name for name in iter(lambda: new_name(self.dice, taken), '')
                    if not set(name) & set('"\'&<'))

    def numbers(self, often, limit, count=3):
        """Draw numbers as they are written."""
        return self.dice.choice((' ', ' ', '  ')).join(
            text_from_number(self.dice, number_from(self.dice, often, limit))
            for _ in range(count))

    def origin(self, parent):
        """Add an origin, whole, in part or none."""
        choice = self.dice.randrange(8)
        if choice:
            origin = sub_element(parent, 'origin')
            if choice > 1:
                origin.set('xyz', self.numbers(LENGTHS, 10))
            if choice != 2:
                origin.set('rpy', self.numbers(TURNS, 7))

    def joint(self, name, parent, child):
        """Add a joint; return whether it may lump its child into its parent."""
        kind = self.dice.choice(JOINT_TYPES)
        joint = sub_element(self.root, 'joint', name=name, type=kind)
        self.origin(joint)
        sub_element(joint, 'parent', link=parent)
        sub_element(joint, 'child', link=child)
        if kind != 'fixed' and self.dice.random() < 0.7:
            axis = self.dice.choice(('0 0 1', '0 -2 0', '1 1 0'))
            sub_element(joint, 'axis', xyz=axis)
        if kind in ('revolute', 'prismatic'):
            sub_element(joint, 'limit', lower='-1', upper='1', effort='1', velocity='1')
        for option in ('preserveFixedJoint', 'disableFixedJointLumping'):
            if self.dice.random() < 0.1:
                gazebo = sub_element(self.root, 'gazebo', reference=name)
                sub_element(gazebo, option, self.dice.choice(('true', 'YES', '1', 'false', 'no')))
        return kind == 'fixed'

    def link(self, name, *, is_massless):
        """Add a link."""
        link = sub_element(self.root, 'link', name=name)
        if not is_massless:
            inertial = sub_element(link, 'inertial')
            self.origin(inertial)
            mass = str(self.dice.choice((0.1, 1, 2.5, 10)))
            sub_element(inertial, 'mass', value=mass)
            sub_element(
                inertial, 'inertia', ixx='1', iyy='1', izz='1', ixy='0', ixz='0', iyz='0')
        for kind in self.dice.choices(('visual', 'collision'), k=self.dice.randrange(4)):
            element = sub_element(link, kind)
            if self.dice.random() < 0.4:
                element.set('name', self.dice.choice(('v', 'größe', name, f'{name} 2', '')))
            self.origin(element)
            tag = self.dice.choice(sorted(SHAPES))
            sub_element(sub_element(element, 'geometry'), tag, **SHAPES[tag])

    def extensions(self, references, names):
        """Add what is SDFormat in a URDF file."""
        for number in range(self.dice.randrange(5)):
            kind = self.dice.choice(MOVED)
            gazebo = sub_element(
                self.root, 'gazebo', reference=self.dice.choice(references))
            sub_element(gazebo, 'mu1', '0.2')
            element = sub_element(gazebo, kind, name=f'{kind}_{number}')
            if kind == 'projector':
                sub_element(element, 'texture', 't.png')
            else:
                element.set('type', {'sensor': 'imu', 'light': 'point'}[kind])
            reference = self.dice.choice(references) if self.dice.random() < 0.2 else ''
            pose = new_pose(self.dice, reference)
            if pose is not None and not (pose.text or '').strip():
                pose.text = None if len(pose) else '0 0 0 0 0 0'
            if pose is not None:
                element.append(pose)
        if self.dice.random() < 0.2:
            self.extra_joint(references, names)
        if self.dice.random() < 0.2:
            gazebo = sub_element(self.root, 'gazebo')
            sub_element(
                gazebo, 'frame', name=self.name(names),
                attached_to=self.dice.choice(references))
        if self.dice.random() < 0.2:
            gazebo = sub_element(self.root, 'gazebo')
            sub_element(gazebo, 'static', self.dice.choice(('true', 'no')))
        if self.dice.random() < 0.2:
            self.origin(self.root)
        if self.dice.random() < 0.1:
            gazebo = sub_element(self.root, 'gazebo')
            sub_element(gazebo, 'pose', self.numbers(LENGTHS, 5, 6))

    def extra_joint(self, links, names):
        """Add a joint of SDFormat, which may name links that are lumped."""
        parent, child = self.dice.choices(links, k=2)
        gazebo = sub_element(self.root, 'gazebo')
        joint = sub_element(
            gazebo, 'joint', name=self.name(names), type='ball')
        sub_element(joint, 'parent', parent)
        sub_element(joint, 'child', child)
        if self.dice.random() < 0.5:
            sub_element(joint, 'pose', self.numbers(LENGTHS, 5, 6))
