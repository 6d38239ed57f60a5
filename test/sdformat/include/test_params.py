# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of includes: wrong ones are refused, others change the included model."""

import pytest
from sdf_texts import assert_at, errors_of_file, model_file, names_of, only_error, write_files

import sdf_pose_bridge
from sdf_pose_bridge.sdformat.limits import DEFAULT_LIMITS

BOX = '<geometry><box><size>1 1 1</size></box></geometry>'
ARM = f"""<sdf version="1.9"><model name="arm">
<link name="base"><pose>1 0 0 0 0 0</pose>
<visual name="shape">{BOX}</visual><collision name="shape">{BOX}</collision>
<sensor name="eye" type="camera"><pose>0 0 1 0 0 0</pose></sensor></link>
<link name="h"/>
<frame name="grip" attached_to="base"><pose>0 2 0 0 0 0</pose></frame>
<joint name="hinge" type="fixed"><parent>base</parent><child>h</child></joint>
<include><uri>tool.sdf</uri><name>tool</name><pose relative_to="grip">0 0 3 0 0 0</pose></include>
</model></sdf>"""
TOOL = """<sdf version="1.9"><model name="gripper"><link name="palm"/>
<frame name="tip"><pose>0 0 4 0 0 0</pose></frame></model></sdf>"""


@pytest.fixture
def write(tmp_path):
    """Write a world that includes the arm with parameters, which begin in line 3."""
    def write_files(params, content='', *, attributes='', **others):
        text = (f'<sdf version="1.10"><world name="w">\n<include {attributes}><uri>arm.sdf</uri>'
                f'{content}<experimental:params>\n{params}</experimental:params></include>'
                '</world></sdf>')
        for name, file in {'arm': ARM, 'tool': TOOL, 'main': text, **others}.items():
            (tmp_path / f'{name}.sdf').write_text(file)
        return tmp_path / 'main.sdf'
    return write_files


@pytest.fixture
def load(write, tmp_path):
    def load_files(*texts, limits=DEFAULT_LIMITS, **others):
        return sdf_pose_bridge.load(
            write(*texts, **others), resource_paths=[tmp_path], limits=limits)
    return load_files


@pytest.fixture
def errors(write, tmp_path):
    return lambda *texts, **others: errors_of_file(
        write(*texts, **others), resource_paths=[tmp_path])


# Wrong parameters

