# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose poses``: tables, JSON and the choice of elements and frames."""

import json
import math

import pytest
from sdf_texts import joint, LINK, model_file, posed, TWO_LINKS


def test_poses_prints_a_table(run_main):
    lines = run_main('poses', 'good.sdf').stdout.splitlines()
    assert lines[0].split() == [
        'frame', 'kind', 'x', 'm', 'y', 'z', 'roll', 'deg', 'pitch', 'yaw']
    assert lines[3].split() == ['m::l', 'link', '2.000', '2.000', '3.000', *['0.0'] * 3]


def test_poses_prints_a_json_object_for_each_file(run_main):
    done = run_main('poses', '--json', 'bad.sdf', 'good.sdf')
    assert done.returncode == 1
    bad, good = map(json.loads, done.stdout.splitlines())
    assert (bad['file'], bad['ok'], bad['elements']) == ('bad.sdf', False, [])
    assert bad['errors'][1].items() >= {
        'code': 'POSE_RELATIVE_TO_INVALID', 'file': 'bad.sdf', 'line': 4,
        'element': '/sdf/world[@name="w"]/model[@name="m"]/pose'}.items()
    assert (good['ok'], good['errors'], good['warnings']) == (True, [], [])
    assert good['elements'][2] == {
        'kind': 'link', 'name': 'm::l', 'world': 'w', 'pose': [2.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]}


def test_tables_of_several_files_have_their_names_above_them(run_main):
    lines = run_main('poses', 'good.sdf', 'warned.sdf').stdout.splitlines()
    assert [line for line in lines if line.endswith('.sdf')] == ['good.sdf', 'warned.sdf']
    assert not run_main('poses', 'good.sdf').stdout.startswith('good.sdf')


@pytest.mark.parametrize(('written', 'shown'), [
    ('a&#10;link  b', r'a\nlink  b'), ('\x9b31m', r'\x9b31m'), ('\u202egnp', r'\u202egnp'),
    ('größe', 'größe'),
])
def test_name_cannot_forge_a_row_of_the_table(run_on, written, shown):
    lines = run_on(model_file(f'<link name="{written}"/>'), 'poses').stdout.splitlines()
    assert len(lines) == 3
    assert f'm::{shown} ' in lines[2]


def test_json_has_ascii_only(run_on):
    done = run_on(model_file('<link name="\x9b"/>'), 'poses', '--json')
    assert done.stdout.isascii()
    assert json.loads(done.stdout)['elements'][1]['name'] == 'm::\x9b'


def test_poses_are_printed_relative_to_a_frame(run_main):
    done = run_main('poses', '--json', '--relative-to', 'f', '--kinds', 'link,model', 'good.sdf')
    elements = json.loads(done.stdout)['elements']
    assert [element['kind'] for element in elements] == ['model', 'link']
    assert elements[1]['pose'] == [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]


@pytest.mark.parametrize('name', ['m::hand', 'hand'])
def test_the_reference_frame_has_its_name_in_sdf_or_tf(run_on, name):
    done = run_on(
        model_file(LINK + posed('frame', 'hand', '1 0 0 0 0 0')), 'poses', '--json',
        '--relative-to', name, '--kinds', 'link')
    (link,) = json.loads(done.stdout)['elements']
    assert link['pose'][:3] == [-1.0, 0.0, 0.0]


def test_an_unknown_frame_is_an_error_of_the_file(run_main):
    done = run_main('poses', '--relative-to', 'ff', 'good.sdf')
    assert done.returncode == 1
    assert 'no frame or element is called "ff"; did you mean "f"?' in done.stderr


def test_the_hint_at_a_reference_frame_is_a_name_in_tf_too(run_on):
    text = model_file('<model name="robot"><link name="tool0"/></model>')
    done = run_on(text, 'poses', '--relative-to', 'robot/tool_0')
    assert 'called "robot/tool_0"; did you mean "robot/tool0"?' in done.stderr


ARM = model_file(
    TWO_LINKS + joint('<parent>a</parent><child>b</child>', joint_type='prismatic'))


@pytest.mark.parametrize(('argument', 'words'), [
    ('j', 'is not NAME=VALUE'), ('j=x', 'is not NAME=VALUE'), ('=1', '"" is not the name of'),
    ('i=1', '"i" is not the name of'), ('j=nan', 'must be finite'),
    ('j=1deg', 'the position of "j" is in m or mm, not in deg'), ('j=1 deg m', 'is not NAME=VA'),
])
def test_wrong_position_of_a_joint_is_refused(run_on, argument, words):
    done = run_on(ARM, 'poses', '--joint', argument)
    assert done.returncode in (1, 2)
    assert words in done.stderr


def test_poses_at_positions_of_joints(run_on):
    for text in ('m::j=0.5', 'j=500mm', 'm/j=5e-1m'):
        done = run_on(ARM, 'poses', '--json', '--joint', text)
        poses = {each['name']: each['pose'] for each in json.loads(done.stdout)['elements']}
        assert poses['m::b'][:3] == [0.0, 0.0, 0.5]


@pytest.mark.parametrize('other', ['j', 'm::j'])
def test_one_joint_has_one_position(run_on, other):
    done = run_on(ARM, 'poses', '--joint', 'j=7', '--joint', f'{other}=7')
    assert (done.returncode, done.stdout) == (1, '')
    assert f'"j" and "{other}" are one joint' in done.stderr


LIMIT = '<axis><xyz>0 0 1</xyz><limit><lower>{}</lower><upper>{}</upper></limit></axis></joint>'


@pytest.mark.parametrize(('limits', 'text', 'yaw_rad', 'is_asked'), [
    (None, 'j=90', 90 - 28 * math.pi, True),
    (None, 'j=90rad', 90 - 28 * math.pi, False),
    (None, 'j=90deg', math.pi / 2, False),
    (None, 'j=-6.3', 2 * math.pi - 6.3, True), (None, 'j=6.2', -0.0831853, False),
    ((-2, 2), 'j=90', 90 - 28 * math.pi, True), ((-2, 2), 'j=1.9', 1.9, False),
    # Neither in radians nor in degrees.
    ((-2, 2), 'j=180', 180 - 58 * math.pi, False),
])
def test_a_position_that_is_probably_in_degrees(run_on, limits, text, yaw_rad, is_asked):
    turning = ARM.replace('prismatic', 'revolute').replace(
        '</joint>', LIMIT.format(*limits) if limits else '</joint>')
    done = run_on(turning, 'poses', '--radians', '--kinds', 'link', '--joint', text)
    assert float(done.stdout.split()[-1]) == pytest.approx(yaw_rad, abs=0.06)
    assert (f'did you mean {text}deg? {text}rad confirms the unit' in done.stderr) == is_asked
    assert ('did you mean' in done.stderr) == is_asked


@pytest.mark.parametrize('arguments', [(), ('--relative-to', 'none')])
def test_a_position_beyond_the_limits_of_its_joint_is_a_warning(run_on, arguments):
    limit = LIMIT.format(0, 1)
    done = run_on(
        ARM.replace('</joint>', limit), 'poses', '--json', '--joint', 'j=2', *arguments)
    (warning,) = json.loads(done.stdout)['warnings']
    assert 'the position 2 of "j" is beyond its limits, 0 to 1' in warning['message']
