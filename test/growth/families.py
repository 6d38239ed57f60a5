# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Families of files that grow: for each construct that can be repeated or nested, a function of n.

A new construct gets a row of the table by one more function here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple


class Link(NamedTuple):
    """A symbolic link."""

    target: str


Files = Mapping[str, str | Link]
"""Texts and links by path; ``scene.sdf`` is loaded, and ``fuel`` is the cache of Gazebo Fuel."""

Content = Callable[[int], str]
"""Makes the content of a model, of about n parts."""

CONTENTS: dict[str, Content] = {}
"""Families of what a model holds; each can stand beside or in any other."""

FAMILIES: dict[str, Callable[[int], Files]] = {}
"""Families of whole files."""


def content(function: Content) -> Content:
    """Add a family of what a model holds."""
    CONTENTS[function.__name__] = function
    return function


def family(function: Callable[[int], Files]) -> Callable[[int], Files]:
    """Add a family of files."""
    FAMILIES[function.__name__] = function
    return function


def each(n: int, text: str) -> str:
    """Return a text n times, with its number for each ``#``."""
    return ''.join(text.replace('#', str(number)) for number in range(n))


def nested(n: int, begin: str, inside: str, end: str) -> str:
    """Return a text in n others, of which each has its depth for ``#``."""
    return each(n, begin) + inside + end * n


def model(text: str, attributes: str = '', version: str = '1.9') -> str:
    """Return a file of one model."""
    return (f'<sdf version="{version}"><model name="top" {attributes}><link name="base"/>{text}'
            '</model></sdf>')


def world(text: str) -> str:
    """Return a file of one world."""
    return f'<sdf version="1.10"><world name="w">{text}</world></sdf>'


def include(text: str = '', attributes: str = '', uri: str = 'part.sdf') -> str:
    """Return an include."""
    return f'<include {attributes}><uri>{uri}</uri>{text}</include>'


LINK = '<link name="l"/>'
POSE = '<pose>1 2 3 0.1 0.2 0.3</pose>'
MERGE = 'merge="true"'
DEEPEST = 200


# What a model holds

@content
def links(n: int) -> str:
    return each(n, '<link name="l#"/>')


@content
def links_with_poses(n: int) -> str:
    return each(n, f'<link name="p#">{POSE}</link>')


@content
def visuals(n: int) -> str:
    return '<link name="v">' + each(n, '<visual name="v#"/>') + '</link>'


@content
def collisions_of_an_automatic_inertial(n: int) -> str:
    box = '<geometry><box><size>1 1 1</size></box></geometry>'
    collision = f'<collision name="c#">{box}</collision>'
    return f'<link name="c"><inertial auto="true"/>{each(n, collision)}</link>'


@content
def sensors(n: int) -> str:
    return '<link name="s">' + each(n, '<sensor name="s#" type="camera"/>') + '</link>'


@content
def sensors_with_one_frame_id(n: int) -> str:
    sensor = '<sensor name="i#" type="camera"><gz_frame_id>same</gz_frame_id></sensor>'
    return f'<link name="i">{each(n, sensor)}</link>'


@content
def lights(n: int) -> str:
    return '<link name="li">' + each(n, '<light name="l#" type="point"/>') + '</link>'


@content
def frames(n: int) -> str:
    return each(n, '<frame name="f#"/>')


@content
def chain_of_attachments(n: int) -> str:
    return '<frame name="a0"/>' + ''.join(
        f'<frame name="a{i + 1}" attached_to="a{i}"/>' for i in range(n))


@content
def chain_of_poses(n: int) -> str:
    return '<frame name="r0"/>' + ''.join(
        f'<frame name="r{i + 1}"><pose relative_to="r{i}">1 0 0 0 0 0</pose></frame>'
        for i in range(n))


@content
def cycle_of_attachments(n: int) -> str:
    return ''.join(f'<frame name="y{i}" attached_to="y{(i + 1) % n}"/>' for i in range(n))


@content
def small_cycles(n: int) -> str:
    return each(n, '<frame name="u#" attached_to="w#"/><frame name="w#" attached_to="u#"/>')


@content
def unknown_references(n: int) -> str:
    return each(n, '<frame name="k#" attached_to="none#"/>')


@content
def unknown_references_of_visuals(n: int) -> str:
    visual = '<visual name="v#"><pose relative_to="none#"/></visual>'
    return f'<link name="uv">{each(n, visual)}</link>'


