# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of includes: what is wrong with them, and what they change."""

import pytest
from sdf_texts import assert_at
from sdf_texts import names_of

import sdf_pose_bridge

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
    def load_files(*texts, **others):
        return sdf_pose_bridge.load(write(*texts, **others), resource_paths=[tmp_path])
    return load_files


@pytest.fixture
def errors(load):
    def errors_of(*texts, **others):
        with pytest.raises(sdf_pose_bridge.SdfError) as caught:
            load(*texts, **others)
        return caught.value.errors
    return errors_of


def _only(errors):
    assert len(errors) == 1, [str(error) for error in errors]
    return errors[0]


# What is wrong

@pytest.mark.parametrize(('params', 'code'), [
    ('<link/>', 'ATTRIBUTE_MISSING'),
    ('<link action="remove"/>', 'ATTRIBUTE_MISSING'),
    ('<link element_id="base::" action="remove"/>', 'ATTRIBUTE_INVALID'),
    ('<link element_id="base" action="change"/>', 'ATTRIBUTE_INVALID'),
    ('<link element_id="base" action=""/>', 'ATTRIBUTE_INVALID'),
    ('<link element_id="none" action="remove"/>', 'ELEMENT_MISSING'),
    ('<visual element_id="base" action="remove"/>', 'ELEMENT_MISSING'),
    ('<frame element_id="gripper::tip" action="remove"/>', 'ELEMENT_MISSING'),
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
])
def test_what_is_said_of_an_element_is_wrong(errors, params, code):
    error = _only(errors(params))
    assert (error.code, error.line) == (code, 3)
    assert error.file.endswith('main.sdf')


@pytest.mark.parametrize(('child', 'code'), [
    ('<pose>0 0 0 0 0 0</pose>', 'ATTRIBUTE_MISSING'),
    ('<pose action="change"/>', 'ATTRIBUTE_INVALID'),
    ('<inertial action="remove"/>', 'ELEMENT_MISSING'),
    ('<inertial action="modify"/>', 'ELEMENT_MISSING'),
    ('<inertial action="replace"/>', 'ELEMENT_MISSING'),
    ('<visual name="none" action="remove"/>', 'ELEMENT_MISSING'),
    ('<visual action="replace"/>', 'ATTRIBUTE_MISSING'),
    ('<joint name="j" action="add"/>', 'ELEMENT_INVALID'),
    ('<custom:thing action="add"/>', 'ELEMENT_INVALID'),
    ('<sensor name="s" action="add"/>', 'ATTRIBUTE_MISSING'),
    ('<pose action="modify">1 2</pose>', 'ELEMENT_INVALID'),
    ('<pose action="modify" degrees="true" rotation_format="quat_xyzw">0 0 0 0 0 0 1</pose>',
     'ELEMENT_INVALID'),
])
def test_what_is_said_of_a_child_is_wrong(errors, child, code):
    error = _only(errors(f'<link element_id="base">\n{child}</link>'))
    assert (error.code, error.line) == (code, 4)
    assert error.file.endswith('main.sdf')


def test_an_error_names_the_element_of_the_parameters(errors):
    error = _only(errors('<link element_id="none" action="remove"/>'))
    assert error.element == (
        '/sdf/world[@name="w"]/include/experimental:params/link[@element_id="none"]')


def test_all_errors_are_told_at_once(errors):
    params = '<link/><link element_id="none" action="remove"/><link element_id="base" action="x"/>'
    assert [error.code for error in errors(params)] == [
        'ATTRIBUTE_MISSING', 'ELEMENT_MISSING', 'ATTRIBUTE_INVALID']


def test_a_near_id_is_suggested(errors):
    error = _only(errors('<frame element_id="tool::top" action="remove"/>'))
    assert 'did you mean "tool::tip"?' in error.message


