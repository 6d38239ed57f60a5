# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Files that grow: for each construct that can be repeated or nested, a row of a table.

``PARTS`` are contents of a model, of about n parts each; ``FILES`` are whole files.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from sdf_texts import LINK, model_file, world_file
import urdf_texts as urdf

Files = Mapping[str, str]
"""Texts by path; ``scene.sdf`` is loaded, and ``fuel`` is the cache of Gazebo Fuel."""


def each(n, text):
    """
    Return a text in which the part between two bars, or all of it, is there n times.

    Each time, ``#`` stands for its number and ``+`` for the next one.
    """
    begin, part, end = text.split('|') if '|' in text else ('', text, '')
    return begin + ''.join(
        part.replace('#', str(i)).replace('+', str(i + 1)) for i in range(n)) + end


def nested(n, begin, inside, end='</model>'):
    """Return a text in up to 200 others, each with its depth for ``#``."""
    return each(min(n, 200), begin) + inside + end * min(n, 200)


def model(text, attributes='', version='1.9'):
    """Return a file of one model, which has a link."""
    return model_file(f'<link name="base"/>{text}', attributes=attributes, version=version)


def include(text='', attributes='', uri='part.sdf'):
    """Return an include."""
    return f'<include {attributes}><uri>{uri}</uri>{text}</include>'


def params(text):
    """Return an include with parameters."""
    return include(f'<experimental:params>{text}</experimental:params>')


def robot(text):
    """Return a robot in URDF, whose root is ``l0``."""
    return urdf.robot(urdf.link('l0') + text)


def file_from_text(n, text):
    """Return the file that is loaded."""
    return {'scene.sdf': each(n, text)}


def included_files(n, world, part):
    """Return a world that includes a model, with their contents."""
    return {'scene.sdf': world_file(each(n, world)), 'part.sdf': model(each(n, part))}


def fuel(n, what='models'):
    """Return n models, or versions of one model, in the cache of Fuel."""
    folder = 'fuel/fuel.gazebosim.org/owner/models'
    paths = [f'{folder}/m{i}/1' if what == 'models' else f'{folder}/m0/{i + 1}' for i in range(n)]
    config = '<model><sdf version="1.9">model.sdf</sdf></model>'
    return {f'{path}/{name}': text for path in paths
            for name, text in (('model.config', config), ('model.sdf', model('')))}


def deep_placements(n):
    """Return models in one another, each placed by the end of one chain of frames."""
    text, path = each(n, REPEATED['attachments in a row']), f'a{n}'
    for _ in range(min(n, 200)):
        text = f'<model name="pd" placement_frame="{path}">{LINK}{text}</model>'
        path = f'pd::{path}'
    return text


POSE = '<pose>1 2 3 0.1 0.2 0.3</pose>'
MERGE = 'merge="true"'
NAMED = include('<name>m#</name>')
MERGED = f'<model name="m#">{include("<name>n#</name>", MERGE)}</model>'
BOX = '<geometry><box><size>1 1 1</size></box></geometry>'
AUTO = '<inertial auto="true"/>'
SPHERE = urdf.shape('visual')
JOINT = ('<joint name="j{}" type="revolute"><parent>{}</parent><child>{}</child>{}</joint>')
MIMIC = '<axis><mimic joint="jq#"/></axis>'
URDF_CHAIN = urdf.link('l+') + urdf.joint('j#', 'l#', 'l+', 'fixed', urdf.origin('0 0 1'))
URDF_LINK = urdf.link('s#') + urdf.joint('j#', '{}', 's#')
MOVING_CHAIN = URDF_CHAIN.replace('fixed', 'continuous')
FLAG = '<use_parent_model_frame>1</use_parent_model_frame>'
UNKNOWN_IDS = params('|<link element_id="none#" action="remove"/>|')
MISSING = include(uri='none.sdf')
NAMED_MISSING = include('<name>a0</name>', uri='none.sdf')
SCOPES = 'a::' * 240
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
    'references with their own model': '<frame name="o#" attached_to="m::base"/>',
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
    'equal errors in deep models': lambda n: nested(
        n, DEEP, f'<link name="x">{"<visual/>" * n}</link>'),
    'equal errors in elements of deep models': lambda n: nested(
        n, DEEP, '<link><visual/></link>' * n),
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

