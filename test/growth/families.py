# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Files that grow: for each construct that can be repeated or nested, a row of a table.

``PARTS`` are contents of a model, of about n parts each; ``FILES`` are whole files.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

Files = Mapping[str, str]
"""Texts by path; ``scene.sdf`` is loaded, and ``fuel`` is the cache of Gazebo Fuel."""


def each(n: int, text: str) -> str:
    """
    Return a text in which the part between two bars, or all of it, is there n times.

    Each time, ``#`` stands for its number and ``+`` for the next one.
    """
    begin, part, end = text.split('|') if '|' in text else ('', text, '')
    return begin + ''.join(
        part.replace('#', str(i)).replace('+', str(i + 1)) for i in range(n)) + end


def nested(n: int, begin: str, inside: str, end: str = '</model>') -> str:
    """Return a text in up to 200 others, each with its depth for ``#``."""
    return each(min(n, 200), begin) + inside + end * min(n, 200)


def model(text: str, attributes: str = '', version: str = '1.9') -> str:
    """Return a file of one model."""
    return (f'<sdf version="{version}"><model name="top" {attributes}><link name="base"/>{text}'
            '</model></sdf>')


def include(text: str = '', attributes: str = '', uri: str = 'part.sdf') -> str:
    """Return an include."""
    return f'<include {attributes}><uri>{uri}</uri>{text}</include>'


def scene(text: str, version: str = '1.10') -> Files:
    """Return a file of one world."""
    return {'scene.sdf': f'<sdf version="{version}"><world name="w">{text}</world></sdf>'}


def params(text: str, part: str) -> Files:
    """Return an include with parameters."""
    return {**scene(include(f'<experimental:params>{text}</experimental:params>')),
            'part.sdf': model(part)}


def robot(text: str, name: str = 'l0') -> Files:
    """Return a robot in URDF; its root, which the text knows as l0, may have another name."""
    return {'scene.sdf': f'<robot name="r"><link name="l0">{MASS}</link>{text}</robot>'.replace(
        '"l0"', f'"{name}"')}


def urdf_chain(n: int, joint_type: str) -> str:
    """Return a chain of links from l0 to ln."""
    return each(n, (
        f'<link name="l+">{MASS}</link><joint name="j#" type="{joint_type}"><origin xyz="0 0 1"/>'
        '<parent link="l#"/><child link="l+"/></joint>'))


def fuel(n: int, what: str = 'models') -> Files:
    """Return n models, or versions of one model, in the cache of Fuel."""
    folder = 'fuel/fuel.gazebosim.org/owner/models'
    paths = [f'{folder}/m{i}/1' if what == 'models' else f'{folder}/m0/{i + 1}' for i in range(n)]
    config = '<model><sdf version="1.9">model.sdf</sdf></model>'
    return {f'{path}/{name}': text for path in paths
            for name, text in (('model.config', config), ('model.sdf', model('')))}


def deep_placements(n: int) -> str:
    """Return models in one another, each placed by the end of one chain of frames."""
    text, path = each(n, REPEATED['attachments in a row']), f'a{n}'
    for _ in range(min(n, 200)):
        text = f'<model name="pd" placement_frame="{path}">{LINK}{text}</model>'
        path = f'pd::{path}'
    return text


LINK = '<link name="l"/>'
POSE = '<pose>1 2 3 0.1 0.2 0.3</pose>'
MERGE = 'merge="true"'
NAMED = include('<name>m#</name>')
MERGED = f'<model name="m#">{include("<name>n#</name>", MERGE)}</model>'
BOX = '<geometry><box><size>1 1 1</size></box></geometry>'
AUTO = '<inertial auto="true"/>'
SPHERE = '<visual><geometry><sphere radius="1"/></geometry></visual>'
MASS = ('<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
        '</inertial>')
JOINT = ('<joint name="j{}" type="revolute"><parent>{}</parent><child>{}</child>{}</joint>')
MIMIC = '<axis><mimic joint="jq#"/></axis>'
URDF_LINK = (f'<link name="s#">{MASS}</link><joint name="j#" type="fixed">'
             '<parent link="{}"/><child link="s#"/></joint>')
FLAG = '<use_parent_model_frame>1</use_parent_model_frame>'
UNKNOWN_ID = '<link element_id="none#" action="remove"/>'
FUEL = 'https://fuel.gazebosim.org/1.0/Owner/models/M#'
DEEP = f'<model name="n#">{LINK}'
PATH = '::'.join(f'n{number}' for number in range(200))

