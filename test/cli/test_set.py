# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose set``: the file, what is printed, and the exit code."""

import math
import sys

import pytest
from sdf_texts import INCLUDES_LEAF, LINK, link_with, model_file, write_files

from sdf_pose_bridge import load
from sdf_pose_bridge.geometry.pose_texts import FORMATS


@pytest.fixture
def path(files):
    return files / 'good.sdf'


@pytest.fixture
def set_pose(run_main):
    """Sets a pose in the file, and returns what is printed; ``set_pose(*arguments)``."""
    def set_pose(*arguments):
        done = run_main('set', 'good.sdf', *arguments)
        assert (done.returncode, done.stderr) == (0, '')
        return done.stdout
    return set_pose


@pytest.fixture
def refused(run_main, path):
    """Tries to set a pose, and returns the one line why not; ``refused(*arguments)``."""
    def refused(*arguments):
        text = path.read_text()
        done = run_main('set', 'good.sdf', *arguments)
        assert (done.returncode, done.stdout, path.read_text()) == (1, '', text)
        (line,) = done.stderr.splitlines()
        return line
    return refused


def test_the_file_says_the_pose(set_pose, path):
    text = path.read_text()
    printed = set_pose('f', '-1e-3', *'00000')
    assert path.read_text() == text.replace('1 2 3 0 0 0', '-0.001 0 0 0 0 0')
    assert printed.startswith('--- good.sdf\n+++ good.sdf\n')
    assert '+    <frame name="f"><pose>-0.001 0 0 0 0 0</pose></frame>' in printed
    assert printed.endswith('moved with it: m, m::l\n')


def test_no_module_on_the_way_to_the_file_calls_one_of_a_room_above(set_pose):
    rooms, climbs = ['geometry', 'sdformat', 'scene', 'tf', 'export', 'cli'], []

    def height(frame):
        room = frame.f_globals['__name__'].split('.')[1:2]
        return rooms.index(*room) if {*room} & {*rooms} else -1

    def notice(frame, event, _):
        if event == 'call' and height(frame) > height(frame.f_back) >= 0:
            climbs.append((frame.f_back.f_code, frame.f_code))
    sys.setprofile(notice)
    try:
        set_pose('m/l', '--relative-to', 'f', '1.5', *'00000')
    finally:
        sys.setprofile(None)
    assert climbs == []


def test_a_name_that_two_elements_have_is_printed_once(set_pose, path):
    shapes = ''.join(
        f'<{tag} name="s"><geometry><sphere><radius>1</radius></sphere></geometry></{tag}>'
        for tag in ('visual', 'collision'))
    path.write_text(link_with(shapes))
    assert set_pose('m', *'100000').endswith('moved with it: m::l, m::l::s\n')


@pytest.mark.parametrize(('arguments', 'printed'), [
    (('--dry-run', 'f', *'000000'), '+    <frame name="f"><pose>0 0 0 0 0 0</pose></frame>'),
    (('f', *'123000'), '"f" has this pose already; the file stays as it is'),
])
def test_nothing_is_written_in_a_dry_run_or_where_the_pose_is_there(
        set_pose, path, arguments, printed):
    text = path.read_text()
    assert printed in set_pose(*arguments)
    assert path.read_text() == text


def test_a_frame_can_be_named_as_in_tf_and_measured_in_any_other(set_pose, path):
    set_pose('m/l', '--relative-to', 'f', '--format', 'franka_measured', '500', *'0000', '90')
    x, *_, qz, qw = load(path).pose('m::l', 'f')
    assert (x, qz, qw) == pytest.approx((0.5, 0.5 ** 0.5, 0.5 ** 0.5), abs=1e-9)


def test_a_rotation_leaves_the_position(set_pose, path):
    set_pose('f', '--format', 'rpy_degrees', '0', '0', '90')
    assert '<pose>1 2 3 0 0 1.570796327</pose>' in path.read_text()


def test_a_quaternion_of_another_length_is_asked_about(set_pose, refused, path):
    quat = ['f', '--format', 'sdf_quat_xyzw', *'0000', '0', '45', '1']
    assert refused(*quat).endswith(
        'the quaternion 0 0 45 1 has the length 45.0111, not 1 (--force writes them as they are)')
    set_pose('--force', *quat)
    assert '<pose>0 0 0 0 0 3.097' in path.read_text()


