# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Includes are replaced by what they include: wrong ones, missing ones, and what they override."""

import pytest
from sdf_texts import (
    assert_at,
    errors_of_file,
    fixed_joint,
    LINK,
    model_file,
    names_of,
    posed,
    TWO_LINKS,
    world_file,
    write_files,
)

from sdf_pose_bridge import load
from sdf_pose_bridge.printed_text import shortened

LEAF = """<sdf version="1.9"><model name="leaf"><pose>0 0 1 0 0 0</pose>
<link name="body"><pose>0 1 0 0 0 0</pose></link></model></sdf>"""
LIGHT = '<sdf version="1.9"><light name="lamp" type="point"><pose>9 0 0 0 0 0</pose></light></sdf>'
TWO_MODELS = ('<sdf version="1.9"><model name="a"><link name="l"/></model>'
              '<model name="b"><link name="l"/></model></sdf>')


def include(uri='leaf.sdf', content='', attributes=''):
    return f'<include {attributes}><uri>{uri}</uri>{content}</include>'


@pytest.fixture
def write(tmp_path):
    """Write a world with some content, the file ``leaf.sdf`` and others; return its path."""
    def write_world(content, **texts):
        write_files(tmp_path, **{'leaf': LEAF, **texts}, world=world_file(content))
        return tmp_path / 'world.sdf'
    return write_world


@pytest.fixture
def scene_of(write):
    return lambda content, **texts: load(write(content, **texts))


@pytest.fixture
def errors_in(write):
    return lambda content, **texts: errors_of_file(write(content, **texts))


def test_file_that_a_relative_path_finds_in_two_places_gives_one_warning(write, tmp_path):
    (tmp_path / 'models').mkdir()
    (tmp_path / 'models/leaf.sdf').write_text(LIGHT)
    scene = load(
        write(include() + include(content='<name>b</name>')), resource_paths=[tmp_path / 'models'])
    assert 'leaf' in scene.names
    (warning,) = scene.warnings
    path, other = (shortened(f'{tmp_path}/{name}leaf.sdf') for name in ('', 'models/'))
    assert warning.message == f'"leaf.sdf" is read from "{path}"; there is another one, "{other}"'


# Wrong includes

def test_first_error_of_an_included_file_names_the_way_there(tmp_path):
    write_files(
        tmp_path, main=world_file('<include><uri>outer.sdf</uri></include>'),
        outer=model_file('<link name="l"/><include><uri>inner.sdf</uri></include>'),
        inner=model_file('<link name="k"/><frame name="f" attached_to="x"/>'))
    (error,) = errors_of_file(tmp_path / 'main.sdf')
    assert error.message.endswith(
        f'(included from {tmp_path}/outer.sdf:1, included from {tmp_path}/main.sdf:1)')


@pytest.mark.parametrize(('wrong', 'code'), [
    ('<include/>', 'ATTRIBUTE_MISSING'),
    ('<include><uri> </uri></include>', 'ELEMENT_INVALID'),
    (include('none.sdf'), 'URI_LOOKUP'),
    (include('model://none'), 'URI_LOOKUP'),
    (include('.'), 'URI_LOOKUP'),
    (include(content='<name> </name>'), 'ELEMENT_INVALID'),
    (include(content='<name>world</name>'), 'RESERVED_NAME'),
    (include(content='<name>a::b</name>'), 'RESERVED_NAME'),
    (include(content='<static/>'), 'ELEMENT_INVALID'),
    (include(content='<pose>1 2</pose>'), 'ELEMENT_INVALID'),
    (include(content='<pose relative_to="zzz"/>'), 'POSE_RELATIVE_TO_INVALID'),
    (include(content='<placement_frame>body</placement_frame>'), 'MODEL_PLACEMENT_FRAME_INVALID'),
    (include(content='<pose/><placement_frame>__root__</placement_frame>'), 'RESERVED_NAME'),
    (include(content='<pose/><placement_frame>zzz</placement_frame>'), 'POSE_RELATIVE_TO_INVALID'),
    (include(attributes='merge="maybe"'), 'ATTRIBUTE_INVALID'),
    (include('light.sdf', '<static>maybe</static>'), 'ELEMENT_INVALID'),
    (include('nothing.sdf'), 'ELEMENT_MISSING'),
    (include('no_model.sdf'), 'ELEMENT_MISSING'),
    (include('two_models.sdf'), 'ELEMENT_INCORRECT_TYPE'),
])
def test_wrong_include_gives_one_error_with_its_line(errors_in, tmp_path, wrong, code):
    (error,) = errors_in(
        '\n' + wrong, light=LIGHT, nothing='<sdf version="1.9"/>', two_models=TWO_MODELS,
        no_model='<sdf version="1.9"><world name="w"/></sdf>')
    assert (error.code, error.file, error.line) == (code, str(tmp_path / 'world.sdf'), 2)