@pytest.mark.parametrize(('params', 'reason'), [
    ('<collision element_id="base::shape" action="remove"/>', 'finds only the <visual>'),
    ('<link element_id="h" action="remove"/>', 'names of one letter'),
])
def test_what_libsdformat_does_not_find_is_not_found(errors, params, reason):
    error = _only(errors(params))
    assert error.code == 'ELEMENT_MISSING'
    assert reason in error.message


def test_an_error_of_the_included_file_keeps_its_place(errors):
    # The frame that is attached to what is gone.
    error = errors('<link element_id="base" action="remove"/>')[0]
    assert (error.file.endswith('arm.sdf'), error.line) == (True, 6)


def test_an_error_in_the_parameters_of_an_included_file(errors):
    arm = ARM.replace('<name>tool</name>', (
        '<name>tool</name><experimental:params><link element_id="none" action="remove"/>'
        '</experimental:params>'))
    error = _only(errors('<link element_id="base"><pose action="modify"/></link>', arm=arm))
    assert error.code == 'ELEMENT_MISSING'
    assert (error.file.endswith('arm.sdf'), error.line) == (True, 8)


# What changes

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
])
def test_a_pose_is_changed(load, params, name, pose):
    assert_at(load(params), f'arm::{name}', pose)


@pytest.mark.parametrize(('params', 'gone'), [
    ('<frame element_id="tool::tip" action="remove"/>', 'arm::tool::tip'),
    ('<model element_id="tool" action="remove"/>', 'arm::tool::palm'),
    ('<visual element_id="base::shape" action="remove"/>', 'arm::base::shape'),
    ('<link element_id="base" action="remove"><sensor name="eye"/></link>', 'arm::base::eye'),
    ('<joint element_id="hinge" name="wrist" action="modify"/>', 'arm::hinge'),
])
def test_an_element_goes(load, params, gone):
    before, after = names_of(load('')), names_of(load(params))
    assert before.count(gone) - after.count(gone) == 1


def test_an_include_in_an_added_model_is_read(load):
    params = ('<model element_id="" name="second" action="add"><include><uri>tool.sdf</uri>'
              '</include></model>')
    assert_at(load(params), 'arm::second::gripper::tip', (0, 0, 4))


def test_an_include_that_is_added_by_itself_includes_nothing(load):
    scene = load('<model element_id="tool"><include action="add"><uri>tool.sdf</uri></include>'
                 '</model>')
    assert 'arm::tool::gripper' not in names_of(scene)
    assert len(scene.warnings) == 1


def test_names_and_overrides_of_the_include_itself_count_as_ever(load):
    scene = load('<frame element_id="grip" action="modify"><pose>0 0 1 0 0 0</pose></frame>',
                 '<name>left</name><pose>0 0 100 0 0 0</pose>')
    assert_at(scene, 'left::grip', (1, 0, 101))


def test_another_include_of_the_file_is_not_changed(load, tmp_path):
    pair = ('<sdf version="1.9"><model name="pair"><include><uri>arm.sdf</uri><name>a</name>'
            '<experimental:params><frame element_id="grip"><pose action="remove"/></frame>'
            '</experimental:params></include><include><uri>arm.sdf</uri><name>b</name></include>'
            '</model></sdf>')
    load('', pair=pair)
    scene = sdf_pose_bridge.load(tmp_path / 'pair.sdf', resource_paths=[tmp_path])
    assert_at(scene, 'pair::a::grip', (1, 0, 0))
    assert_at(scene, 'pair::b::grip', (1, 2, 0))


def test_what_a_file_merges_is_found_without_its_name(load):
    arm = ARM.replace('<include>', '<include merge="true">')
    scene = load('<frame element_id="tip"><pose action="modify">0 0 9 0 0 0</pose></frame>'
                 '<link element_id="palm"><pose action="modify">0 5 0 0 0 0</pose></link>',
                 arm=arm)
    assert_at(scene, 'arm::tip', (1, 2, 12))
    assert_at(scene, 'arm::palm', (1, 7, 3))