@pytest.mark.parametrize(('params', 'code'), [
    ('<link/>', 'ATTRIBUTE_MISSING'),
    ('<link element_id="base::" action="remove"/>', 'ATTRIBUTE_INVALID'),
    ('<link element_id="base" action="change"/>', 'ATTRIBUTE_INVALID'),
    ('<link element_id="base" action=""/>', 'ATTRIBUTE_INVALID'),
    ('<link element_id="none" action="remove"/>', 'ELEMENT_MISSING'),
    ('<visual element_id="base" action="remove"/>', 'ELEMENT_MISSING'),
    ('<frame element_id="" action="add"/>', 'ATTRIBUTE_MISSING'),
    ('<frame element_id="" name="" action="add"/>', 'ATTRIBUTE_INVALID'),
    ('<frame element_id="none" name="f" action="add"/>', 'ELEMENT_MISSING'),
    (f'<visual element_id="base" name="shape" action="add">{BOX}</visual>', 'DUPLICATE_NAME'),
    ('<frame element_id="" name="grip" action="add"/>', 'DUPLICATE_NAME'),
    ('<thing element_id="base" name="t" action="add"/>', 'ELEMENT_INVALID'),
    ('<joint element_id="" name="j" action="add"><parent>base</parent><child>h</child></joint>',
     'ATTRIBUTE_MISSING'),
    ('<frame element_id="grip" action="replace"/>', 'ATTRIBUTE_MISSING'),
    ('<link element_id="base" action="modify" color="red"/>', 'ATTRIBUTE_INVALID'),
    ('<link element_id="base" action="modify"><inertial/></link>', 'ELEMENT_MISSING'),
    ('<link element_id="base" action="modify"><pose>1 2</pose></link>', 'ELEMENT_INVALID'),
    ('<link element_id="base" action="remove"><inertial/></link>', 'ELEMENT_MISSING'),
    ('<frame element_id="grip" action="modify" attached_to="none"/>', 'FRAME_ATTACHED_TO_INVALID'),
    ('<joint element_id="hinge" action="modify"><child/></joint>', 'JOINT_CHILD_LINK_INVALID'),
    ('<link element_id="" name="a::b" action="add"/>', 'RESERVED_NAME'),
    *((f'<link element_id="base">\n{child}</link>', code) for child, code in (
        ('<pose>0 0 0 0 0 0</pose>', 'ATTRIBUTE_MISSING'),
        ('<pose action="change"/>', 'ATTRIBUTE_INVALID'),
        ('<inertial action="remove"/>', 'ELEMENT_MISSING'),
        ('<visual name="none" action="remove"/>', 'ELEMENT_MISSING'),
        ('<visual action="replace"/>', 'ATTRIBUTE_MISSING'),
        ('<joint name="j" action="add"/>', 'ELEMENT_INVALID'),
        ('<custom:thing action="add"/>', 'ELEMENT_INVALID'),
        ('<sensor name="s" action="add"/>', 'ATTRIBUTE_MISSING'),
        ('<pose action="modify">1 2</pose>', 'ELEMENT_INVALID'),
        ('<pose action="modify" degrees="true" rotation_format="quat_xyzw">0 0 0 0 0 0 1</pose>',
         'ELEMENT_INVALID'))),
])
def test_wrong_parameter_of_an_element_or_its_child_gives_one_error(errors, params, code):
    (error,) = errors(params)
    assert (error.code, error.line) == (code, 3 + params.count('\n'))
    assert error.file.endswith('main.sdf')


def test_error_has_the_element_of_the_parameters(errors):
    (error,) = errors('<link element_id="none" action="remove"/>')
    assert error.element == (
        '/sdf/world[@name="w"]/include/experimental:params/link[@element_id="none"]')


def test_error_elsewhere_has_the_name_of_its_element():
    error = only_error(model_file('<link name="l" element_id="x"><pose>1</pose></link>'))
    assert error.element == '/sdf/model[@name="m"]/link[@name="l"]/pose'
    error = only_error(model_file('<link name="l"><gravity element_id="x">1 2</gravity></link>'))
    assert error.element == '/sdf/model[@name="m"]/link[@name="l"]/gravity'


def test_all_errors_are_reported(errors):
    params = '<link/><link element_id="none" action="remove"/><link element_id="base" action="x"/>'
    assert [error.code for error in errors(params)] == [
        'ATTRIBUTE_MISSING', 'ELEMENT_MISSING', 'ATTRIBUTE_INVALID']


def test_error_in_the_included_file_has_its_place(errors):
    # A frame is attached to the link that is removed.
    error = errors('<link element_id="base" action="remove"/>')[0]
    assert (error.file.endswith('arm.sdf'), error.line) == (True, 6)


def test_error_in_the_parameters_of_an_included_file_has_its_place(errors):
    arm = ARM.replace('<name>tool</name>', (
        '<name>tool</name><experimental:params><link element_id="none" action="remove"/>'
        '</experimental:params>'))
    (error,) = errors('<link element_id="base"><pose action="modify"/></link>', arm=arm)
    assert error.code == 'ELEMENT_MISSING'
    assert (error.file.endswith('arm.sdf'), error.line) == (True, 8)


def test_what_is_in_an_added_element_has_its_place(load):
    scene = load(
        f'<link element_id="" name="k" action="add">\n<visual name="v">{BOX}</visual></link>')
    place = scene.place(scene.index('arm::k::v'))
    assert (place.file.endswith('main.sdf'), place.line) == (True, 4)