def test_uri_that_is_not_found_has_its_own_line(errors_in):
    (error,) = errors_in(include('none.sdf').replace('<uri>', '\n<uri>'))
    assert error.line == 2


OVERRIDING = include(
    'bad.sdf', '<pose>1 2 3 0 0 0</pose><static>true</static>')


@pytest.mark.parametrize(('including', 'text', 'code'), [
    *((include('bad.sdf'), text, code) for text, code in (
        ('', 'FILE_READ'),
        ('<robot name="r"/>', 'PARSING_ERROR'),
        ('<sdf version="2.0"/>', 'CONVERSION_ERROR'),
        (model_file('<pose relative_to="x"/>' + LINK), 'ATTRIBUTE_INVALID'),
        (model_file('<link name="x::l"/>'), 'RESERVED_NAME'),
        (model_file('<link name="l"><pose relative_to="x"/></link>'), 'POSE_RELATIVE_TO_INVALID'),
        (model_file(''), 'MODEL_WITHOUT_LINK'))),
    # Values that the include overrides are checked too.
    *((OVERRIDING, text, 'ELEMENT_INVALID') for text in (
        model_file(f'<pose>1 2</pose>{LINK}'), model_file(f'<static>maybe</static>{LINK}'),
        model_file(f'<pose/><pose>1 x</pose>{LINK}'),
        '<sdf version="1.9"><light name="m" type="point"><pose>1 2</pose></light></sdf>',
        model_file(LINK).replace('</sdf>', '<world name="w"><gravity>x</gravity></world></sdf>'))),
    (OVERRIDING.replace('<include', '<include merge="true"'),
     model_file('<pose>1 2</pose><frame name="f"/><static>true</static>'), 'ELEMENT_INVALID'),
])
def test_error_in_an_included_file_has_that_file(errors_in, tmp_path, including, text, code):
    (error,) = errors_in(including, bad=text)
    assert (error.code, error.file) == (code, str(tmp_path / 'bad.sdf'))


@pytest.mark.parametrize(('content', 'codes'), [
    (include(attributes='merge="maybe"') + '<frame name="f" attached_to="body"/>',
     ['ATTRIBUTE_INVALID']),
    (include('none.sdf') + '<frame name="f" attached_to="name_in_the_file::l"/>', ['URI_LOOKUP']),
    (include('none.sdf', '<name>n</name>') + '<frame name="f" attached_to="n::l"/>',
     ['URI_LOOKUP']),
    ('<model name="k">' + LINK + include('none.sdf', '<name>n</name>')
     + '</model><frame name="f" attached_to="k::n::l"/>', ['URI_LOOKUP']),
    *((include('none.sdf', '<name>n</name>') + f'<frame name="f" attached_to="{name}"/>',
       ['URI_LOOKUP', 'FRAME_ATTACHED_TO_INVALID']) for name in ('m::l', 'm::n::l')),
    (include('model://none') + '<frame name="f"><pose relative_to="none"/></frame>',
     ['URI_LOOKUP']),
    (include('none.sdf', '<name>n</name>') + posed('light', 'i', '', 'n'), ['URI_LOOKUP']),
    (include('none.sdf', attributes='merge="1"') + '<frame name="f" attached_to="any"/>',
     ['URI_LOOKUP']),
])
def test_references_into_a_wrong_include_are_not_reported(errors_in, content, codes):
    assert [error.code for error in errors_in(content)] == codes


def test_directory_without_a_manifest_is_named_in_the_message(errors_in, tmp_path):
    (tmp_path / 'box').mkdir()
    (error,) = errors_in(include('box'))
    assert error.code == 'URI_LOOKUP'
    assert 'the directory has no model.config' in error.message


def test_missing_file_that_is_included_twice_is_reported_once(errors_in):
    errors = errors_in("""
        <include><uri>none.sdf</uri><name>a</name></include>
        <include><uri>none.sdf</uri><name>b</name></include>
        <include><uri>model://b</uri><name>a</name></include>
        <include><uri>model://b</uri><name>b</name></include>""")
    assert [error.message.split(' cannot be')[0] for error in errors] == [
        '"none.sdf"', '"model://b"']