@content
def references_with_their_own_model(n: int) -> str:
    return each(n, '<frame name="o#" attached_to="top::base"/>')


@content
def joints(n: int) -> str:
    return '<link name="j"/>' + each(
        n, '<link name="c#"/><joint name="j#" type="revolute"><parent>j</parent>'
        '<child>c#</child><axis/></joint>')


@content
def chain_of_joints(n: int) -> str:
    return '<link name="h0"/>' + ''.join(
        f'<link name="h{i + 1}"/><joint name="hj{i}" type="fixed"><parent>h{i}</parent>'
        f'<child>h{i + 1}</child></joint>' for i in range(n))


@content
def joints_of_two_links(n: int) -> str:
    return '<link name="t"/><link name="tt"/>' + each(
        n, '<joint name="t#" type="ball"><parent>t</parent><child>tt</child></joint>')


@content
def joints_without_ends(n: int) -> str:
    return each(n, '<joint name="w#" type="fixed"><parent>no</parent><child>no</child></joint>')


@content
def mimics(n: int) -> str:
    return '<link name="m"/>' + ''.join(
        f'<link name="m{i}"/><joint name="mj{i}" type="revolute"><parent>m</parent>'
        f'<child>m{i}</child><axis><mimic joint="mj{i - 1 if i else 0}"/></axis></joint>'
        for i in range(n))


@content
def equal_names(n: int) -> str:
    return '<link name="e"/>' * n


@content
def equal_names_of_two_kinds(n: int) -> str:
    return each(n, '<link name="ek#"/><frame name="ek#"/>')


@content
def missing_names(n: int) -> str:
    return '<link/>' * n


@content
def reserved_names(n: int) -> str:
    return each(n, '<frame name="__r#__"/>')