TEXTS = {
    'worlds': '<sdf version="1.10">|<world name="w#"/>|</sdf>',
    'models at the top': '<sdf version="1.10">|<model name="m#"/>|</sdf>',
    'links of an actor': world_file(f'<actor name="a">|{LINK}|</actor>'),
    'joints of a world': world_file(
        f'|<model name="m#">{LINK}</model>{JOINT.format("#", "world", "m#", "")}|'),
    'elements behind the outermost one': f'{model("")}|<a/>|</a>',
    # Old versions
    'old poses': model(
        '|<link name="l#"><pose frame="l0">0 0 0 0 0 0</pose></link>|', version='1.4'),
    'old axes': model('<joint name="j">|<axis/>|</joint>', version='1.4'),
    'flags of an old axis': model(
        f'<joint name="j"><axis>|{FLAG}|</axis></joint>', version='1.6'),
    'names that are renamed': model(
        '|<link name="r"/><frame name="r"/><joint name="r_frame#"/>|', version='1.6'),
    'old name of many scopes': world_file(
        f'<model name="m"><link name="{SCOPES}l">|<a/>|</link></model>', version='1.7'),
    'scopes of an old name': world_file(
        '<model name="m"><link name="|a::|l"/></model>', version='1.7'),
    'references in an old name of many scopes': world_file(
        f'<model name="m"><link name="{SCOPES}l">|<a relative_to="world"/>|</link></model>',
        version='1.7'),
    # Missing includes
    'missing includes': world_file(f'|{MISSING.replace("none", "none#")}|'),
    'one missing include': world_file(f'|{MISSING}|'),
    'attachments to a missing include': world_file(
        f'{NAMED_MISSING}|<frame name="a+" attached_to="a#"/>|'),
    'scopes of a reference into a missing include': world_file(
        f'{NAMED_MISSING}<frame name="f" attached_to="a0::|a::|b"/>'),
    'includes in a cycle': model(f'|{include(uri="scene.sdf")}|'),
    # URDF
    'fixed joints of URDF in a row': robot(f'|{URDF_CHAIN}|'),
    'moving joints of URDF in a row': robot(f'|{MOVING_CHAIN}|'),
    'mimics of URDF': robot(
        f'|{MOVING_CHAIN}|'.replace('</joint>', '<mimic joint="j0"/></joint>')),
    'links of URDF at one link': robot(f'|{URDF_LINK.format("l0")}|'),
    'errors in URDF': robot('|<joint name="j#" type="x"/>|'),
    'digits before a letter in URDF': robot('<origin xyz="|1111111111|x 0 0"/>'),
    'cycles of URDF': robot(f'|{URDF_LINK.format("s+")}|'),
    'elements for Gazebo': robot('|<gazebo><plugin name="p" filename="f"/></gazebo>|'),
    'elements for nothing': robot('|<gazebo reference="none#"><light/></gazebo>|'),
    # Not XML
    'no XML': '<<&<<&<<&<<&<<&<<&<<&<<&<<&<<&',
    'open tags': '<a><a><a><a><a><a><a><a><a><a>',
    'a long tag': '<|aaaaaaaaaaaaaaaaaaaa|',
    'a tag that does not end': '<sdf |a="1" |',
    'entities': f'<!DOCTYPE sdf [|<!ENTITY e# "x">|]>{model("")}',
    'a long document type': f'<!DOCTYPE sdf SYSTEM "|[[[[[[[[|">{model("")}',
    'a long declaration': f'<?xml version="1.0" |encoding |?>{model("")}',
    'bytes that are not UTF-8': model('<x:a>|\udcff|</x:a>'),
}
"""Texts of a file that is loaded, with bars as in ``REPEATED``."""