def test_error_in_a_file_that_is_included_twice_is_reported_once(errors_in):
    (error,) = errors_in(
        ''.join(include('bad.sdf', f'<name>{name}</name>') for name in 'ab'),
        bad=model_file('<link name="l"><pose>1 2</pose></link>'))
    assert error.element == '/sdf/model[@name="m"]/link[@name="l"]/pose'


def test_different_errors_in_one_line_of_an_included_file_are_reported(errors_in):
    links = """
        <link name="1 2"><pose>1 2</pose></link>
        <link name="3 4"><pose>3 4</pose></link>"""
    assert len(errors_in(include('bad.sdf'), bad=model_file(links))) == 2


# Cycles and depth

def test_cycle_of_files_is_refused(tmp_path):
    for name, other in (('a', 'b'), ('b', 'c'), ('c', 'a')):
        write_files(tmp_path, **{name: model_file(LINK + include(f'{other}.sdf'))})
    (error,) = errors_of_file(tmp_path / 'a.sdf')
    assert error.code == 'URI_LOOKUP'
    assert 'includes itself: a.sdf -> b.sdf -> c.sdf -> a.sdf' in error.message


@pytest.mark.parametrize(('uri', 'link', 'target'), [
    ('b.sdf', 'b.sdf', 'a.sdf'), ('same/a.sdf', 'same', '.')])
def test_cycle_through_a_link_of_the_file_system_is_refused(tmp_path, uri, link, target):
    write_files(tmp_path, a=model_file(LINK + include(uri)))
    (tmp_path / link).symlink_to(tmp_path / target)
    (error,) = errors_of_file(tmp_path / 'a.sdf')
    assert 'includes itself: a.sdf -> ' in error.message


def write_chain(folder, count):
    """Write files of which each includes the next; return the first."""
    for number in range(count):
        content = include(f'{number + 1}.sdf', '<name>n</name>') if number < count - 1 else ''
        write_files(folder, **{str(number): model_file(LINK + content)})
    return folder / '0.sdf'


def test_more_than_64_files_inside_one_another_are_refused(tmp_path):
    (error,) = errors_of_file(write_chain(tmp_path, 80))
    assert 'more than 64' in error.message


def test_64_files_inside_one_another_are_read(tmp_path):
    assert len(load(write_chain(tmp_path, 64)).files) == 64


# Includes elsewhere than in models and worlds

def in_link(content):
    return ('<model name="m"><link name="l"><pose>5 0 0 0 0 0</pose>' + content
            + '</link></model>')


def test_light_is_included_in_a_link(scene_of):
    scene = scene_of(in_link(include('lamp.sdf', '<pose>0 2 0 0 0 0</pose>')), lamp=LIGHT)
    assert_at(scene, 'm::l::lamp', (5, 2, 0))
    assert scene.warnings == ()


@pytest.mark.parametrize(('place', 'name'), [
    (in_link('{}'), 'm::l::leaf'), (in_link('<visual name="v"><geometry/>{}</visual>'), 'leaf')])
def test_model_that_is_included_where_none_can_be_is_left_out_with_a_warning(
    scene_of, place, name,
):
    scene = scene_of(place.format(include()))
    assert name not in scene.names
    (warning,) = scene.warnings
    assert warning.message.startswith('the included model is left out')


@pytest.mark.parametrize(('content', 'code'), [
    ('<include/>', 'ATTRIBUTE_MISSING'), (include('nothing.sdf'), 'URI_LOOKUP'),
    (include(attributes='merge="true"'), 'MERGE_INCLUDE_UNSUPPORTED'),
])
@pytest.mark.parametrize('place', [
    in_link('{}'),
    '<model name="m"><link name="l"/>' + fixed_joint('j', 'world', 'l', '{}') + '</model>'])
def test_wrong_include_in_a_link_or_a_joint_is_refused(errors_in, place, content, code):
    (error,) = errors_in(place.format(content))
    assert error.code == code


# Missing includes that are skipped

def test_missing_include_is_skipped_with_what_refers_to_it(write):
    scene = load(
        write(include('model://nothing', '<name>robot</name>') + include('model://other')
              + '<frame name="f" attached_to="robot::l"/><frame name="g" attached_to="f"/>'
              + '<model name="k"><link name="l"/></model>'),
        on_missing_include='skip')
    assert scene.names == ('world', 'k', 'k::l')
    assert [warning.code for warning in scene.warnings] == ['WARNING'] * 3
    assert scene.warnings[-1].message == (
        '"model://nothing" is missing, so elements that refer to it are left out too: "f", "g"')