@content
def long_names(n: int) -> str:
    return each(max(n // 100, 1), f'<link name="{"x" * 2000}#"/>')


@content
def names_of_two_letters_repeated(n: int) -> str:
    return each(n, f'<link name="{"ab" * 20}#"/>') + each(
        n // 10, f'<frame name="ba#" attached_to="{"ba" * 20}#"/>')


@content
def scoped_names(n: int) -> str:
    return each(n, '<link name="a::b#"/>')


@content
def undefined_elements(n: int) -> str:
    return '<a/>' * n


@content
def undefined_elements_of_many_names(n: int) -> str:
    return each(n, '<a#/>')


@content
def undefined_attributes(n: int) -> str:
    return '<link name="ua"' + each(n, ' a#="1"') + '/>'


@content
def undefined_attributes_of_many_links(n: int) -> str:
    return each(n, '<link name="um#" b="1"/>')


@content
def prefixed_elements(n: int) -> str:
    return '<x:y/>' * n


@content
def plugins(n: int) -> str:
    return each(n, '<plugin name="p#" filename="f"><a/></plugin>')


@content
def second_poses(n: int) -> str:
    return f'<frame name="sp">{POSE * n}</frame>'


@content
def wrong_numbers(n: int) -> str:
    return each(n, '<frame name="n#"><pose>1 2 x</pose></frame>')


@content
def numbers_of_many_digits(n: int) -> str:
    return f'<frame name="nd"><pose>{"1" * 10 * n} 0 0 0 0 0</pose></frame>'


@content
def many_numbers_in_a_pose(n: int) -> str:
    return f'<frame name="np"><pose>{"1 " * 10 * n}</pose></frame>'


@content
def white_space_in_a_pose(n: int) -> str:
    return f'<frame name="ws"><pose>1 2 3{" " * 20 * n}0 0 0</pose></frame>'


@content
def wrong_types(n: int) -> str:
    return each(
        n, '<joint name="q#" type="hinge"><parent>base</parent><child>base</child></joint>')


@content
def nested_models(n: int) -> str:
    return nested(min(n, DEEPEST), '<model name="n#"><link name="l"/>', '', '</model>')


@content
def deep_links(n: int) -> str:
    return nested(
        min(n, DEEPEST), '<model name="d#"><link name="l"/>', links(n), '</model>')


@content
def deep_links_with_errors(n: int) -> str:
    return nested(
        min(n, DEEPEST), '<model name="g#"><link name="l"/>',
        each(n, '<link name="x#"><visual/></link>'), '</model>')


@content
def deep_joints(n: int) -> str:
    return nested(min(n, DEEPEST), '<model name="dj#"><link name="l"/>', joints(n), '</model>')


@content
def deep_scoped_names(n: int) -> str:
    return nested(min(n, DEEPEST), '<model name="b::c#">', scoped_names(n), '</model>')


@content
def deep_references(n: int) -> str:
    depth = min(n, DEEPEST)
    path = '::'.join(f'z{number}' for number in range(depth))
    return nested(depth, '<model name="z#">', LINK, '</model>') + each(
        max(n // 50, 1), f'<frame name="z_#" attached_to="{path}::l"/>')


@content
def placement_frames(n: int) -> str:
    return each(n, '<model name="pf#" placement_frame="l"><link name="l"/></model>')


@content
def placement_at_the_end_of_a_chain(n: int) -> str:
    return (f'<model name="pc" placement_frame="a{n}"><link name="l"/>{chain_of_attachments(n)}'
            '</model>')


@content
def deep_placements_at_the_end_of_a_chain(n: int) -> str:
    depth = min(n, DEEPEST)
    text = chain_of_attachments(n) + LINK
    path = f'a{n}'
    for _ in range(depth):
        text = f'<model name="pd" placement_frame="{path}"><link name="l"/>{text}</model>'
        path = f'pd::{path}'
    return text


@content
def models_without_links(n: int) -> str:
    return each(n, '<model name="mw#"/>')


@content
def grippers(n: int) -> str:
    return each(n, '<gripper name="gr#"><palm_link>l</palm_link></gripper>')


@content
def comments(n: int) -> str:
    return '<!-- <!DOCTYPE [ -->' * n


@content
def declarations_in_one_comment(n: int) -> str:
    return f'<!-- {"<!DOCTYPE" * n} -->'


@content
def text_between_comments(n: int) -> str:
    return f'<link name="tc"><pose>{"<!-- -->1" * n}</pose></link>'


@content
def verbatim_sections(n: int) -> str:
    return '<![CDATA[<link>]]>' * n


@content
def character_references(n: int) -> str:
    return f'<frame name="{"&#97;" * n}"/>'


@content
def bare_ampersands(n: int) -> str:
    return f'<x:a>{"R&D &amp " * n}</x:a>'


@content
def less_than_signs_in_values(n: int) -> str:
    return each(n, '<x:a b="<<"/>')


@content
def hyphens_in_comments(n: int) -> str:
    return f'<!-- {"-- " * n} -->'


@content
def attributes_without_space(n: int) -> str:
    return '<x:a ' + each(n, 'b#="1"') + '/>'


@content
def name_spaces(n: int) -> str:
    return each(n, '<x xmlns="urn:#"/>')


@content
def prefixes_with_name_spaces(n: int) -> str:
    return each(n, '<p#:x xmlns:p#="urn:#"/>')


@content
def blank_lines(n: int) -> str:
    return '\n' * 20 * n + links(max(n // 10, 1))


@content
def elements_nested_in_a_plugin(n: int) -> str:
    return ('<plugin name="pn" filename="f">' + nested(min(n, DEEPEST), '<a>', '<b/>' * n, '</a>')
            + '</plugin>')


# Whole files

@family
def worlds(n: int) -> Files:
    return {'scene.sdf': '<sdf version="1.9">' + each(n, '<world name="w#"/>') + '</sdf>'}


@family
def models_at_the_top(n: int) -> Files:
    return {'scene.sdf': '<sdf version="1.9">' + each(
        n, '<model name="m#"><link name="l"/></model>') + '</sdf>'}


@family
def includes(n: int) -> Files:
    return {'scene.sdf': world(each(n, include('<name>m#</name>'))), 'part.sdf': model('')}


@family
def includes_without_a_uri_in_deep_links(n: int) -> Files:
    links = '<link name="l"><include/></link>' * n
    return {'scene.sdf': world('<model name="m">' * DEEPEST + links + '</model>' * DEEPEST)}


@family
def links_of_an_actor(n: int) -> Files:
    return {'scene.sdf': world(f'<actor name="a">{LINK * n}</actor>')}


@family
def axes_without_a_direction(n: int) -> Files:
    joint = '<joint name="j" type="revolute">' + '<axis/>' * n + '</joint>'
    return {'scene.sdf': model(joint, version='1.4')}


@family
def elements_behind_the_outermost_one(n: int) -> Files:
    return {'scene.sdf': model('') + '<a/>' * n + '</a>'}


@family
def includes_of_many_files(n: int) -> Files:
    parts = {f'p{number}.sdf': model('') for number in range(n // 4)}
    return {'scene.sdf': world(''.join(include(f'<name>{uri}</name>', uri=uri) for uri in parts)),
            **parts}


@family
def includes_of_a_directory(n: int) -> Files:
    manifest = '<sdf version="1.9">model.sdf</sdf>' * n
    return {'scene.sdf': world(each(n, include('<name>m#</name>', uri='part'))),
            'part/model.config': f'<model>{manifest}</model>', 'part/model.sdf': model('')}


@family
def includes_that_are_missing(n: int) -> Files:
    return {'scene.sdf': world(each(n, include(uri='none#.sdf')))}


@family
def includes_of_one_file_that_is_missing(n: int) -> Files:
    return {'scene.sdf': world(include(uri='none.sdf') * n)}


@family
def includes_of_a_broken_file(n: int) -> Files:
    return {'scene.sdf': world(include() * n), 'part.sdf': '<sdf'}


@family
def includes_in_a_cycle(n: int) -> Files:
    return {'scene.sdf': model(include(uri='scene.sdf') * n)}


@family
def includes_of_a_file_with_many_tops(n: int) -> Files:
    half = max(n // 2, 1)
    return {'scene.sdf': world(include() * half), 'part.sdf': models_at_the_top(half)['scene.sdf']}


@family
def includes_of_includes(n: int) -> Files:
    depth = min(n, 60)
    return {'scene.sdf': model(include(uri='p0.sdf')), **{
        f'p{level}.sdf': model(
            include(uri=f'p{level + 1}.sdf') if level < depth else links(n // depth))
        for level in range(depth + 1)}}


@family
def includes_that_double(n: int) -> Files:
    depth = max(n.bit_length(), 1)
    return {'scene.sdf': model(include(uri='p0.sdf')), **{
        f'p{level}.sdf': model(''.join(
            include(f'<name>{name}</name>', uri=f'p{level + 1}.sdf') for name in 'ab')
            if level < depth else '') for level in range(depth + 1)}}


@family
def merges(n: int) -> Files:
    return {'scene.sdf': world(each(
        n, '<model name="m#">' + include(attributes=MERGE) + '</model>')),
        'part.sdf': model('')}


@family
def merges_with_names(n: int) -> Files:
    return {'scene.sdf': world(each(
        n, '<model name="m#">' + include('<name>n#</name>', MERGE) + '</model>')),
        'part.sdf': model('')}


@family
def merges_into_one_model(n: int) -> Files:
    return {'scene.sdf': model(each(n, include('<name>n#</name>', MERGE))),
            'part.sdf': model('')}


def with_params(params: str, part: str) -> Files:
    """Return an include with parameters."""
    return {'scene.sdf': world(include(
        f'<experimental:params>{params}</experimental:params>')), 'part.sdf': model(part)}


@family
def params_for_one_link(n: int) -> Files:
    return with_params('<link element_id="base" action="modify"/>' * n, '')


@family
def params_for_many_links(n: int) -> Files:
    return with_params(each(n, '<link element_id="p#" action="modify">'
                            '<pose>0 0 0 0 0 0</pose></link>'), links_with_poses(n))


@family
def params_that_add(n: int) -> Files:
    return with_params(each(n, '<link element_id="" name="n#" action="add"/>'), '')


@family
def params_that_remove(n: int) -> Files:
    return with_params(each(n, '<link element_id="l#" action="remove"/>'), links(n))


@family
def params_that_add_includes(n: int) -> Files:
    return {**with_params(each(
        n, f'<model element_id="" name="n#" action="add">{include(uri="other.sdf")}</model>'), ''),
        'other.sdf': model('')}


@family
def params_with_unknown_ids(n: int) -> Files:
    return with_params(each(n, '<link element_id="none#" action="remove"/>'), links(n))


@family
def params_with_unknown_deep_ids(n: int) -> Files:
    return with_params(each(n, '<link element_id="none#" action="remove"/>'), deep_links(n))


@family
def params_for_children(n: int) -> Files:
    return with_params('<link element_id="v">' + each(
        n, '<visual name="v#" action="remove"/>') + '</link>', visuals(n))


@family
def params_with_attributes(n: int) -> Files:
    attributes = each(n, ' a#="1"')
    return with_params(f'<link element_id="v" action="modify" {attributes}/>',
                       visuals(n).replace('<link ', f'<link {attributes} '))


@family
def params_for_deep_elements(n: int) -> Files:
    depth = min(n, DEEPEST)
    path = '::'.join(f'n{number}' for number in range(depth))
    return with_params(f'<link element_id="{path}::l" action="modify"/>' * max(n // 50, 1),
                       nested_models(depth))


INERTIAL = ('<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
            '</inertial>')


def robot(text: str) -> Files:
    """Return a robot in URDF, whose root is l0."""
    return {'scene.sdf': f'<robot name="r"><link name="l0">{INERTIAL}</link>{text}</robot>'}


def urdf_chain(n: int, joint_type: str = 'fixed') -> str:
    """Return a chain of links from l0 to ln."""
    return ''.join(
        f'<link name="l{i + 1}">{INERTIAL}</link><joint name="j{i}" type="{joint_type}">'
        f'<origin xyz="0 0 1"/><parent link="l{i}"/><child link="l{i + 1}"/></joint>'
        for i in range(n))


@family
def urdf_chain_of_fixed_joints(n: int) -> Files:
    return robot(urdf_chain(n))


@family
def urdf_chain_of_moving_joints(n: int) -> Files:
    return robot(urdf_chain(n, 'continuous'))


@family
def urdf_star(n: int) -> Files:
    return robot(each(n, f'<link name="s#">{INERTIAL}</link><joint name="j#" type="fixed">'
                      '<parent link="l0"/><child link="s#"/></joint>'))


@family
def urdf_errors(n: int) -> Files:
    return robot(each(n, '<joint name="j#" type="x"/>'))


@family
def urdf_cycles(n: int) -> Files:
    return robot(each(
        n, '<link name="a#"/><link name="b#"/><joint name="x#" type="fixed"><parent link="a#"/>'
        '<child link="b#"/></joint><joint name="y#" type="fixed"><parent link="b#"/>'
        '<child link="a#"/></joint>'))


@family
def urdf_visuals_of_lumped_links(n: int) -> Files:
    visual = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    return robot(urdf_chain(n // 2) + f'<link name="v">{INERTIAL}{visual * n}</link>'
                 f'<joint name="v" type="fixed"><parent link="l{n // 2}"/><child link="v"/>'
                 '</joint>')


@family
def urdf_sensors_of_lumped_links(n: int) -> Files:
    sensor = '<sensor name="s#" type="imu"/>'
    return robot(urdf_chain(n // 2)
                 + f'<gazebo reference="l{n // 2}">{each(n, sensor)}</gazebo>')


@family
def urdf_gazebo_elements(n: int) -> Files:
    return robot('<gazebo><plugin name="p" filename="f"/></gazebo>' * n)


@family
def urdf_gazebo_elements_for_nothing(n: int) -> Files:
    return robot(each(n, '<gazebo reference="none#"><light/></gazebo>'))


@family
def urdf_long_name_of_a_lumped_link(n: int) -> Files:
    visual = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    text = (f'<link name="v">{visual * n}</link><joint name="v" type="fixed"><parent link="l0"/>'
            '<child link="v"/></joint>')
    return {'scene.sdf': robot(text)['scene.sdf'].replace('l0', 'x' * 10 * n)}


@family
def urdf_mimics(n: int) -> Files:
    return robot(urdf_chain(n, 'continuous').replace(
        '</joint>', '<mimic joint="j0"/></joint>'))


@family
def file_of_no_xml(n: int) -> Files:
    return {'scene.sdf': '<<&' * 10 * n}


@family
def file_of_open_tags(n: int) -> Files:
    return {'scene.sdf': '<a>' * 10 * n}


@family
def tag_that_does_not_end(n: int) -> Files:
    return {'scene.sdf': '<sdf ' + 'a="1" ' * n}


@family
def entities(n: int) -> Files:
    return {'scene.sdf': '<!DOCTYPE sdf [' + each(n, '<!ENTITY e# "x">') + ']>' + model('')}


@family
def document_type_that_is_quoted(n: int) -> Files:
    return {'scene.sdf': f'<!DOCTYPE sdf SYSTEM "{"[" * 10 * n}">' + model('')}


@family
def spaces_in_a_declaration(n: int) -> Files:
    return {'scene.sdf': f'<?xml version="1.0" {"encoding " * n}?>' + model('')}


@family
def bytes_that_are_not_utf_8(n: int) -> Files:
    return {'scene.sdf': model('<x:a>' + '\udcff' * 10 * n + '</x:a>')}


@family
def old_version(n: int) -> Files:
    return {'scene.sdf': model(each(
        n, '<link name="l#"><pose frame="l0">0 0 0 0 0 0</pose></link>'), version='1.4')}


@family
def names_that_are_renamed(n: int) -> Files:
    return {'scene.sdf': model(each(
        n, '<link name="r"/><frame name="r"/><joint name="r_frame#" type="fixed"/>'),
        version='1.6')}


@family
def world_joints(n: int) -> Files:
    return {'scene.sdf': world(each(
        n, '<model name="m#"><link name="l"/></model><joint name="j#" type="fixed">'
        '<parent>world</parent><child>m#</child></joint>'))}


# Lengths of names, alphabets, texts behind elements, links, name spaces and directories

NAMED_FRAME = '<frame name="ß#"/>'


@content
def names_beyond_ascii(n: int) -> str:
    unknown = each(50, '<frame name="r#" attached_to="λ#"/>')
    return f'<model name="{"Ω" * 370}"><link name="l"/>{each(n, NAMED_FRAME)}{unknown}</model>'


@content
def long_names_beyond_ascii(n: int) -> str:
    return each(50, f'<frame name="b#" attached_to="{"λ" * 190}#"/>') + each(
        max(n // 10, 1), f'<frame name="{"Λ" * 190}é#"/>')


@family
def urdf_long_name_of_a_link_with_unnamed_visuals(n: int) -> Files:
    visual = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    link = f'<link name="{"x" * 27 * n}">{visual * n}</link>'
    return {'scene.sdf': f'<robot name="r">{link}</robot>'}


@family
def urdf_long_name_of_a_link_with_many_joints(n: int) -> Files:
    text = robot(each(n, f'<link name="s#">{INERTIAL}</link><joint name="j#" type="continuous">'
                      '<parent link="l0"/><child link="s#"/></joint>'))
    return {'scene.sdf': text['scene.sdf'].replace('l0', 'x' * 10 * n)}


@family
def text_behind_an_included_model(n: int) -> Files:
    return {'scene.sdf': world(each(n, include('<name>m#</name>'))),
            'part.sdf': model('').replace('</sdf>', f'{"text " * 10 * n}</sdf>')}


@family
def verbatim_text_behind_an_included_model(n: int) -> Files:
    text = f'<![CDATA[{"text " * 10 * n}]]>'
    return {'scene.sdf': world(each(n, include('<name>m#</name>'))),
            'part.sdf': model('').replace('</sdf>', f'{text}</sdf>')}


@family
def text_behind_the_pose_of_a_merged_model(n: int) -> Files:
    pose = f'<pose>1 0 0 0 0 0</pose>{"text " * 10 * n}'
    return {'scene.sdf': model(each(n, include('<name>n#</name>', MERGE))),
            'part.sdf': model(pose)}


@family
def old_axis_with_many_flags(n: int) -> Files:
    flags = '<use_parent_model_frame>1</use_parent_model_frame>' * n
    return {'scene.sdf': model(
        '<link name="c"/><joint name="j" type="revolute"><parent>base</parent><child>c</child>'
        f'<axis>{flags}<xyz>0 0 1</xyz></axis></joint>', version='1.6')}


@family
def old_name_of_many_scopes(n: int) -> Files:
    scopes = 'a::' * min(n // 10, 240)
    return {'scene.sdf': world(
        f'<model name="m"><link name="b"/><link name="{scopes}l">{"<a/>" * n}</link></model>'
        ).replace('1.10', '1.7')}


@family
def old_name_of_very_many_scopes(n: int) -> Files:
    return {'scene.sdf': world(
        f'<model name="m"><link name="b"/><link name="{"a::" * n}l"/></model>'
        ).replace('1.10', '1.7')}


@family
def name_spaces_of_an_included_model(n: int) -> Files:
    spaces = each(n, ' xmlns:p#="u"')
    return {'scene.sdf': world(each(20, include('<name>m#</name>'))),
            'part.sdf': model(each(n, '<p#:x/>')).replace('<sdf', f'<sdf{spaces}')}


@family
def name_spaces_in_an_included_model(n: int) -> Files:
    spaces = each(n, ' xmlns:p#="u"')
    return {'scene.sdf': world(each(20, include('<name>m#</name>'))),
            'part.sdf': model(each(n, '<p#:x p0:a=""/>'), spaces)}


@family
def long_references_into_missing_includes(n: int) -> Files:
    missing = '<include><name>none</name><uri>none.sdf</uri></include>'
    return {'scene.sdf': model(missing + each(
        max(n // 40, 1), f'<frame name="f#" attached_to="{"a::" * 300}x"/>'))}


def linked(n: int, links: Mapping[str, Link], uri: str) -> Files:
    """Return a world that includes a file by links; each ``#`` in the URI is a number."""
    return {'scene.sdf': world(each(n, include('<name>m#</name>', uri=uri))),
            'real.sdf': model(''), 'd/nothing': '', **links}


LONG_WAY = 'd/../' * 800


@family
def includes_by_a_long_link(n: int) -> Files:
    return linked(n, {'part.sdf': Link(f'{LONG_WAY}real.sdf')}, 'part.sdf')


@family
def includes_by_long_links_in_many_ways(n: int) -> Files:
    links = {f'l{number}': Link(f'{LONG_WAY}l{number + 1}') for number in range(30)}
    ways = [f'{"./" * (number % 40)}{"d/../" * (number // 40)}l0' for number in range(n // 2)]
    return {'scene.sdf': world(''.join(
        include(f'<name>m{number}</name>', uri=uri) for number, uri in enumerate(ways))),
        'real.sdf': model(''), 'd/nothing': '', **links, 'l30': Link('real.sdf')}


def fuel_uri(number: int, owner: str = 'Owner') -> str:
    """Return the URI of a model of Gazebo Fuel."""
    return f'https://fuel.gazebosim.org/1.0/{owner}/models/M{number}'


def fuel_model(number: int, version: int = 1) -> Files:
    """Return a model in the cache of Fuel."""
    folder = f'fuel/fuel.gazebosim.org/owner/models/m{number}/{version}'
    return {f'{folder}/model.config': '<model><sdf version="1.9">model.sdf</sdf></model>',
            f'{folder}/model.sdf': model('')}


@family
def includes_of_many_models_of_fuel(n: int) -> Files:
    count = max(n // 3, 1)
    models: dict[str, str | Link] = {}
    for number in range(count):
        models.update(fuel_model(number))
    return {'scene.sdf': world(''.join(
        include(f'<name>m{number}</name>', uri=fuel_uri(number)) for number in range(count))),
        **models}


@family
def includes_of_a_model_of_fuel_with_many_versions(n: int) -> Files:
    models: dict[str, str | Link] = {}
    for version in range(1, max(n // 5, 2)):
        models.update(fuel_model(0, version))
    return {'scene.sdf': world(each(n, include('<name>m#</name>', uri=fuel_uri(0)))), **models}


@family
def includes_that_the_cache_of_fuel_does_not_have(n: int) -> Files:
    empty = {f'fuel/fuel.gazebosim.org/owner/models/x{number}/1/nothing': ''
             for number in range(n // 5)}
    return {'scene.sdf': world(''.join(
        include(f'<name>m{number}</name>', uri=fuel_uri(number)) for number in range(n))), **empty}


def included_contents(name: str, n: int) -> Files:
    """Return a world that includes a file with a content, as often as the content is long."""
    return {'scene.sdf': world(each(n, include('<name>m#</name>'))),
            'part.sdf': model(CONTENTS[name](n))}


def merged_contents(name: str, n: int) -> Files:
    """Return models that each merge a file with a content, as often as the content is long."""
    return {'scene.sdf': world(each(
        n, '<model name="m#">' + include('<name>n#</name>', MERGE) + '</model>')),
        'part.sdf': model(CONTENTS[name](n))}


def changed_contents(name: str, n: int) -> Files:
    """Return an include of a file with a content, with as many parameters."""
    return with_params(each(n, '<link element_id="none#" action="remove"/>'), CONTENTS[name](n))
