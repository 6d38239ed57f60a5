# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Random scenes: an SDFormat file, with the files that it includes, valid by design.

What keeps a scene valid is an order: the children of one scope are placed one after the other, and
each may be given only from those placed before it. Where they stand in the document is drawn apart
from that, so most references point forward as often as backward.
"""

from __future__ import annotations

from random import Random
from typing import Any
from xml.etree import ElementTree

from differential.scene_chains import chain_scene
from differential.scene_defects import add_defect
from differential.scene_links import joint_body, LinkBuilder, UNKNOWN_FRAME
from differential.scene_parts import (
    Built,
    Feature,
    first_canonical_body,
    MODEL,
    OWN,
    SCENE,
    SceneFiles,
    Visible,
    WORLD,
)
from differential.scene_setting import with_pose_set
from differential.scene_text import BOOLEANS, new_name, new_pose
from differential.scene_urdf import RobotBuilder, text_from_robot
from differential.scene_values import odd_scene, ODD_VALUES
from differential.scene_xml import with_oddities


class SceneBuilder:
    """Draws one scene; holds what its models share."""

    def __init__(self, dice: Random, features: frozenset[Feature]) -> None:
        self.dice = dice
        self.features = features
        self.files: dict[str, str] = {}
        self.traits: set[str] = set()
        self.last_body = WORLD
        self.links = LinkBuilder(dice, features)

    def new_body(self) -> int:
        """Count one more body."""
        self.last_body += 1
        return self.last_body

    def chance(self, one_in: int) -> bool:
        """Draw whether something happens."""
        return self.dice.randrange(one_in) == 0

    def count(self, most: int) -> int:
        """Draw how many of something there are."""
        return self.dice.randint(0, most)

    def shuffled(self, values: list) -> list:
        """Draw an order."""
        return self.dice.sample(values, len(values))

    def reference(self, visible: list[Visible]) -> str:
        """Draw what a pose is relative to: often the default."""
        if not visible or self.chance(3):
            return ''
        return self.dice.choice(visible).reference

    # Files ----------------------------------------------------------------------------------

    def file_text(self, content: list[ElementTree.Element]) -> str:
        """Write elements as a file, with a version drawn for it."""
        versions = ['1.7', '1.8', '1.9', '1.9', '1.10', '1.11']
        if Feature.OLD_VERSIONS in self.features:
            versions += ['1.2', '1.3', '1.4', '1.5', '1.6', '1.6']
        version = self.dice.choice(versions)
        root = ElementTree.Element('sdf', version=version)
        root.extend(content)
        if version in ('1.5', '1.6') and self.chance(2):
            for pose in root.iter('pose'):
                if 'relative_to' in pose.attrib:
                    pose.set('frame', pose.attrib.pop('relative_to'))
        ElementTree.indent(root)
        text = ElementTree.tostring(root, encoding='unicode', xml_declaration=False)
        if Feature.XML_ODDITIES in self.features and self.chance(6):
            self.traits.add('xml-oddities')
            return with_oddities(self.dice, text)
        return text

    def included_path(self, content: ElementTree.Element) -> str:
        """Write a file, or a folder with a manifest, to be included; return its URI."""
        path = f'part_{len(self.files)}'
        if self.chance(2):
            path += '.sdf'
            self.files[path] = ''  # keeps the number taken while the version is drawn
            self.files[path] = self.file_text([content])
        else:
            self.files[f'{path}/model.config'] = (
                '<model><name>part</name><version>1.0</version>\n'
                '<sdf version="1.2">older.sdf</sdf>\n<sdf version="1.9">part.sdf</sdf>\n'
                '<sdf version="1.7">older.sdf</sdf></model>\n')
            self.files[f'{path}/older.sdf'] = '<sdf version="1.7"><model name="older"/></sdf>'
            self.files[f'{path}/part.sdf'] = self.file_text([content])
        scheme = self.dice.choice(('model://', 'model://', 'file://', ''))
        return f'{scheme}{SCENE}/{path}'

    # Models ---------------------------------------------------------------------------------

    def include(self, taken: set[str], depth: int, *, merge: bool) -> Built:
        """Draw a file and the element that includes it; the pose is added later."""
        element = ElementTree.Element('include')
        uri = ElementTree.SubElement(element, 'uri')
        if Feature.URDF in self.features and self.chance(3):
            built = self.robot(taken, merged=merge)
            path = f'part_{len(self.files)}.urdf'
            self.files[path] = text_from_robot(built.element)
            uri.text = f'model://{SCENE}/{path}'
        else:
            built = self.model(taken, depth + 1, top=True, merged=merge)
            if merge and Feature.MERGED_OVERRIDES in self.features and self.chance(4):
                self.override_placement(element, built)
            uri.text = self.included_path(built.element)
        if merge:
            element.set('merge', self.dice.choice(BOOLEANS[True]))
            self.traits.add('merge')
        elif self.chance(6):
            element.set('merge', self.dice.choice(BOOLEANS[False]))
        if self.chance(2):
            built.name = new_name(self.dice, taken)
            ElementTree.SubElement(element, 'name').text = built.name
        if merge and Feature.MERGED_OVERRIDES in self.features and self.chance(2):
            self.traits.add('merged-override')
            text = self.dice.choice(BOOLEANS[self.chance(2)])
            ElementTree.SubElement(element, 'static').text = text
        if not merge and built.links and self.chance(4):
            # Never from true to false: frames that were apart could then be on one link.
            static = built.static or self.chance(2)
            built.static = static
            text = self.dice.choice(BOOLEANS[static])
            ElementTree.SubElement(element, 'static').text = text
        self.traits.add('include')
        return Built(element, built.name, built.static, built.canonical_body, built.static_body,
                     built.inner, built.links)

    def robot(self, taken: set[str], *, merged: bool = False) -> Built:
        """Draw a robot in URDF; see :meth:`model`."""
        self.traits.add('urdf')
        builder = RobotBuilder(self.dice, self.last_body)
        built = builder.robot(taken, merged=merged)
        self.last_body = builder.last_body
        if builder.is_odd:
            self.traits.add(ODD_VALUES)
        return built

    def place(self, built: Built, available: list[Visible], *, merge: bool = False) -> None:
        """Draw the pose of a nested, included or merged model."""
        element = built.element
        pose = new_pose(self.dice, self.reference(available))
        if pose is None or element.find('placement_frame') is not None:
            return
        element.insert(self.dice.randint(0, len(element)), pose)
        if element.tag == 'include' and self.chance(6 if merge else 3):
            frame = self.dice.choice(built.inner).reference
            ElementTree.SubElement(element, 'placement_frame').text = frame

    def override_placement(self, include: ElementTree.Element, built: Built) -> None:
        """Let an include override a placement frame that does not exist."""
        self.traits.add('merged-override')
        built.element.set('placement_frame', UNKNOWN_FRAME)
        frame = self.dice.choice(built.inner).reference
        ElementTree.SubElement(include, 'placement_frame').text = frame
        ElementTree.SubElement(include, 'pose').text = '1 2 3 0.1 0.2 0.3'

    def model(self, taken: set[str], depth: int, *, top: bool = False,
              merged: bool = False) -> Built:
        """
        Draw a model.

        :param taken: names that it must not have; its own is added.
        :param top: whether it is the top of a file; it gets a pose without ``relative_to`` then,
            and none otherwise.
        :param merged: whether its content goes into the scope whose names are ``taken``.
        """
        dice = self.dice
        static = not merged and self.chance(5)
        names = taken if merged else set()
        name = new_name(dice, taken)

        kinds = ['link'] * self.count(3 if depth < 2 else 2)
        if depth < 3:
            kinds += ['model'] * (self.count(2) if self.chance(depth + 2) else 0)
            if Feature.INCLUDES in self.features and self.chance(12):
                kinds += ['include'] * dice.randint(1, 2)
            if Feature.MERGES in self.features and self.chance(20):
                kinds.append('merge')
        if merged and 'link' not in kinds:
            kinds.append('link')
        units: list[tuple[str, Any]] = []
        visible_bodies: list[Visible] = []
        links: list[Visible] = []
        for kind in self.shuffled(kinds):
            if kind == 'link':
                link = Visible(new_name(dice, names), self.new_body())
                units.append((kind, link))
                visible_bodies.append(link)
                links.append(link)
                continue
            built = (self.model(names, depth + 1) if kind == 'model'
                     else self.include(names, depth, merge=kind == 'merge'))
            units.append((kind, built))
            if kind == 'merge':
                visible_bodies += built.seen_merged()
                links += built.links
            else:
                visible_bodies += built.seen_outside()
                links += [Visible(f'{built.name}::{link}', body) for link, body, _ in built.links]
        canonical = first_canonical_body(units)
        if canonical is None and not static:
            link = Visible(new_name(dice, names), self.new_body())
            units.insert(0, ('link', link))
            visible_bodies.append(link)
            links.append(link)
            canonical = link.body

        element = ElementTree.Element('model', name=name)
        if links and self.chance(4):
            chosen = dice.choice(links)
            element.set('canonical_link', chosen.reference)
            canonical = chosen.body
        built = Built(element, name, static, canonical, self.new_body(), links=links)
        # libsdformat checks the joints of a model in a world or at the top of a file.
        are_joints_checked = depth < 2 or top or merged
        children = self.content(
            built, units, visible_bodies, names, are_joints_checked=are_joints_checked)

        if static or self.chance(8):
            text = dice.choice(BOOLEANS[static])
            ElementTree.SubElement(element, 'static').text = text
        element.extend(children)
        if self.chance(8 if merged else 4):
            element.set('placement_frame', dice.choice(built.inner).reference)
        if top:
            pose = new_pose(dice)
            if pose is not None:
                # A blank is taken for a name here, and here alone.
                pose.attrib.pop('relative_to', None)
                element.insert(dice.randint(0, len(element)), pose)
        return built

    def content(self, built: Built, units: list[tuple[str, Any]], bodies: list[Visible],
                names: set[str], *, are_joints_checked: bool) -> list[ElementTree.Element]:
        """Draw poses for a model's parts, its frames, joints and the links' children."""
        own = Visible(MODEL, OWN)
        placed = [own]
        elements: list[ElementTree.Element | None] = [None] * len(units)
        extra = ['frame'] * self.count(4) + ['joint'] * self.count(3)
        steps: list[Any] = self.shuffled([*range(len(units)), *extra])
        added: list[ElementTree.Element] = []
        filled: list[ElementTree.Element] = []
        for step in steps:
            if step == 'frame':
                frame, seen = self.frame(placed, bodies, names, OWN)
                added.append(frame)
                placed.append(seen)
            elif step == 'joint':
                joint, joint_seen = self.joint(built, placed, bodies, names)
                if joint is not None and joint_seen is not None:
                    if not are_joints_checked:
                        self.misuse_nested_joint(joint)
                    added.append(joint)
                    filled.append(joint)
                    placed.append(joint_seen)
            elif units[step][0] == 'link':
                visible = units[step][1]
                link = ElementTree.Element('link', name=visible.reference)
                pose = new_pose(self.dice, self.reference(placed))
                if pose is not None:
                    link.append(pose)
                elements[step] = link
                filled.append(link)
                placed.append(visible)
            else:
                kind, part = units[step]
                self.place(part, placed, merge=kind == 'merge')
                if kind == 'model':
                    built_placement = part.element.get('placement_frame')
                    if built_placement is None and self.chance(5):
                        frame_name = self.dice.choice(part.inner).reference
                        part.element.set('placement_frame', frame_name)
                elements[step] = part.element
                placed += part.seen_merged() if kind == 'merge' else part.seen_outside()
        built.inner = placed
        references = [visible.reference for visible in placed]
        for element in filled:
            self.links.fill(element, references)
        self.links.add_mimics([element for element in filled if element.tag == 'joint'])
        ordered = [element for element in elements if element is not None]
        for element in added:
            ordered.insert(self.dice.randint(0, len(ordered)), element)
        return ordered

    def frame(self, placed: list[Visible], bodies: list[Visible], names: set[str],
              default_body: int) -> tuple[ElementTree.Element, Visible]:
        """Draw an explicit frame; with a ``relative_to`` it may hang on what is placed later."""
        name = new_name(self.dice, names)
        element = ElementTree.Element('frame', name=name)
        reference = self.reference(placed)
        body = default_body
        if not self.chance(3):
            attached = self.dice.choice(placed + bodies if reference else placed)
            element.set('attached_to', attached.reference)
            body = attached.body
        pose = new_pose(self.dice, reference)
        if pose is not None:
            element.append(pose)
        return element, Visible(name, body)

    def joint(self, built: Built, placed: list[Visible], bodies: list[Visible],
              names: set[str]) -> tuple[ElementTree.Element | None, Visible | None]:
        """Draw a joint, or nothing where no pair of bodies can be joined."""
        dice = self.dice

        def carrier(visible: Visible) -> int:
            return built.body if visible.body == OWN else visible.body

        def is_joinable(visible: Visible) -> bool:
            return not visible.reference.endswith(MODEL)

        reference = self.reference(placed)
        children = [v for v in (placed + bodies if reference else placed) if is_joinable(v)]
        if not children:
            return None, None
        child = dice.choice(children)
        parents = [v for v in placed + bodies
                   if is_joinable(v) and not v.is_model and carrier(v) != carrier(child)]
        parent = 'world'
        if parents and not self.chance(6):
            parent = dice.choice(parents).reference
        name = new_name(dice, names)
        element = joint_body(dice, name, parent, child.reference)
        pose = new_pose(dice, reference)
        if pose is not None:
            element.insert(0, pose)
        return element, Visible(name, child.body)

    def misuse_nested_joint(self, joint: ElementTree.Element) -> None:
        """Give a joint an end that libsdformat does not check in a model in a model."""
        if Feature.NESTED_JOINTS not in self.features or not self.chance(3):
            return
        self.traits.add('nested-joint')
        parent = joint.find('parent')
        if parent is not None and self.chance(2):
            parent.text = self.dice.choice((UNKNOWN_FRAME, joint.get('name')))
        elif joint.find('axis/xyz') is not None:
            joint.find('axis/xyz').set('expressed_in', UNKNOWN_FRAME)

    # Worlds ---------------------------------------------------------------------------------

    def world(self, name: str) -> ElementTree.Element:
        """Draw a world with models, frames and lights."""
        dice = self.dice
        names: set[str] = set()
        kinds = ['model'] * dice.randint(1, 3)
        if Feature.INCLUDES in self.features and self.chance(6):
            kinds += ['include'] * dice.randint(1, 2)
        models = [self.model(names, 1) if kind == 'model' else self.include(names, 1, merge=False)
                  for kind in kinds]
        bodies = [visible for built in models for visible in built.seen_outside()]
        placed = [Visible('world', WORLD)]
        elements: list[ElementTree.Element] = []
        for step in self.shuffled([*models, *['frame'] * self.count(4)]):
            if step == 'frame':
                element, seen = self.frame(placed, bodies, names, WORLD)
                elements.append(element)
                placed.append(seen)
            else:
                self.place(step, placed)
                elements.append(step.element)
                placed += step.seen_outside()
        lights: set[str] = set()
        for _ in range(self.count(2)):
            kind = dice.choice(('point', 'spot', 'directional'))
            light = ElementTree.Element('light', name=new_name(dice, lights), type=kind)
            pose = new_pose(dice, self.reference(placed))
            if pose is not None:
                light.append(pose)
            elements.append(light)
        if Feature.INCLUDES in self.features and self.chance(10):
            elements.append(self.included_light(lights, placed))
        world = ElementTree.Element('world', name=name)
        world.extend(self.shuffled(elements))
        return world

    def included_light(self, names: set[str], placed: list[Visible]) -> ElementTree.Element:
        """Draw a light in a file of its own, and the element that includes it."""
        light = ElementTree.Element('light', name=new_name(self.dice, names), type='point')
        pose = new_pose(self.dice)
        if pose is not None:
            light.append(pose)
        include = ElementTree.Element('include')
        ElementTree.SubElement(include, 'uri').text = self.included_path(light)
        if self.chance(2):
            ElementTree.SubElement(include, 'name').text = new_name(self.dice, names)
        pose = new_pose(self.dice, self.reference(placed))
        if pose is not None:
            include.append(pose)
        return include

    def scene(self) -> ElementTree.Element:
        """Draw the top of the scene's own file."""
        if self.chance(3):
            return self.model(set(), 0, top=True).element
        return self.world(new_name(self.dice, set()))


def random_scene(dice: Random, features: frozenset[Feature] = frozenset(Feature)) -> SceneFiles:
    """
    Draw a scene with every file that it needs.

    :param dice: what is drawn.
    :param features: what it may hold. With DEFECTS, one scene in five at most is broken.
    """
    builder = SceneBuilder(dice, features)
    if Feature.ODD_VALUES in features and builder.chance(4):
        return odd_scene(dice, features)
    if Feature.CHAINS in features and builder.chance(3):
        scene = chain_scene(dice)
        is_set = Feature.POSES_SET in features and builder.chance(3)
        return with_pose_set(scene, dice) if is_set else scene
    content = [builder.scene()]
    if Feature.WORLDS in features and content[0].tag == 'world' and builder.chance(8):
        content.append(builder.world(content[0].get('name', '') + ' too'))
    defect = ''
    if Feature.DEFECTS in features:
        defect = add_defect(dice, content)
    builder.files['scene.sdf'] = builder.file_text(content)
    return SceneFiles(builder.files, frozenset(builder.traits), defect)
