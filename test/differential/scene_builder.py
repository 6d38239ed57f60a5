# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Random scenes: an SDFormat file, with the files that it includes.

Most of them are valid, as each part of a scope is given only from those placed before it. Where it
stands in the document is drawn apart from that, so that most references point forward as often as
backward. Some scenes are changed at random afterwards.
"""

from __future__ import annotations

from typing import NamedTuple
from xml.etree import ElementTree

from differential.scene_changes import add_param, change_at_random
from differential.scene_links import add_mimics, fill, joint_body, UNKNOWN_FRAME
from differential.scene_text import BOOLEANS, new_name, new_pose, sub_element
from differential.scene_urdf import RobotBuilder
from differential.scene_values import odd_scene
from differential.scene_xml import with_oddities

Element = ElementTree.Element

SCENE = '@SCENE@'
"""Stands for the folder of the scene wherever a file names another."""

MODEL = '__model__'
VERSIONS = ('1.7', '1.8', '1.9', '1.9', '1.10', '1.11', '1.2', '1.3', '1.4', '1.5', '1.6', '1.6')


class SceneFiles(NamedTuple):
    """A scene as text."""

    files: dict[str, str]
    """Texts by path below the scene's folder; the scene itself is ``scene.sdf``."""
    traits: frozenset[str] = frozenset()
    """Parts of SDFormat that are in it."""

    def write(self, folder, name):
        """
        Write the files.

        :param folder: the folder in which includes are looked up.
        :param name: name of the scene's own folder in it.
        :return: path of the scene itself.
        """
        for path, text in self.files.items():
            target = folder / name / path
            target.parent.mkdir(parents=True, exist_ok=True)
            # Line ends stay as they were drawn.
            target.write_bytes(text.replace(SCENE, name).encode(errors='surrogateescape'))
        return folder / name / 'scene.sdf'


class Built(NamedTuple):
    """A model that is done."""

    element: Element
    name: str
    inner: list[str]
    """The frames that can be named inside it, ``__model__`` first."""
    links: list[str]
    """The links that can be named inside it."""

    def seen_outside(self):
        """Return what can be named in the scope that it is in."""
        inner, links = ([f'{self.name}::{each}' for each in names] for names in self[2:])
        return self._replace(inner=[self.name, *inner], links=links)

    def seen_merged(self):
        """Return what can be named in the scope that it is merged into."""
        return self._replace(inner=self.inner[1:])