def test_a_pasted_text_is_set(run_main, path):
    done = run_main('set', 'good.sdf', 'f', 'p[0.1, 0, 0.3, 0, 0, 0.5]')
    assert (done.returncode, done.stderr) == (
        0, 'sdf_pose set: read as ur_pose: p[...] of Universal Robots\n')
    assert '<pose>0.1 0 0.3 0 0 0.5</pose>' in path.read_text()


@pytest.mark.parametrize(('numbers', 'option', 'other', 'written'), [
    ('0 0 0 0 0 90', '--degrees', '--radians', '0 0 0 0 0 1.570796327'),
    ('300 0 0 0 0 0', '--mm', '--metres', '0.3 0 0 0 0 0')])
def test_numbers_in_another_unit_are_asked_about(
        set_pose, refused, path, numbers, option, other, written):
    for force in ((), ('--force',)):
        assert refused('f', *force, *numbers.split()).endswith(
            f'did you mean {option}? (--radians --metres writes them as they are)')
    set_pose('f', option, *numbers.split())
    assert f'<pose>{written}</pose>' in path.read_text()
    set_pose('f', other, *numbers.split())
    assert load(path).pose('f')[:3] == pytest.approx((float(numbers.split()[0]), 0, 0))


def test_units_that_were_given_are_not_asked_about(set_pose, refused, path):
    small = '0.8 0 0 0 0 2.33'.split()
    set_pose('f', '--mm', '--degrees', *small)
    assert '<pose>0.0008 0 0 0 0 0.0406661716</pose>' in path.read_text()
    # The other unit is asked about.
    assert refused('f', '--metres', '--format', 'sdf_rpy_degrees', *small).endswith(
        '; did you mean --radians? (--degrees --metres writes them as they are)')
    assert refused('f', '--degrees', '--format', 'franka_measured', *small).endswith(
        '; did you mean --metres? (--degrees --mm writes them as they are)')


@pytest.mark.parametrize('name', [name for name, each in FORMATS.items() if each.angle])
def test_a_unit_of_angles_is_used_whatever_the_format_has(set_pose, path, name):
    source, written = FORMATS[name], []
    for unit, angle in (('radians', 0.25), ('degrees', math.degrees(0.25))):
        row = ['0'] * source.row_length
        row[source.columns[0]] = repr(angle)
        set_pose('f', '--format', name, f'--{unit}', *row)
        written.append(path.read_text())
    assert written[0] == written[1]
    assert '.25' in written[0] or '.785' in written[0]


@pytest.mark.parametrize(('numbers', 'written'), [
    (['1', '-2', '3'], '1 -2 3'), (['--mm', '1', '2', '-3'], '0.001 0.002 -0.003'),
    (['[0.5, 2, 3]'], '0.5 2 3')])
def test_three_numbers_are_the_position(set_pose, path, numbers, written):
    set_pose('f', '--format', 'rpy_degrees', '0', '0', '45')
    set_pose('f', *numbers)
    assert f'<pose>{written} 0 0 0.785398163' in path.read_text()


def test_three_numbers_are_asked_about_a_unit_of_lengths(set_pose, refused, path):
    assert refused('f', '300', '0', '0').endswith(
        'did you mean --mm? (--metres writes them as they are)')
    set_pose('f', '--metres', '300', '0', '0')
    assert load(path).pose('f')[:3] == (300.0, 0.0, 0.0)


def test_three_numbers_of_a_part_leave_its_rotation(set_pose, path):
    set_pose('m', '--by', 'l', '--format', 'rpy_degrees', '0', '0', '45')
    set_pose('m', '--by', 'l', '--relative-to', 'f', '0', '4', '0')
    x, y, z, *quat = load(path).pose('m::l')
    assert (x, y, z, *quat) == pytest.approx((1, 6, 3, 0, 0, 0.3826834, 0.9238795))


@pytest.mark.parametrize('part', ['tip', 'm::tip', 'm/tip'])
def test_a_model_moves_so_that_its_part_is_there(set_pose, path, part):
    text = path.read_text()
    path.write_text(text.replace(
        '<link name="l"/>', '<link name="l"/><frame name="tip"><pose>0 2 0 0 0 0</pose></frame>'))
    set_pose('m', '--by', part, '--relative-to', 'f', *'040000')
    assert load(path).pose('m', 'f')[:3] == pytest.approx((0, 2, 0))