REPEATED = {
    'links': '<link name="l#"/>',
    'links with poses': f'<link name="p#">{POSE}</link>',
    'frames': '<frame name="f#"/>',
    'visuals': '<link name="vi">|<visual name="v#"/>|</link>',
    'sensors': '<link name="s">|<sensor name="s#" type="camera"/>|</link>',
    'lights': '<link name="li">|<light name="l#" type="point"/>|</link>',
    'automatic inertials': f'<link name="ai#">{AUTO}<collision name="c">{BOX}</collision></link>',
    'an automatic inertial':
        f'<link name="c">{AUTO}|<collision name="c#">{BOX}</collision>|</link>',
    'cycles': '<frame name="u#" attached_to="w#"/><frame name="w#" attached_to="u#"/>',
    'attachments in a row': '<frame name="a0"/>|<frame name="a+" attached_to="a#"/>|',
    'poses in a row':
        '<frame name="r0"/>|<frame name="r+"><pose relative_to="r#">1 0 0 0 0 0</pose></frame>|',
    'unknown references': '<frame name="k#" attached_to="none#"/>',
    'unknown references of visuals':
        '<link name="uv">|<visual name="v#"><pose relative_to="none#"/></visual>|</link>',
    'references with their own model': '<frame name="o#" attached_to="top::base"/>',
    'joints': f'<link name="c#"/>{JOINT.format("#", "base", "c#", "<axis/>")}',
    'joints in a row':
        f'<link name="h0"/>|<link name="h+"/>{JOINT.format("h#", "h#", "h+", "<axis/>")}|',
    'mimics in a row':
        f'<link name="q0"/>{JOINT.format("q0", "base", "q0", "<axis/>")}|'
        f'<link name="q+"/>{JOINT.format("q+", "base", "q+", MIMIC)}|',
    'joints of one link': JOINT.format('t#', 'base', 'base', ''),
    'joints without ends': JOINT.format('w#', 'a', 'b', ''),
    'wrong types': '<joint name="ty#" type="hinge"/>',
    'equal names': '<link name="e"/><frame name="e"/>',
    'missing names': '<link/>',
    'reserved names': '<frame name="__r#__"/>',
    'long names': f'<link name="{"x" * 2000}#"/>',
    'names beyond ASCII': '<frame name="ß#"/><frame name="é#" attached_to="λ#"/>',
    'long names beyond ASCII': f'<frame name="{"Λ" * 190}é#" attached_to="{"λ" * 190}#"/>',
    'scoped names': '<link name="a::b#"/>',
    'undefined elements': '<a/>',
    'undefined elements of many names': '<a#/>',
    'undefined attributes': '<link name="ua"| a#="1"|/>',
    'undefined attributes of many links': '<link name="um#" b="1"/>',
    'prefixed elements': '<x:y/>',
    'plugins': '<plugin name="p#" filename="f"><a/></plugin>',
    'second poses': f'<frame name="sp">|{POSE}|</frame>',
    'wrong numbers': '<frame name="n#"><pose>1 2 x</pose></frame>',
    'digits of a number': '<frame name="nd"><pose>|1111111111| 0 0 0 0 0</pose></frame>',
    'numbers in a pose': '<frame name="np"><pose>|1 1 1 1 1 |</pose></frame>',
    'white space in a pose': '<frame name="ws"><pose>1 2 3|          |0 0 0</pose></frame>',
    'placement frames': f'<model name="pf#" placement_frame="l">{LINK}</model>',
    'models without links': '<model name="mw#"/>',
    'grippers': '<gripper name="gr#"><palm_link>l</palm_link></gripper>',
    'comments': '<!-- <!DOCTYPE [ -->',
    'hyphens in a comment': '<!-- |-- | -->',
    'comments in a pose': '<link name="tc"><pose>|<!-- -->1|</pose></link>',
    'verbatim sections': '<![CDATA[<link>]]>',
    'character references': '<frame name="|&#97;|"/>',
    'bare ampersands': '<x:a>|R&D &amp |</x:a>',
    'less-than signs in values': '<x:a b="<<"/>',
    'attributes without space': '<x:a |b#="1"|/>',
    'name spaces': '<p#:x xmlns:p#="urn:#"/>',
    'blank lines': '\n\n\n\n\n<link name="bl#"/>',
}
"""Texts that a model holds n times; if there are bars, only the text between them."""