@pytest.mark.parametrize(('parent', 'axis'), [
    ('robot::l', '<xyz>0 0 1</xyz>'), ('a', '<xyz expressed_in="robot">0 0 1</xyz>'),
    ('f', ''), ('a', '<xyz expressed_in="f">0 0 1</xyz>'),
    ('a', '<xyz>0 0 1</xyz><mimic joint="robot::j"/>'),
])
@pytest.mark.parametrize('name', ['<name>robot</name>', ''])
def test_joint_that_refers_to_a_missing_include_is_left_out(write, name, parent, axis):
    scene = load(
        write(f'<model name="m">{TWO_LINKS}{include("model://unnamed", name)}'
              '<frame name="f" attached_to="robot"/><link name="c"><pose relative_to="f"/>'
              + posed('visual', 'v', '', 'a') + '</link><frame name="g" attached_to="f">'
              '<pose relative_to="a"/></frame><joint name="j" type="revolute">'
              f'<parent>{parent}</parent><child>b</child><axis>{axis}</axis></joint></model>'),
        on_missing_include='skip')
    assert scene.joints == ()
    assert 'are left out too: "m::f", "m::c", "m::c::v", "m::g", "m::j"' in (
        scene.warnings[-1].message)


@pytest.mark.parametrize('frame', ['near', 'robot::l'])
def test_model_that_a_frame_of_a_missing_include_places_is_left_out(write, frame):
    scene = load(
        write(f'<model name="m" placement_frame="{frame}"><link name="l"/>'
              + include('model://nothing', '<name>robot</name>')
              + '<frame name="near"><pose relative_to="robot::l"/></frame></model>'),
        on_missing_include='skip')
    assert scene.names == ('world',)


def test_uri_that_is_missing_twice_gives_one_warning(write):
    scene = load(
        write(''.join(include('model://a', f'<name>{name}</name>') for name in 'xy')),
        on_missing_include='skip')
    assert len(scene.warnings) == 1


@pytest.mark.parametrize('text', [model_file('<link name="l"><pose>1 2</pose></link>'), '<sdf/>'])
def test_error_in_an_included_file_is_not_skipped(write, text):
    errors_of_file(write(include('bad.sdf'), bad=text), on_missing_include='skip')


def test_model_of_missing_includes_alone_is_read(write):
    path = write('<model name="m">' + include('model://a') + '</model>')
    assert load(path, on_missing_include='skip').names == ('world', 'm')


# What is included

def test_included_elements_stand_in_the_place_of_the_include(scene_of):
    scene = scene_of('<frame name="f"/><model name="m">' + include() + '</model>' + include())
    assert names_of(scene) == [
        'f', 'm', 'm::leaf', 'm::leaf::body', 'leaf', 'leaf::body']


@pytest.mark.parametrize('tag', ['light', 'actor'])
def test_light_or_actor_is_included_into_a_world(scene_of, tag):
    text = f'<sdf version="1.9">{posed(tag, "x", "1 0 0 0 0 0")}</sdf>'
    scene = scene_of(include('x.sdf', '<name>y</name><pose>0 2 0 0 0 0</pose>'), x=text)
    assert_at(scene, 'y', (0, 2, 0))


@pytest.mark.parametrize('tag', ['light', 'actor'])
def test_light_or_actor_is_not_included_into_a_model(scene_of, tag):
    text = f'<sdf version="1.9">{posed(tag, "x", "")}</sdf>'
    scene = scene_of(f'<model name="m">{LINK}{include("x.sdf")}</model>', x=text)
    assert names_of(scene) == ['m', 'm::l']
    assert f'the included {tag} is left out' in scene.warnings[0].message


def test_included_file_of_an_old_version_is_converted(scene_of):
    old = model_file(LINK + '<link name="k"><pose frame="l">1 0 0 0 0 0</pose></link>')
    scene = scene_of(include('old.sdf'), old=old.replace('1.9', '1.6'))
    assert_at(scene, 'm::k', (1, 0, 0))


@pytest.mark.parametrize('element', [
    '<plugin name="p" filename="f">{}</plugin>', '<x:y>{}</x:y>', '<unknown>{}</unknown>',
    '<sdf version="1.9">{}</sdf>', '<sdf version="1.9"><model name="m">{}</model></sdf>',
])
def test_include_in_an_element_that_is_not_read_is_not_read(scene_of, element):
    scene = scene_of(include() + element.format(include('none.sdf')))
    assert names_of(scene) == ['leaf', 'leaf::body']


def test_include_in_an_included_file_is_replaced(scene_of):
    middle = model_file(include(content='<pose>1 0 0 0 0 0</pose>'))
    scene = scene_of(include('middle.sdf', '<pose>0 0 5 0 0 0</pose>'), middle=middle)
    assert_at(scene, 'm::leaf::body', (1, 1, 5))