# What parameters change

@pytest.mark.parametrize(('params', 'name', 'pose'), [
    ('<link element_id="base" action="modify"><pose>5 0 0 0 0 0</pose></link>', 'base', (5, 0, 0)),
    ('<link element_id="base"><pose action="modify">5 0 0 0 0 0</pose></link>', 'base', (5, 0, 0)),
    ('<link element_id="base"><pose action="replace">5 0 0 0 0 0</pose></link>', 'base',
     (5, 0, 0)),
    ('<link element_id="base"><pose action="remove"/></link>', 'base', (0, 0, 0)),
    ('<link element_id="base"><pose action="add">5 0 0 0 0 0</pose></link>', 'base', (1, 0, 0)),
    ('<link element_id="base" action="modify"><pose/></link>', 'base', (0, 0, 0)),
    ('<frame element_id="grip" action="modify" attached_to="h"/>', 'grip', (0, 2, 0)),
    ('<frame element_id="grip" action="modify"><pose relative_to="h">0 0 7 0 0 0</pose></frame>',
     'grip', (0, 0, 7)),
    (('<frame element_id="grip" name="g2" action="replace"/><model element_id="tool">'
      '<pose action="modify" relative_to="g2">0 0 1 0 0 0</pose></model>'), 'tool', (0, 0, 1)),
    ('<frame element_id="" name="f" action="add"><pose relative_to="grip"/></frame>', 'f',
     (1, 2, 0)),
    ('<frame element_id="tool" name="f" attached_to="tip" action="add"/>', 'tool::f', (1, 2, 7)),
    ('<visual element_id="h" name="v" action="add"/>', 'h::v', (0, 0, 0)),
    ('<sensor element_id="base::eye"><pose action="modify">0 0 9 0 0 0</pose></sensor>',
     'base::eye', (1, 0, 9)),
    (('<link element_id="base" action="modify"><sensor name="eye"><pose>0 0 9 0 0 0</pose>'
      '</sensor></link>'), 'base::eye', (1, 0, 9)),
    ('<frame element_id="tool::tip" action="modify"><pose>0 0 9 0 0 0</pose></frame>',
     'tool::tip', (1, 2, 12)),
    ('<model element_id="tool"><pose action="modify">0 0 5 0 0 0</pose></model>', 'tool',
     (1, 2, 5)),
    ('<model element_id="tool" action="modify" placement_frame="tip"/>', 'tool', (1, 2, -1)),
    ('<model element_id="tool" name="tool" action="replace"><link name="l"/></model>', 'tool::l',
     (0, 0, 0)),
    # Numbers are in the unit that is given with them.
    ('<link element_id="base"><pose action="modify" degrees="true">0 0 0 0 0 180</pose></link>',
     'base', (0, 0, 0, 0, 0, 1, 0)),
    # An include in an added model is replaced.
    (('<model element_id="" name="second" action="add"><include><uri>tool.sdf</uri></include>'
      '</model>'), 'second::gripper::tip', (0, 0, 4)),
])
def test_parameter_changes_a_pose(load, params, name, pose):
    assert_at(load(params), f'arm::{name}', pose)


@pytest.mark.parametrize(('params', 'gone'), [
    ('<frame element_id="tool::tip" action="remove"/>', 'arm::tool::tip'),
    ('<model element_id="tool" action="remove"/>', 'arm::tool::palm'),
    ('<visual element_id="base::shape" action="remove"/>', 'arm::base::shape'),
    ('<link element_id="base" action="remove"><sensor name="eye"/></link>', 'arm::base::eye'),
    ('<joint element_id="hinge" name="wrist" action="modify"/>', 'arm::hinge'),
])
def test_parameter_removes_an_element(load, params, gone):
    before, after = names_of(load('')), names_of(load(params))
    assert before.count(gone) - after.count(gone) == 1