def test_the_camera_moves_where_its_optical_frame_was_measured(set_pose, path):
    text = path.read_text()
    camera = '<link name="l"><sensor name="eye" type="camera"/></link>'
    path.write_text(text.replace('<link name="l"/>', camera))
    set_pose('m/l/eye_optical', '--relative-to', 'm/l', '--format', 'sdf_quat_xyzw', *'002',
             '-0.5', '0.5', '-0.5', '0.5')
    assert path.read_text() == text.replace('<link name="l"/>', camera.replace(
        '"camera"/>', '"camera"><pose>0 0 2 0 0 0</pose></sensor>'))


@pytest.mark.parametrize(('arguments', 'message'), [
    (['f', *'00000'], 'sdf_rpy has 6 numbers'),
    (['f', '1,5 2'], 'decimals need points'),
    (['f', '--degrees', *'000'], 'three numbers are a position, so leave out --degrees'),
    (['f', *'00000', 'x'], "'x' is not a number"),
    (['f', *'00000', 'nan'], 'it must be a finite number'),
    (['f', '--format', 'sdf_quat_xyzw', *'0000000'], 'is zero, which is not a rotation'),
    (['g', *'000000'], 'no frame or element is called "g"'),
    (['f', '--relative-to', 'm', *'000000'], 'good.sdf:3: POSE_NOT_SET: '),
    (['f', '--relative-to', 'g', *'000000'], 'no frame or element is called "g"'),
    (['m', '--by', 'f', *'000000'], 'sdf_pose set: "f" does not move with "m"'),
])
def test_what_cannot_be_set_is_one_error(refused, arguments, message):
    assert message in refused(*arguments)


def test_the_origin_of_a_joint_of_urdf_is_written_and_nothing_else(run_main, files):
    joint = ('  <joint name="j" type="revolute">\n    <!-- the wrist -->\n'
             '    <parent link="a"/>\n    <child link="b"/>\n'
             '    <limit lower="-1" upper="1.50" effort="1" velocity="1"/>\n'
             '    <mimic joint="i"   multiplier="-1"/>\n  </joint>\n')
    text = ('<?xml version="1.0"?>\n<!-- This was autogenerated by xacro -->\n'
            '<robot name="r">\n  <link name="a"/><link name="b"/>\n'
            '<link name="c"/><joint name="i" type="continuous"><parent link="a"/>'
            f'<child link="c"/></joint>\n{joint}</robot>')
    path = files / 'arm.urdf'
    path.write_text(text)
    done = run_main('set', 'arm.urdf', 'b', '500', *'00000')
    assert 'did you mean --mm?' in done.stderr
    done = run_main('set', 'arm.urdf', 'b', '--dry-run', '--mm', '500', *'00000')
    assert (done.returncode, path.read_text()) == (0, text)
    done = run_main('set', 'arm.urdf', 'b', '--mm', '500', *'00000')
    assert 'xacro wrote this file, and overwrites it' in done.stderr
    assert '+    <origin xyz="0.5 0 0" rpy="0 0 0"/>\n' in done.stdout
    assert path.read_text() == text.replace(
        '    <!--', '    <origin xyz="0.5 0 0" rpy="0 0 0"/>\n    <!--')
    assert load(path).pose('b')[:3] == (0.5, 0, 0)


def test_an_invalid_file_is_not_written(run_main, files):
    text = (files / 'bad.sdf').read_text()
    assert run_main('set', 'bad.sdf', 'f', *'000000').returncode == 1
    assert (files / 'bad.sdf').read_text() == text


def test_another_file_than_the_one_named_is_printed_first(run_main, files):
    write_files(files, cell=INCLUDES_LEAF, leaf=model_file(LINK))
    done = run_main('set', 'cell.sdf', 'm::l', *'100000')
    assert done.stdout.startswith('the pose is in leaf.sdf\n--- leaf.sdf\n')


@pytest.mark.parametrize('option', ['', '--dry-run'])
@pytest.mark.parametrize('redirection', ['> /dev/full', '>&-'])
def test_an_output_that_fails_is_an_error_and_nothing_is_written(
        sdf_pose_in_shell, path, option, redirection):
    before = path.read_text()
    done = sdf_pose_in_shell(f'set {option} good.sdf f 9 0 0 0 0 0 {redirection}')
    assert path.read_text() == before
    assert done.returncode == 1
    assert done.stderr.startswith('sdf_pose set: the output cannot be written: ')
    assert len(done.stderr.splitlines()) == 1