def test_an_include_that_merges_has_parameters(load, tmp_path):
    rig = ('<sdf version="1.9"><model name="rig"><include merge="true"><uri>arm.sdf</uri>'
           '<pose>10 0 0 0 0 0</pose><experimental:params><frame element_id="grip">'
           '<pose action="remove"/></frame></experimental:params></include></model></sdf>')
    load('', rig=rig)
    scene = sdf_pose_bridge.load(tmp_path / 'rig.sdf', resource_paths=[tmp_path])
    assert_at(scene, 'rig::grip', (11, 0, 0))


def test_parameters_change_what_parameters_have_changed(load):
    arm = ARM.replace('<name>tool</name>', (
        '<name>tool</name><experimental:params><frame element_id="" name="deep" action="add"/>'
        '</experimental:params>'))
    scene = load('<frame element_id="tool::deep" action="modify" attached_to="tip"/>', arm=arm)
    assert_at(scene, 'arm::tool::deep', (1, 2, 7))


def test_a_declared_prefix_is_understood(write, tmp_path):
    path = write('<frame element_id="grip" action="remove"/><model element_id="tool"><pose '
                 'action="replace"/></model>')
    path.write_text(path.read_text().replace(
        '<sdf ', '<sdf xmlns:experimental="http://sdformat.org/schemas/experimental" '))
    scene = sdf_pose_bridge.load(path, resource_paths=[tmp_path])
    assert 'arm::grip' not in names_of(scene)


def test_the_unit_of_numbers_that_stay_does_not_change(load):
    scene = load('<link element_id="base"><pose action="modify" degrees="true"/></link>')
    assert_at(scene, 'arm::base', (1, 0, 0))
    assert 'comes too late' in scene.warnings[0].message


def test_numbers_are_in_the_unit_that_is_given_with_them(load):
    scene = load('<link element_id="base"><pose action="modify" degrees="true">0 0 0 0 0 180'
                 '</pose></link>')
    assert_at(scene, 'arm::base', (0, 0, 0, 0, 0, 1, 0))


# A file whose top is an include

def _at_the_top(load, tmp_path, content):
    load('', outer=f'<sdf version="1.9">{content}</sdf>',
         user='<sdf version="1.10"><world name="w"><frame name="desk"><pose>0 0 50 0 0 0</pose>'
              '</frame><include><uri>outer.sdf</uri></include></world></sdf>')
    return sdf_pose_bridge.load(tmp_path / 'user.sdf', resource_paths=[tmp_path])


@pytest.mark.parametrize(('content', 'code'), [
    ('<include><uri>none.sdf</uri></include>', 'URI_LOOKUP'),
    ('<include merge="true"><uri>tool.sdf</uri></include>', 'ELEMENT_MISSING'),
    ('<include><uri>tool.sdf</uri></include><include><uri>arm.sdf</uri></include>',
     'ELEMENT_INCORRECT_TYPE'),
])
def test_an_include_at_the_top_cannot_be_included(load, tmp_path, content, code):
    with pytest.raises(sdf_pose_bridge.SdfError) as caught:
        _at_the_top(load, tmp_path, content)
    assert code in [error.code for error in caught.value.errors]


def test_an_include_at_the_top_is_included(load, tmp_path):
    scene = _at_the_top(load, tmp_path, (
        '<include><uri>tool.sdf</uri><name>hand</name><pose>1 0 0 0 0 0</pose></include>'))
    assert_at(scene, 'hand::tip', (1, 0, 4))


def test_an_include_at_the_top_is_placed_where_the_file_is_included(load, tmp_path):
    scene = _at_the_top(load, tmp_path, (
        '<include><uri>tool.sdf</uri><pose relative_to="desk">1 0 0 0 0 0</pose></include>'))
    assert_at(scene, 'gripper', (1, 0, 50))