PARTS: dict[str, Callable[[int], str]] = {
    **{name: partial(each, text=text) for name, text in REPEATED.items()},
    'a cycle': lambda n: each(n, '<frame name="y#" attached_to="y+"/>').replace(f'y{n}"', 'y0"'),
    'models in one another': lambda n: nested(n, DEEP, ''),
    'links in deep models': lambda n: nested(n, DEEP, each(n, '<link name="d#"/>')),
    'errors in deep models': lambda n: nested(
        n, DEEP, each(n, '<link name="x#"><visual/></link>')),
    'scoped names in deep models': lambda n: nested(
        n, '<model name="b::c#">', each(n, '<link name="a::b#"/>')),
    'references into deep models': lambda n: nested(n, DEEP, '') + each(
        n // 50, f'<frame name="z_#" attached_to="{PATH}::l"/>'),
    'placement at the end of a chain': lambda n: (
        f'<model name="pc" placement_frame="a{n}">{LINK}'
        f'{each(n, REPEATED["attachments in a row"])}</model>'),
    'deep placements at the end of a chain': deep_placements,
    'elements in a deep plugin': lambda n: (
        '<plugin name="pn" filename="f">' + nested(n, '<a>', '<b/>' * n, '</a>') + '</plugin>'),
}
"""Contents of a model, of about n parts; each can stand beside any other."""

FILES: dict[str, Callable[[int], Files]] = {
    'worlds': lambda n: {'scene.sdf': each(n, '<sdf version="1.10">|<world name="w#"/>|</sdf>')},
    'models at the top': lambda n: {
        'scene.sdf': each(n, '<sdf version="1.10">|<model name="m#"/>|</sdf>')},
    'links of an actor': lambda n: scene(f'<actor name="a">{LINK * n}</actor>'),
    'joints of a world': lambda n: scene(each(
        n, f'<model name="m#">{LINK}</model>{JOINT.format("#", "world", "m#", "")}')),
    'elements behind the outermost one': lambda n: {'scene.sdf': model('') + '<a/>' * n + '</a>'},
    # Old versions
    'old poses': lambda n: {'scene.sdf': model(each(
        n, '<link name="l#"><pose frame="l0">0 0 0 0 0 0</pose></link>'), version='1.4')},
    'old axes': lambda n: {'scene.sdf': model(
        each(n, '<joint name="j">|<axis/>|</joint>'), version='1.4')},
    'flags of an old axis': lambda n: {'scene.sdf': model(
        each(n, f'<joint name="j"><axis>|{FLAG}|</axis></joint>'), version='1.6')},
    'names that are renamed': lambda n: {'scene.sdf': model(
        each(n, '<link name="r"/><frame name="r"/><joint name="r_frame#"/>'), version='1.6')},
    'old name of many scopes': lambda n: scene(
        f'<model name="m"><link name="{"a::" * 240}l">{"<a/>" * n}</link></model>', '1.7'),
    'scopes of an old name': lambda n: scene(
        f'<model name="m"><link name="{"a::" * n}l"/></model>', '1.7'),
    'scopes of an old name with many elements': lambda n: scene(
        f'<model name="m"><link name="{"a::" * min(n, 240)}l">{"<a/>" * 9000}</link></model>',
        '1.7'),
    'references in an old name of many scopes': lambda n: scene(
        f'<model name="m"><link name="{"a::" * 240}l">'
        + '<a relative_to="world"/>' * n + '</link></model>', '1.7'),
    # Includes
    'includes': lambda n: {**scene(each(n, NAMED)), 'part.sdf': model('')},
    'includes without a URI in deep models': lambda n: scene(
        nested(200, DEEP, '<link name="l"><include/></link>' * n)),
    'includes of many files': lambda n: {
        **scene(each(n // 4, include('<name>m#</name>', uri='p#.sdf'))),
        **{f'p{number}.sdf': model('') for number in range(n // 4)}},
    'includes of a directory': lambda n: {
        **scene(each(n, include('<name>m#</name>', uri='part'))), 'part/model.sdf': model(''),
        'part/model.config': each(n, '<model>|<sdf version="1.9">model.sdf</sdf>|</model>')},
    'missing includes': lambda n: scene(each(n, include(uri='none#.sdf'))),
    'missing includes beside many files': lambda n: {
        **scene(each(n, include(uri='none#.sdf'))), **{f'f{i}.txt': '' for i in range(n)}},
    'one missing include': lambda n: scene(include(uri='none.sdf') * n),
    'references into missing includes': lambda n: {'scene.sdf': model(
        include('<name>none</name>', uri='none.sdf')
        + each(n // 40, f'<frame name="f#" attached_to="{"a::" * 300}x"/>'))},
    'attachments to a missing include': lambda n: scene(
        include('<name>a0</name>', uri='none.sdf')
        + each(n, '<frame name="a+" attached_to="a#"/>')),
    'scopes of a reference into a missing include': lambda n: scene(
        include('<name>a</name>', uri='none.sdf')
        + f'<frame name="f" attached_to="{"a::" * n}b"/>'),
    'includes of a broken file': lambda n: {**scene(include() * n), 'part.sdf': '<sdf'},
    'includes in a cycle': lambda n: {'scene.sdf': model(include(uri='scene.sdf') * n)},
    'includes of a file with many tops': lambda n: {
        **scene(include() * (n // 2)),
        'part.sdf': each(n // 2, '<sdf version="1.9">|<model name="m#"/>|</sdf>')},
    'includes in one another': lambda n: {
        **{f'p{i}.sdf': model(include(uri=f'p{i + 1}.sdf')) for i in range(60)},
        'p60.sdf': model(each(n, '<link name="l#"/>')), 'scene.sdf': model(include(uri='p0.sdf'))},
    'includes that double': lambda n: {
        **{f'p{i}.sdf': model(each(2, include('<name>m#</name>', uri=f'p{i + 1}.sdf')))
           for i in range(n.bit_length())},
        f'p{n.bit_length()}.sdf': model(''), 'scene.sdf': model(include(uri='p0.sdf'))},
    'merges': lambda n: {**scene(each(n, MERGED.replace('n#', 'n'))), 'part.sdf': model('')},
    'merges with names': lambda n: {**scene(each(n, MERGED)), 'part.sdf': model('')},
    'merges into one model': lambda n: {
        'scene.sdf': model(each(n, include('<name>n#</name>', MERGE))), 'part.sdf': model('')},
    'text behind an included model': lambda n: {
        **scene(each(n, NAMED)), 'part.sdf': model('').replace('</sdf>', 'text ' * n + '</sdf>')},
    'text behind a pose of a merged model': lambda n: {
        'scene.sdf': model(each(n, include('<name>n#</name>', MERGE))),
        'part.sdf': model(f'{POSE}{"text " * n}')},
    'name spaces of an included model': lambda n: {
        **scene(each(20, NAMED)),
        'part.sdf': model(each(n, '<p#:x/>'), each(n, ' xmlns:p#="u"'))},
    # Parameters of includes
    'params for one link': lambda n: params('<link element_id="base" action="modify"/>' * n, ''),
    'params for many links': lambda n: params(each(
        n, f'<link element_id="p#" action="modify">{POSE}</link>'),
        each(n, REPEATED['links with poses'])),
    'params that add': lambda n: params(each(
        n, '<link element_id="" name="n#" action="add"/>'), ''),
    'params that remove': lambda n: params(each(
        n, '<link element_id="l#" action="remove"/>'), each(n, '<link name="l#"/>')),
    'params that replace': lambda n: params(each(
        n, '<link element_id="l#" name="k#" action="replace"/>'), each(n, '<link name="l#"/>')),
    'params that add includes': lambda n: {**params(each(
        n, f'<model element_id="" name="n#" action="add">{include(uri="other.sdf")}</model>'), ''),
        'other.sdf': model('')},
    'params with unknown ids': lambda n: params(each(n, UNKNOWN_ID), each(n, '<link name="l#"/>')),
    'params for children': lambda n: params(
        each(n, '<link element_id="vi">|<visual name="v#" action="remove"/>|</link>'),
        PARTS['visuals'](n)),
    'params that modify children': lambda n: params(
        '<link element_id="vi">'
        + each(n, f'<visual name="v#" action="modify">{POSE}</visual>') + '</link>',
        each(n, f'<link name="vi">|<visual name="v#">{POSE}</visual>|</link>')),
    'params for one link of many children': lambda n: params(
        '<link element_id="vi" name="vi" action="modify"/>' * n, PARTS['visuals'](n)),
    'params with attributes': lambda n: params(
        each(n, '<link element_id="vi" action="modify"| a#="1"|/>'), PARTS['visuals'](n)),
    'params for deep elements': lambda n: params(
        f'<link element_id="{PATH}::l" action="modify"/>' * (n // 50), nested(200, DEEP, '')),
    # Gazebo Fuel
    'models of Fuel': lambda n: {
        **scene(each(n // 3, include('<name>m#</name>', uri=FUEL))), **fuel(n // 3)},
    'versions of a model of Fuel': lambda n: {
        **scene(each(n, include('<name>m#</name>', uri=FUEL.replace('#', '0')))),
        **fuel(n // 5, 'versions')},
    'missing models of Fuel': lambda n: {
        **scene(each(n, include('<name>m#</name>', uri=FUEL.replace('#', 'x#')))), **fuel(n // 5)},
    # URDF
    'fixed joints of URDF in a row': lambda n: robot(urdf_chain(n, 'fixed')),
    'moving joints of URDF in a row': lambda n: robot(urdf_chain(n, 'continuous')),
    'mimics of URDF': lambda n: robot(urdf_chain(n, 'continuous').replace(
        '</joint>', '<mimic joint="j0"/></joint>')),
    'links of URDF at one link': lambda n: robot(each(n, URDF_LINK.format('l0'))),
    'errors in URDF': lambda n: robot(each(n, '<joint name="j#" type="x"/>')),
    'digits before a letter in URDF': lambda n: robot(
        urdf_chain(1, 'fixed') + f'<origin xyz="{"1" * 10 * n}x 0 0"/>'),
    'cycles of URDF': lambda n: robot(each(n, URDF_LINK.format('s+'))),
    'visuals of lumped links': lambda n: robot(urdf_chain(n // 2, 'fixed').replace(
        f'name="l{n // 2}">', f'name="l{n // 2}">{SPHERE * n}')),
    'sensors of lumped links': lambda n: robot(
        urdf_chain(n // 2, 'fixed') + f'<gazebo reference="l{n // 2}">'
        + each(n, '<sensor name="s#" type="imu"/>') + '</gazebo>'),
    'elements for Gazebo': lambda n: robot('<gazebo><plugin name="p" filename="f"/></gazebo>' * n),
    'elements for nothing': lambda n: robot(each(
        n, '<gazebo reference="none#"><light/></gazebo>')),
    'long name of a link of URDF': lambda n: robot(
        each(n, URDF_LINK.format('l0')), name='x' * 10 * n),
    'long name of a link with visuals': lambda n: {'scene.sdf': (
        f'<robot name="r"><link name="{"x" * 27 * n}">{SPHERE * n}</link></robot>')},
    # Not XML
    'no XML': lambda n: {'scene.sdf': '<<&' * 10 * n},
    'open tags': lambda n: {'scene.sdf': '<a>' * 10 * n},
    'a long tag': lambda n: {'scene.sdf': '<' + 'a' * 20 * n},
    'a tag that does not end': lambda n: {'scene.sdf': '<sdf ' + 'a="1" ' * n},
    'entities': lambda n: {
        'scene.sdf': each(n, '<!DOCTYPE sdf [|<!ENTITY e# "x">|]>') + model('')},
    'a long document type': lambda n: {
        'scene.sdf': each(n, '<!DOCTYPE sdf SYSTEM "|[[[[[[[[|">') + model('')},
    'a long declaration': lambda n: {
        'scene.sdf': each(n, '<?xml version="1.0" |encoding |?>') + model('')},
    'bytes that are not UTF-8': lambda n: {'scene.sdf': model('<x:a>' + '\udcff' * n + '</x:a>')},
}
"""Whole files, of about n parts."""

AROUND: dict[str, Callable[[str, int], Files]] = {
    'model': lambda text, _: {'scene.sdf': model(text)},
    'includes': lambda text, n: {**scene(each(n, NAMED)), 'part.sdf': model(text)},
    'merges': lambda text, n: {**scene(each(n, MERGED)), 'part.sdf': model(text)},
    'params': lambda text, n: params(each(n, UNKNOWN_ID), text),
}
"""Files around a content of a model, which is as long as they are often."""


def files_of(family: str, n: int, around: str = 'model') -> Files:
    """Return the files of a family, for a content of a model with what is around it."""
    return AROUND[around](PARTS[family](n), n) if family in PARTS else FILES[family](n)


def write(files: Files, folder: Path) -> Path:
    """Write files into a folder; return the path of the one that is loaded."""
    for path, text in files.items():
        file = folder / path
        file.parent.mkdir(exist_ok=True, parents=True)
        file.write_bytes(text.encode(errors='surrogateescape'))
    return folder / 'scene.sdf'
