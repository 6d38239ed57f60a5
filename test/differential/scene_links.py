# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Draws what hangs on links and joints: visuals, sensors, axes, and what must not matter."""

from __future__ import annotations

from xml.etree import ElementTree

from differential.scene_text import NAMES, new_pose, sub_element

Element = ElementTree.Element

AXES = {
    'fixed': 0, 'ball': 0, 'revolute': 1, 'continuous': 1, 'prismatic': 1, 'screw': 1,
    'revolute2': 2, 'universal': 2, 'gearbox': 2,
}
"""Types of joints with the number of their axes."""

AXIS_PARTS = (
    (), (), (), ('<limit><lower>-1.5</lower><upper>2</upper></limit>',), ('<limit/>',),
    ('<limit><effort/><upper>-inf</upper></limit>',), ('<limit><lower>1e-3</lower></limit>',),
    ('<limit><lower> 0x10 </lower><upper>1.5rad</upper></limit>',),
    ('<limit><upper>inf</upper></limit>', '<dynamics><damping>1</damping></dynamics>'),
)
"""What axes have besides a vector."""

MIMIC_NUMBERS = (None, None, '0', '2.5', '-1e-3', '1.5rad')
PITCHES = (
    (), ('<thread_pitch>-2.5</thread_pitch>',), ('<screw_thread_pitch>0.5</screw_thread_pitch>',),
    ('<thread_pitch/>',), ('<screw_thread_pitch/>', '<thread_pitch>3</thread_pitch>'),
    ('<thread_pitch>3</thread_pitch>', '<screw_thread_pitch>-1e-3</screw_thread_pitch>'),
)

SENSORS = ('imu', 'contact', 'magnetometer', 'altimeter', 'air_pressure', 'force_torque',
           'navsat', 'logical_camera', 'camera', 'gpu_lidar')
LINK_CHILDREN = ('visual', 'visual', 'collision', 'sensor', 'light', 'particle_emitter')
SHAPES = {
    'box': {'size': 3}, 'capsule': {'radius': 1, 'length': 1}, 'cone': {'radius': 1, 'length': 1},
    'cylinder': {'radius': 1, 'length': 1}, 'ellipsoid': {'radii': 3}, 'sphere': {'radius': 1},
}
"""Shapes with a volume: the elements that they must have, and how many numbers these have."""

UNKNOWN_FRAME = 'no such frame'


def joint_body(dice, name, parent, child):
    """Draw a joint with its type and axes, but without its pose."""
    kind = dice.choice(sorted(AXES))
    element = Element('joint', name=name, type=kind)
    sub_element(element, 'parent', parent)
    sub_element(element, 'child', child)
    if kind == 'gearbox':
        sub_element(element, 'gearbox_reference_body', parent)
    for number in range(AXES[kind]):
        axis = sub_element(element, 'axis2' if number else 'axis')
        vector = dice.choice(('0 0 1', '0 1 0', '1 0 0', '-1 0 0', '0.6 0 0.8'))
        sub_element(axis, 'xyz', vector)
        for part in dice.choice(AXIS_PARTS):
            axis.append(ElementTree.fromstring(part))
    if kind == 'screw':
        for part in dice.choice(PITCHES):
            element.append(ElementTree.fromstring(part))
    return element


def fill(dice, element, references):
    """
    Draw the children of a link or joint.

    :param element: the link or joint.
    :param references: names of all frames of its scope.
    """
    if element.tag == 'joint':
        for vector in element.iter('xyz'):
            if dice.randint(0, 2) == 0:
                vector.set('expressed_in', dice.choice(references))
        if dice.randint(0, 5) == 0:
            _posed(dice, element, 'sensor', 'wrench', references).set('type', 'force_torque')
        return
    if dice.randint(0, 3) == 0:
        inertial = sub_element(element, 'inertial')
        pose = new_pose(dice)
        if pose is not None:
            inertial.append(pose)
    kinds = dice.choices(LINK_CHILDREN, k=dice.randint(0, 3))
    for number, kind in enumerate(kinds):
        stem = dice.choice(NAMES)
        name = f'{stem}_{number}' if kind in kinds[:number] else stem
        child = _posed(dice, element, kind, name, references)
        if kind == 'sensor':
            sensor_type = dice.choice(SENSORS)
            child.set('type', sensor_type)
            if sensor_type == 'camera':
                # The optics' own offset is no frame.
                camera = sub_element(child, 'camera')
                sub_element(camera, 'pose', '1 2 3 0 0 0')
        elif kind == 'light':
            child.set('type', 'point')
        elif kind == 'particle_emitter':
            child.set('type', 'box')
        else:
            child.append(_geometry(dice))
    if element.find('inertial') is not None and element.find('collision') is not None:
        _make_inertial_automatic(dice, element)
    if dice.randint(0, 15) == 0:
        _add_foreign(element)


def add_mimics(dice, joints):
    """Let some axes of joints follow others."""
    leaders = [(joint, tag) for joint in joints for tag in ('axis', 'axis2')
               if joint.find(tag) is not None]
    for joint, tag in leaders:
        if dice.randint(0, 7) == 0 and len(leaders) > 1:
            leader, leader_tag = dice.choice(
                [each for each in leaders if each != (joint, tag)])
            mimic = Element('mimic', joint=leader.get('name', ''))
            if leader_tag == 'axis2' or dice.random() < 0.5:
                mimic.set('axis', leader_tag)
            for part in ('multiplier', 'offset', 'reference'):
                text = dice.choice(MIMIC_NUMBERS)
                if text is not None:
                    sub_element(mimic, part, text)
            joint.find(tag).append(mimic)


def _geometry(dice):
    """Draw a shape."""
    geometry = Element('geometry')
    tag = dice.choice(sorted(SHAPES))
    shape = sub_element(geometry, tag)
    for child, count in SHAPES[tag].items():
        sizes = [dice.randint(1, 50) for _ in range(count)]
        sub_element(shape, child, ' '.join(str(size / 10) for size in sizes))
    return geometry


def _make_inertial_automatic(dice, link):
    """Let the collisions of a link give the inertial, most of the time."""
    inertial = link.find('inertial')
    if inertial is None or dice.randint(0, 3) == 0:
        return
    inertial.set('auto', 'true')
    for element in (inertial, *link.iterfind('collision')):
        if dice.random() < 0.5:
            density = dice.choice(('', str(dice.randint(1, 9000))))
            sub_element(element, 'density', density)
    for pose in link.iterfind('collision/pose'):
        # The collision has to be somewhere for its mass to count.
        if pose.get('relative_to', '').strip() == UNKNOWN_FRAME:
            del pose.attrib['relative_to']


def _posed(dice, element, kind, name, references):
    """Add a child whose pose may name any frame, or one that does not exist."""
    child = sub_element(element, kind, name=name)
    reference = ''
    choice = dice.randint(0, 20)
    if choice == 0:
        reference = UNKNOWN_FRAME
    elif choice > 10:
        reference = dice.choice(references)
    pose = new_pose(dice, reference)
    if pose is not None:
        child.append(pose)
    return child


def _add_foreign(element):
    """Add what SDFormat has to pass over unread."""
    plugin = sub_element(element, 'plugin', name='p', filename='libp.so')
    sub_element(plugin, 'pose', 'not a pose', relative_to='nothing')
    vendor = sub_element(element, 'vendor:thing', name='a::b')
    sub_element(vendor, 'pose', '1 2')
    sub_element(element, 'misspelt', 'unknown')