def test_attribute_of_an_added_element_that_is_not_defined_is_left_out(load):
    scene = load('<frame element_id="" name="f" action="add" color="red"/>')
    assert 'arm::f' in names_of(scene)
    assert scene.warnings == ()


def test_required_value_that_a_parameter_empties_has_its_default(load):
    arm = ARM.replace('<link name="base">', (
        '<link name="base"><collision name="c"><geometry><box><size>2 2 2</size></box></geometry>'
        '</collision>'))
    assert arm != ARM
    scene = load('<collision element_id="base::c"><geometry action="modify"><box><size/></box>'
                 '</geometry></collision>', arm=arm)
    assert 'arm::base::c' in names_of(scene)


def test_include_that_is_added_by_itself_includes_nothing(load):
    scene = load('<model element_id="tool"><include action="add"><uri>tool.sdf</uri></include>'
                 '</model>')
    assert 'arm::tool::gripper' not in names_of(scene)
    assert len(scene.warnings) == 1


def test_include_with_parameters_has_a_name_and_a_pose(load):
    scene = load('<frame element_id="grip" action="modify"><pose>0 0 1 0 0 0</pose></frame>',
                 '<name>left</name><pose>0 0 100 0 0 0</pose>')
    assert_at(scene, 'left::grip', (1, 0, 101))


def test_parameters_do_not_change_another_include_of_the_file(load):
    pair = ('<sdf version="1.9"><model name="pair"><include><uri>arm.sdf</uri><name>a</name>'
            '<experimental:params><frame element_id="grip"><pose action="remove"/></frame>'
            '</experimental:params></include><include><uri>arm.sdf</uri><name>b</name></include>'
            '</model></sdf>')
    scene = load('', main=pair)
    assert_at(scene, 'pair::a::grip', (1, 0, 0))
    assert_at(scene, 'pair::b::grip', (1, 2, 0))


def test_merged_elements_of_the_included_file_can_be_changed(load):
    arm = ARM.replace('<include>', '<include merge="true">')
    scene = load('<frame element_id="tip"><pose action="modify">0 0 9 0 0 0</pose></frame>'
                 '<link element_id="palm"><pose action="modify">0 5 0 0 0 0</pose></link>',
                 arm=arm)
    assert_at(scene, 'arm::tip', (1, 2, 12))
    assert_at(scene, 'arm::palm', (1, 7, 3))


def test_include_that_merges_can_have_parameters(load):
    rig = ('<sdf version="1.9"><model name="rig"><include merge="true"><uri>arm.sdf</uri>'
           '<pose>10 0 0 0 0 0</pose><experimental:params><frame element_id="grip">'
           '<pose action="remove"/></frame></experimental:params></include></model></sdf>')
    scene = load('', main=rig)
    assert_at(scene, 'rig::grip', (11, 0, 0))


def test_parameters_can_change_what_parameters_added(load):
    arm = ARM.replace('<name>tool</name>', (
        '<name>tool</name><experimental:params><frame element_id="" name="deep" action="add"/>'
        '</experimental:params>'))
    scene = load('<frame element_id="tool::deep" action="modify" attached_to="tip"/>', arm=arm)
    assert_at(scene, 'arm::tool::deep', (1, 2, 7))


def test_prefix_of_parameters_can_be_declared(write, tmp_path):
    path = write('<frame element_id="grip" action="remove"/><model element_id="tool"><pose '
                 'action="replace"/></model>')
    path.write_text(path.read_text().replace(
        '<sdf ', '<sdf xmlns:experimental="http://sdformat.org/schemas/experimental" '))
    scene = sdf_pose_bridge.load(path, resource_paths=[tmp_path])
    assert 'arm::grip' not in names_of(scene)


@pytest.mark.parametrize(('params', 'told'), [
    ('<link element_id="base"><pose action="modify" degrees="true"/></link>', 'has no effect'),
    ('<link element_id="base" action="modify"><visual name="shape"/></link>',
     'holds nothing, so it changes nothing'),
])
def test_parameter_without_an_effect_is_told(load, params, told):
    scene = load(params)
    assert_at(scene, 'arm::base', (1, 0, 0))
    assert told in scene.warnings[0].message