INCLUDED = {
    'includes': (NAMED, ''),
    'merges': (MERGED.replace('n#', 'n'), ''),
    'merges with names': (MERGED, ''),
    'merges with poses': (MERGED.replace('<uri>', '<pose># 0 0 0 0 0</pose><uri>'), ''),
    'merges into one model': (
        f'<model name="m">|{include("<name>n#</name>", MERGE)}|</model>', ''),
    'text behind a pose of a merged model': (
        f'<model name="m">|{include("<name>n#</name>", MERGE)}|</model>', f'{POSE}|text |'),
    'params for one link': (params('|<link element_id="base" action="modify"/>|'), ''),
    'params for many links': (
        params(f'|<link element_id="p#" action="modify">{POSE}</link>|'),
        REPEATED['links with poses']),
    'params that add': (params('|<link element_id="" name="n#" action="add"/>|'), ''),
    'params that remove': (
        params('|<link element_id="l#" action="remove"/>|'), REPEATED['links']),
    'params that replace': (
        params('|<link element_id="l#" name="k#" action="replace"/>|'), REPEATED['links']),
    'params with unknown ids': (UNKNOWN_IDS, REPEATED['links']),
    'params for children': (
        params('<link element_id="vi">|<visual name="v#" action="remove"/>|</link>'),
        REPEATED['visuals']),
    'params that modify children': (
        params('<link element_id="vi">|<visual name="v#" action="modify">'
               f'{POSE}</visual>|</link>'),
        f'<link name="vi">|<visual name="v#">{POSE}</visual>|</link>'),
    'params for one link of many children': (
        params('|<link element_id="vi" name="vi" action="modify"/>|'), REPEATED['visuals']),
    'params with attributes': (
        params('<link element_id="vi" action="modify"| a#="1"|/>'), REPEATED['visuals']),
}
"""Contents of a world, with bars as in ``REPEATED``, and of the model ``part.sdf``."""