@pytest.mark.parametrize('text', [
    model_file(LINK).replace('name="m"', 'name="__m__"'),
    model_file(LINK).replace('name="m"', 'name="m" placement_frame="none"'),
])
def test_name_or_reference_that_an_include_overrides_is_not_checked(scene_of, text):
    overrides = '<name>n</name><pose/><placement_frame>l</placement_frame>'
    assert names_of(scene_of(include('m.sdf', overrides), m=text)) == ['n', 'n::l']


# What an include overrides

DESK = '<frame name="desk"><pose>0 0 5 0 0 0</pose></frame>'
TURNED = LEAF.replace('<pose>0 0 1 0 0 0', '<pose degrees="true">0 0 1 0 0 180')
PLACED = LEAF.replace('name="leaf"', 'name="leaf" placement_frame="body"')
OVERRIDES = {
    'nothing': ('', LEAF, {'leaf::body': (0, 1, 1)}),
    'the name': ('<name>n</name>', LEAF, {'n::body': (0, 1, 1)}),
    'the pose': ('<pose relative_to="desk">1 0 0 0 0 0</pose>', LEAF, {'leaf': (1, 0, 5)}),
    'an empty pose': ('<pose/>', LEAF, {'leaf': (0, 0, 0)}),
    'attributes of the pose': (
        '<pose>0 0 0 0 0 3.141592653589793</pose>', TURNED, {'leaf': (0, 0, 0, 0, 0, 1, 0)}),
    'the placement frame': (
        '<pose>0 0 5 0 0 0</pose><placement_frame>body</placement_frame>', LEAF,
        {'leaf::body': (0, 0, 5), 'leaf': (0, -1, 5)}),
    'the pose, not the placement frame': (
        '<pose>0 0 5 0 0 0</pose>', PLACED, {'leaf::body': (0, 0, 5)}),
}


@pytest.mark.parametrize(
    ('content', 'leaf', 'expected'), OVERRIDES.values(), ids=OVERRIDES)
def test_include_overrides(scene_of, content, leaf, expected):
    scene = scene_of(DESK + include(content=content), leaf=leaf)
    for name, pose in expected.items():
        assert_at(scene, name, pose)


@pytest.mark.parametrize(('written', 'override', 'is_static'), [
    ('false', 'true', True), ('true', 'false', False)])
def test_include_is_static(scene_of, written, override, is_static):
    scene = scene_of(
        include(content=f'<static>{override}</static>'),
        leaf=model_file(f'<static>{written}</static>{LINK}'))
    assert bool(scene.static_models) == is_static


def test_file_that_is_included_twice_has_independent_copies(scene_of):
    scene = scene_of(
        include(content='<name>a</name><static>1</static><pose>1 0 0 0 0 0</pose>')
        + include(content='<name>b</name>'))
    assert_at(scene, 'a::body', (1, 1, 0))
    assert_at(scene, 'b::body', (0, 1, 1))
    assert scene.static_models == {scene.index('a')}


# A file with an include at its top

@pytest.mark.parametrize(('content', 'code'), [
    (include('none.sdf'), 'URI_LOOKUP'),
    (include(attributes='merge="true"'), 'MERGE_INCLUDE_UNSUPPORTED'),
    (include() + include(content='<name>b</name>'), 'ELEMENT_INCORRECT_TYPE'),
])
def test_wrong_include_at_the_top_is_refused(errors_in, content, code):
    errors = errors_in(include('outer.sdf'), outer=f'<sdf version="1.9">{content}</sdf>')
    assert [error.code for error in errors] == [code]


def test_include_at_the_top_is_placed_in_the_including_file(scene_of):
    content = include(content='<pose relative_to="desk">1 0 0 0 0 0</pose>')
    scene = scene_of(
        posed('frame', 'desk', '0 0 50 0 0 0') + include('outer.sdf'),
        outer=f'<sdf version="1.9">{content}</sdf>')
    assert_at(scene, 'leaf', (1, 0, 50))


@pytest.mark.parametrize('pose', ['', '<pose>1 0 0 0 0 0</pose>'])
def test_names_in_an_old_file_are_judged_by_its_version(tmp_path, pose):
    leaf = model_file(TWO_LINKS + fixed_joint('a', 'a', 'b'), version='1.6')
    main = world_file(f'<include><uri>leaf.sdf</uri>{pose}</include>')
    write_files(tmp_path, leaf=leaf, main=main)
    assert 'm::a_joint' in load(tmp_path / 'main.sdf').names