@pytest.mark.parametrize('tag', [
    'box_shape', 'forcetorque', 'heightmap_shape', 'image_shape', 'sphere_shape', 'gui'])
def test_element_that_is_defined_for_itself_can_be_added(load, tag):
    load(f'<{tag} element_id="base" name="x" action="add"/>')


def test_required_element_that_is_missing_is_added_before_it_is_changed(load):
    load('<light element_id="base" name="lamp" type="spot" action="add"/>'
         '<light element_id="base::lamp" action="modify"><direction>0 0 -1</direction></light>')


@pytest.mark.parametrize('action', ['add', 'replace', 'modify'])
def test_value_in_an_element_is_changed(load, action):
    load('<visual element_id="base::shape"><transparency action="add">0.5</transparency>'
         f'<transparency action="{action}">0.4</transparency></visual>')


# Every change is read before the next one

def modified(pose, element_id='base'):
    return f'<link element_id="{element_id}" action="modify">{pose}</link>'


def with_params(tmp_path, pose, params, outer=''):
    """Include a link with parameters, and then the result with others; return the file."""
    write_files(
        tmp_path, inner=model_file(f'<link name="base">{pose}</link>').replace('"m"', '"inner"'),
        middle=model_file('<link name="k"/><include><uri>inner.sdf</uri><experimental:params>'
                          f'{params}</experimental:params></include>').replace('"m"', '"middle"'),
        outer=model_file('<link name="j"/><include><uri>middle.sdf</uri><experimental:params>'
                         f'{outer}</experimental:params></include>'))
    return tmp_path / 'outer.sdf'


@pytest.mark.parametrize(('pose', 'params'), [
    ('<pose>1 x</pose>', modified('<pose>1 0 0 0 0 0</pose>')),
    ('<pose>1 x</pose>', '<link element_id="base"><pose action="replace"/></link>'),
    ('<pose/>', modified('<pose>1 x</pose>') + modified('<pose>1 0 0 0 0 0</pose>')),
    ('<pose/>', modified('<pose rotation_format="quat_xyzw">0 0 0 0 0 0 1</pose>')
     + modified('<pose>0 0 0 0 0 0 1</pose>')),
    ('<pose/>', modified('<pose rotation_format="quat_xyzw">0 0 0 0 0 0</pose>')
     + modified('<pose>0 0 0 0 0 0</pose>')),
    ('<pose/>', '<state element_id="base" name="s" action="add"/>'),
])
def test_value_that_a_later_parameter_changes_is_checked(tmp_path, pose, params):
    (error,) = errors_of_file(with_params(tmp_path, pose, params))
    assert error.code in ('ELEMENT_INVALID', 'ATTRIBUTE_MISSING')


@pytest.mark.parametrize(('pose', 'params'), [
    ('<pose/>', modified('<pose degrees="true">0 0 0 0 0 90</pose>')),
    ('<pose>1 0 0 0 0 0</pose>',
     '<link element_id="base"><pose action="modify" degrees="true"/></link>'),
    ('<pose rotation_format="quat_xyzw">0 0 0 0 0 0 1</pose>',
     modified('<pose rotation_format="euler_rpy" degrees="true">0 0 0 0 0 0 1</pose>')),
])
@pytest.mark.parametrize('is_outer', [False, True])
def test_format_of_a_pose_is_that_of_its_next_text(tmp_path, pose, params, is_outer):
    text = '<pose>1 0 0 0 0 180</pose>'
    path = with_params(tmp_path, pose, params, modified(text, 'inner::base')) if is_outer else (
        with_params(tmp_path, pose, params + modified(text)))
    assert_at(sdf_pose_bridge.load(path), 'm::middle::inner::base', (1, 0, 0, 0, 0, 1, 0))