FILES: dict[str, Callable[[int], Files]] = {
    **{name: partial(file_from_text, text=text) for name, text in TEXTS.items()},
    **{name: partial(included_files, world=world, part=part)
       for name, (world, part) in INCLUDED.items()},
    'scopes of an old name with many elements': lambda n: file_from_text(min(n, 240), world_file(
        f'<model name="m"><link name="|a::|l">{"<a/>" * 9000}</link></model>', version='1.7')),
    'includes without a URI in deep models': lambda n: {'scene.sdf': world_file(
        nested(200, DEEP, '<link name="l"><include/></link>' * n))},
    'includes of many files': lambda n: {
        'scene.sdf': world_file(each(n // 4, include('<name>m#</name>', uri='p#.sdf'))),
        **{f'p{number}.sdf': model('') for number in range(n // 4)}},
    'includes of a directory': lambda n: {
        'scene.sdf': world_file(each(n, include('<name>m#</name>', uri='part'))),
        'part/model.sdf': model(''),
        'part/model.config': each(n, '<model>|<sdf version="1.9">model.sdf</sdf>|</model>')},
    'missing includes beside many files': lambda n: {
        **FILES['missing includes'](n), **{f'f{i}.txt': '' for i in range(n)}},
    'references into missing includes': lambda n: {'scene.sdf': model(
        NAMED_MISSING + each(n // 40, f'<frame name="f#" attached_to="{SCOPES}x"/>'))},
    'includes of a file with many tops': lambda n: {
        'scene.sdf': world_file(include() * (n // 2)),
        'part.sdf': each(n // 2, '<sdf version="1.9">|<model name="m#"/>|</sdf>')},
    'includes in one another': lambda n: {
        **{f'p{i}.sdf': model(include(uri=f'p{i + 1}.sdf')) for i in range(60)},
        'p60.sdf': model(each(n, '<link name="l#"/>')), 'scene.sdf': model(include(uri='p0.sdf'))},
    'includes that double': lambda n: {
        **{f'p{i}.sdf': model(each(2, include('<name>m#</name>', uri=f'p{i + 1}.sdf')))
           for i in range(n.bit_length())},
        f'p{n.bit_length()}.sdf': model(''), 'scene.sdf': model(include(uri='p0.sdf'))},
    'name spaces of an included model': lambda n: {
        'scene.sdf': world_file(each(20, NAMED)),
        'part.sdf': model(each(n, '<p#:x/>'), each(n, ' xmlns:p#="u"'))},
    'equal errors of an included deep model': lambda n: {
        'scene.sdf': world_file(NAMED),
        'part.sdf': model(PARTS['equal errors in deep models'](n))},
    'equal errors below a long name': lambda n: {'scene.sdf': model(
        f'<model name="{"x" * 10 * n}"><link name="l">{"<visual/>" * n}</link></model>')},
    'text behind an included model': lambda n: {
        **FILES['includes'](n),
        'part.sdf': each(n, model('').replace('</sdf>', '|text |</sdf>'))},
    'params that add includes': lambda n: {
        **included_files(n, params(
            f'|<model element_id="" name="n#" action="add">{include(uri="other.sdf")}</model>|'),
            ''),
        'other.sdf': model('')},
    'params for deep elements': lambda n: {
        **included_files(n // 50, params(f'|<link element_id="{PATH}::l" action="modify"/>|'), ''),
        'part.sdf': model(nested(200, DEEP, ''))},
    'includes of a broken file': lambda n: {
        'scene.sdf': world_file(include() * n), 'part.sdf': '<sdf'},
    # Gazebo Fuel
    'models of Fuel': lambda n: {
        'scene.sdf': world_file(each(n // 3, include('<name>m#</name>', uri=FUEL))),
        **fuel(n // 3)},
    'versions of a model of Fuel': lambda n: {
        'scene.sdf': world_file(each(n, include('<name>m#</name>', uri=FUEL.replace('#', '0')))),
        **fuel(n // 5, 'versions')},
    'missing models of Fuel': lambda n: {
        'scene.sdf': world_file(each(n, include('<name>m#</name>', uri=FUEL.replace('#', 'x#')))),
        **fuel(n // 5)},
    # URDF
    'visuals of lumped links': lambda n: {'scene.sdf': robot(each(n // 2, URDF_CHAIN).replace(
        f'name="l{n // 2}">', f'name="l{n // 2}">{SPHERE * n}'))},
    'sensors of lumped links': lambda n: {'scene.sdf': robot(
        each(n // 2, URDF_CHAIN)
        + urdf.gazebo(each(n, '<sensor name="s#" type="imu"/>'), f'l{n // 2}'))},
    'long name of a link of URDF': lambda n: {'scene.sdf': robot(
        each(n, URDF_LINK.format('l0'))).replace('"l0"', f'"{"x" * 10 * n}"')},
    'long name of a link with visuals': lambda n: {'scene.sdf': urdf.robot(
        f'<link name="{"x" * 27 * n}">{SPHERE * n}</link>')},
}
"""Whole files, of about n parts."""

AROUND = {'model': '', 'includes': NAMED, 'merges': MERGED, 'params': UNKNOWN_IDS}
"""What includes the content of a model, n times; nothing where it is loaded itself."""


def files_of(family, n, around='model'):
    """Return the files of a family, for a content of a model with what is around it."""
    if family in FILES:
        return FILES[family](n)
    files = included_files(n, AROUND[around], '') if AROUND[around] else {}
    return {**files, 'part.sdf' if files else 'scene.sdf': model(PARTS[family](n))}


def write(files, folder):
    """Write files into a folder; return the path of the one that is loaded."""
    for path, text in files.items():
        file = folder / path
        file.parent.mkdir(exist_ok=True, parents=True)
        file.write_bytes(text.encode(errors='surrogateescape'))
    return folder / 'scene.sdf'