class SceneBuilder:
    """Draws one scene; holds what its models share."""

    def __init__(self, dice):
        self.dice = dice
        self.files: dict[str, str] = {}
        self.traits: set[str] = set()
        self.deepest = 12 if self.chance(12) else 3
        self.is_changed = self.chance(3)

    def chance(self, one_in):
        """Draw whether something happens."""
        return self.dice.randrange(one_in) == 0

    def add(self, parent, child):
        """Put a child anywhere into an element."""
        if child is not None:
            parent.insert(self.dice.randint(0, len(parent)), child)

    def pose(self, placed):
        """Draw a pose, relative to a frame or to the default."""
        is_default = not placed or self.chance(3)
        return new_pose(self.dice, '' if is_default else self.dice.choice(placed))

    # Files ----------------------------------------------------------------------------------

    def file_text(self, content):
        """Write elements as a file, with a version drawn for it."""
        version = self.dice.choice(VERSIONS)
        root = Element('sdf', version=version)
        root.extend(content)
        if version in ('1.5', '1.6') and self.chance(2):
            for pose in root.iter('pose'):
                if 'relative_to' in pose.attrib:
                    pose.set('frame', pose.attrib.pop('relative_to'))
        if self.is_changed:
            self.traits.add('changed')
            change_at_random(self.dice, root)
        ElementTree.indent(root)
        text = ElementTree.tostring(root, encoding='unicode')
        # ElementTree would declare the prefix.
        text = text.replace('experimental_params', 'experimental:params')
        if self.chance(6):
            self.traits.add('odd XML')
            return with_oddities(self.dice, text)
        return text

    def included_uri(self, content):
        """Write a file, or a folder with a manifest, to be included; return its URI."""
        path = f'part_{len(self.files)}'
        if content.tag == 'robot':
            path += '.urdf'
            self.files[path] = ElementTree.tostring(content, encoding='unicode')
        elif self.chance(2):
            path += '.sdf'
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

    def include(self, taken, depth, *, merged=False):
        """Draw a file and the element that includes it; see :meth:`model`."""
        self.traits.add('merge' if merged else 'include')
        if self.chance(3):
            self.traits.add('URDF')
            builder = RobotBuilder(self.dice)
            built = Built(*builder.robot(taken, set() if not merged else taken))
        else:
            built = self.model(taken, depth + 1, top=True, merged=merged)
        element = Element('include')
        sub_element(element, 'uri', self.included_uri(built.element))
        if merged or self.chance(6):
            element.set('merge', self.dice.choice(BOOLEANS[merged]))
        built = built._replace(element=element)
        if self.chance(2):
            built = built._replace(name=new_name(self.dice, taken))
            sub_element(element, 'name', built.name)
        if self.chance(4):
            static = self.dice.choice(BOOLEANS[self.chance(2)])
            sub_element(element, 'static', static)
        if self.chance(3):
            self.traits.add('params')
            params = sub_element(element, 'experimental_params')
            for _ in range(self.dice.randint(1, 2)):
                add_param(self.dice, params, built.inner, built.links)
        return built

    def model(self, taken, depth, *, top=False, merged=False):
        """
        Draw a model.

        :param taken: names that it must not have; its own is added.
        :param top: whether it is the top of a file; it gets a pose without ``relative_to`` then,
            and none otherwise.
        :param merged: whether its content goes into the scope whose names are ``taken``.
        """
        dice = self.dice
        names = taken if merged else set()
        element = Element('model', name=new_name(dice, taken))
        built = Built(element, element.get('name', ''), [MODEL], [])
        parts = dice.choices(
            ('link', 'link', 'frame', 'frame', 'joint', 'joint'), k=dice.randint(0, 8))
        if depth < self.deepest:
            parts += ['model'] * (dice.randint(0, 2) if self.chance(min(depth, 3) + 2) else 0)
            parts += ['include'] * self.chance(10) + ['merge'] * self.chance(16)
        # The first part is a link: joints, and models that are not static, need one.
        for part in ('link', *self.shuffled(parts)):
            self.add_part(built, part, names, depth)
        for child in element.findall('link') + element.findall('joint'):
            fill(dice, child, built.inner)
        add_mimics(dice, element.findall('joint'))
        if self.chance(4):
            element.set('canonical_link', dice.choice(built.links))
        if self.chance(8 if merged else 4):
            element.set('placement_frame', dice.choice(built.inner))
        if self.chance(5):
            sub_element(element, 'static', dice.choice(BOOLEANS[not merged and self.chance(2)]))
        if top:
            self.add(element, new_pose(dice))
        return built

    def shuffled(self, values):
        """Draw an order."""
        return self.dice.sample(values, len(values))

    def add_part(self, built, part, names, depth):
        """Add a link, frame, joint, or model that is nested, included or merged, to a model."""
        if part in ('model', 'include', 'merge'):
            if part == 'model':
                nested = self.model(names, depth + 1)
            else:
                nested = self.include(names, depth, merged=part == 'merge')
            self.place(nested, built.inner)
            seen = nested.seen_merged() if part == 'merge' else nested.seen_outside()
            built.inner.extend(seen.inner)
            built.links.extend(seen.links)
            self.add(built.element, nested.element)
            return
        name = new_name(self.dice, names)
        if part == 'link':
            element = Element('link', name=name)
        elif part == 'joint':
            element = self.joint(name, built)
            if depth > 1 and self.chance(6):
                # libsdformat does not check this in a model in a model.
                element.find('parent').text = UNKNOWN_FRAME
        else:
            element = self.frame(name, built.inner)
        self.add(element, self.pose(built.inner))
        self.add(built.element, element)
        built.inner.append(name)
        if part == 'link':
            built.links.append(name)

    def place(self, built, placed):
        """Draw the pose of a nested, included or merged model."""
        pose = self.pose(placed)
        self.add(built.element, pose)
        if built.element.tag == 'include' and pose is not None and self.chance(4):
            sub_element(built.element, 'placement_frame', self.dice.choice(built.inner))

    def frame(self, name, placed):
        """Draw an explicit frame without its pose."""
        element = Element('frame', name=name)
        if not self.chance(3):
            element.set('attached_to', self.dice.choice(placed))
        return element

    def joint(self, name, built):
        """Draw a joint without its pose; its ends are seldom on one link."""
        child = self.dice.choice(built.links if self.chance(2) else built.inner[1:])
        others = [link for link in built.links if link != child]
        parent = self.dice.choice(others) if others and not self.chance(3) else 'world'
        return joint_body(self.dice, name, parent, child)

    def old_model(self, name):
        """Draw a model whose links are named by scopes, which old versions use for nesting."""
        dice = self.dice
        model = Element('model', name=name)
        for scope in dice.sample(('arm', 'cup', 'disk'), dice.randint(1, 2)):
            names = [f'{scope}::{name}' for name in dice.sample(('a', 'bb', 'x::cc'), 2)]
            for link_name in names:
                link = sub_element(model, 'link', name=link_name)
                self.add(link, self.pose(names if self.chance(3) else []))
            if self.chance(2):
                frame = Element('frame', name=f'{scope}::{MODEL}', attached_to=names[0])
                self.add(frame, new_pose(dice))
                self.add(model, frame)
            if self.chance(2):
                self.add(model, joint_body(dice, f'{scope}::j', *names))
        if self.chance(2):
            nested = Element('model', name='oval')
            sub_element(nested, 'link', name=dice.choice(('l', 'hub::l')))
            self.add(model, nested)
        return model

    # Worlds ---------------------------------------------------------------------------------

    def world(self, name):
        """Draw a world with models, frames, joints, lights and actors."""
        dice = self.dice
        world = Element('world', name=name)
        names: set[str] = set()
        built = Built(world, name, ['world'], [])
        parts = dice.choices(('model', 'frame', 'light'), k=dice.randint(0, 6))
        for part in ('model', *parts, *['include'] * self.chance(4), *['actor'] * self.chance(8)):
            if part in ('light', 'actor'):
                element = self.light_or_actor(part, new_name(dice, names), built.inner)
                self.add(world, element)
            else:
                self.add_part(built, part, names, 1)
        if built.links and self.chance(6):
            self.add_part(built, 'joint', names, 1)
        return world

    def light_or_actor(self, tag, name, placed):
        """Draw a light or an actor, either of which may be in a file of its own."""
        element = Element(tag, name=name)
        if tag == 'light':
            element.set('type', self.dice.choice(('point', 'spot', 'directional')))
        elif self.chance(2):
            sub_element(element, 'link', name='l')
        if self.chance(4):
            self.add(element, new_pose(self.dice))
            include = Element('include')
            sub_element(include, 'uri', self.included_uri(element))
            element = include
        self.add(element, self.pose(placed))
        return element


def random_scene(dice):
    """Draw a scene with every file that it needs."""
    builder = SceneBuilder(dice)
    if builder.chance(4):
        return SceneFiles({'scene.sdf': odd_scene(dice)}, frozenset({'odd values'}))
    if builder.chance(8):
        builder.traits.add('names by scope')
        content = [builder.old_model('m')]
    elif builder.chance(3):
        content = [builder.model(set(), 0, top=True).element]
    else:
        content = [builder.world(name) for name in (['w', 'v'] if builder.chance(8) else ['w'])]
    builder.files['scene.sdf'] = builder.file_text(content)
    return SceneFiles(builder.files, frozenset(builder.traits))
