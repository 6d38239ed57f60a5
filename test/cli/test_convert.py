# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose convert``: invalid input, output, and lines from standard input."""

import io
import math
import sys

import numpy as np
import pytest

from sdf_pose_bridge.cli import convert as convert_command
from sdf_pose_bridge.cli.convert import without_rounding_errors
from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    POSE_FORMATS,
    ROTATION_FORMATS,
)


@pytest.fixture
def printed(convert):
    """Runs a conversion without errors; returns what it prints."""
    def run(*arguments, **options):
        code, out, err = convert(*arguments, **options)
        assert (code, err) == (0, '')
        return out
    return run


def numbers(text):
    return [float(word) for word in text.split()]


# Invalid input.

def test_numbers_alone_need_a_format(convert):
    code, _, err = convert('0', '0', '0')
    assert code == 2
    assert '--from' in err


@pytest.mark.parametrize(('source', 'target'), [('rpy', 'sdf_rpy'), ('sdf_rpy', 'quaternion')])
def test_poses_and_rotations_do_not_convert_to_each_other(convert, source, target):
    code, out, err = convert('--from', source, '--to', target, '0', '0', '0')
    assert code == 2
    assert not out
    assert source in err
    assert target in err


@pytest.mark.parametrize(('arguments', 'message'), [
    (('rpy', '1', '2'), 'rpy has 3 numbers (roll pitch yaw in radians), but 2 are given'),
    (('rpy', '1'), 'but 1 is given'),
    (('rpy', '1', 'two', '3'), "'two' is not a number"),
    (('rpy', '1', '1_000', '3'), "'1_000' is not a number"),
    (('rpy', '1', '1,5', '3'), 'decimal commas'),
    (('rpy', '1', 'nan', '3'), 'value 1 is nan'),
    (('quaternion', '0', '0', '0', '0'), 'zero'),
])
def test_invalid_numbers_are_named_and_nothing_is_printed(convert, arguments, message):
    code, out, err = convert('--from', *arguments)
    assert code == 1
    assert not out
    assert message in err
    assert len(err.splitlines()) == 1


@pytest.mark.parametrize(('source', 'given', 'question'), [
    ('rpy', '0 0 90', 'the angles 0 0 90 are radians; did you mean --degrees?'),
    ('ur_pose', '0 0 0 0 9 0', 'the angles 0 9 0 are radians; did you mean --degrees?'),
    ('sdf_quat_xyzw', '-300 0 0 0 0 0 1',
     'the position -300 0 0 is in metres; did you mean --mm?'),
    ('sdf_rpy', '300 0 5 0 0 90', (
        'the angles 0 0 90 are radians and the position 300 0 5 is in metres; did you mean '
        '--degrees --mm?'))])
def test_numbers_in_another_unit_are_asked_about(convert, source, given, question):
    code, out, err = convert('--from', source, '--to', source, *given.split())
    assert (code, err) == (0, f'sdf_pose convert: {question}\n')
    assert out
    assert convert('--from', source, '--to', source, lines=given)[1:] == (out, err)


@pytest.mark.parametrize(('source', 'option', 'given'), [
    ('rpy', '--degrees', '0 0 90'), ('rpy_degrees', '--radians', '0 0 1.5707963267948966'),
    ('franka_measured', '--metres', '0.3 0 0.5 180 0 0'),
    ('ur_pose', '--degrees', '0 0 0 0 0 90'),
    ('sdf_quat_xyzw', '--mm', '300 0 0 0 0 0 1'), ('kinova', '--mm', '300 0 0 0 0 90'),
    ('matrix_row_major', '--mm', '1 0 0 300 0 1 0 0 0 0 1 0 0 0 0 1')])
def test_the_option_that_a_question_names_is_its_answer(convert, printed, source, option, given):
    _, _, question = convert('--from', source, *given.split())
    assert question.endswith(f'did you mean {option}?\n')
    out = printed('--from', source, option, *given.split())
    values = dict(line.split(maxsplit=1) for line in out.splitlines())
    if option in ('--mm', '--metres'):
        assert numbers(values['sdf_rpy'])[0] == 0.3
    else:
        largest = max(map(abs, numbers(values[source])))
        assert largest == pytest.approx(90 if option == '--radians' else math.pi / 2, abs=1e-15)


# Output.

@pytest.mark.parametrize(('arguments', 'target', 'expected'), [
    # Units are those of the given numbers alone.
    ('--mm --from sdf_rpy 300 0 500 0 0 0', 'sdf_rpy', '0.3 0 0.5 0 0 0'),
    ('--mm --from franka_measured 300 0 0 0 0 90', 'franka_measured', '300 0 0 0 0 90'),
    ('--degrees --from rpy 0 0 90', 'rpy', '0 0 1.5707963267948966'),
    ('--radians --from rpy_degrees 0 0 1.5', 'rpy', '0 0 1.5'),
    ('--from quaternion_xyzw 0.5 0 0 0.866', 'rpy_degrees', '60.0014555617 0 0'),
    # Inverses and products.
    *((f'--from sdf_rpy_degrees 1 0 0 0 0 90 {products}', 'sdf_rpy_degrees', expected)
      for products, expected in (
        ('--inverse', '0 1 0 0 0 -90'),
        ('--times 2 0 0 0 0 30', '1 2 0 0 0 120'),
        ('--times 2 0 0 0 0 30 --times 0 0 1 0 0 0', '1 2 1 0 0 120'),
        ('--times kuka_abc 2000 0 0 30 0 0', '1 2 0 0 0 120'),
        ('--times-inverse 2 0 0 0 0 30', '0 -1.7320508075688772 0 0 0 60'),
        ('--inverse --times 1 0 0 0 0 90', '0 0 0 0 0 0'),
        ('--times sdf_quat_xyzw 0 0 -1 0 0 0 1', '1 0 -1 0 0 90'))),
])
def test_units_and_products(printed, arguments, target, expected):
    out = printed(*arguments.split(), '--to', target)
    assert numbers(out) == pytest.approx(numbers(expected), abs=1e-10)


@pytest.mark.parametrize(('target', 'text'), [
    ('urdf_origin', '<origin xyz="1.0 2.0 3.0" rpy="0.0 0.0 0.5"/>'),
    ('sdf_pose', '<pose>1.0 2.0 3.0 0.0 0.0 0.5</pose>'),
    ('static_transform_publisher', ' '.join((
        '--x 1.0 --y 2.0 --z 3.0 --qx 0.0 --qy 0.0',
        f'--qz {math.sin(0.25)} --qw {math.cos(0.25)}')))])
def test_a_pose_is_printed_as_text(convert, target, text):
    assert convert('--from', 'sdf_rpy', '--to', target, *'1 2 3 0 0 0.5'.split()) == (
        0, f'{text}\n', '')


@pytest.mark.parametrize(('target', 'is_locked'), [
    ('rpy', True), ('ypr_degrees', True), ('quaternion', False), (None, True)])
def test_gimbal_lock_is_reported(convert, target, is_locked):
    to = ['--to', target] if target else []
    code, _, err = convert('--from', 'rpy_degrees', *to, '10', '90', '20')
    assert code == 0
    assert ('near gimbal lock' in err) is is_locked


def test_gimbal_lock_is_that_of_the_sequence(convert):
    straight_down = ['--from', 'sdf_rpy_degrees', *'0 0 0 180 0 20'.split()]
    assert "(z-y'-z'')" in convert(*straight_down, '--to', 'kawasaki_oat')[2]
    assert convert(*straight_down)[2] == ''


# Products.

def test_each_line_is_multiplied(convert):
    _, out, _ = convert('--from', 'rpy_degrees', '--times', 'ypr_degrees', '10', '0', '0', '--to',
                        'rpy_degrees', lines='0 0 5\n0 0 -5\n')
    assert numbers(out) == pytest.approx([0, 0, 15, 0, 0, 5], abs=1e-12)


@pytest.mark.parametrize(('factor', 'message'), [
    ('1 2', 'sdf_rpy has 6 numbers'), ('rpy 0 0 0', 'cannot be multiplied with rpy'),
    ('quat 0 0 0 1', 'cannot be multiplied with quaternion'), ('sdf_quat 0 0 0 0 0 0 0', 'zero')])
def test_a_wrong_factor_is_an_error(convert, factor, message):
    given = 'p[0, 0, 0, 0, 0, 0]' if factor.startswith('rpy') else '<pose>0 0 0 0 0 0</pose>'
    source = [] if factor.startswith('rpy') else ['--from', 'sdf_rpy']
    code, out, err = convert(*source, given, '--times', *factor.split())
    assert (code, out) == (1, '')
    assert message in err


@pytest.mark.parametrize('words', [
    ['0.1,', '-0.2,', '0.3,', '0,', '0,', '1.5'], ['--x', '0.1', '--y', '-0.2', '--z', '0.3',
    '--yaw', '1.5', '--frame-id', 'a'], ['p[0.1,', '-0.2,', '0.3, 0, 0, 1.5]'],
    ['<origin xyz="0.1 -0.2 0.3" rpy="0 0 1.5"/>']])
def test_pasted_text_is_read(convert, words):
    source = ['--from', 'sdf_rpy'] if words[0] == '0.1,' else []
    code, out, err = convert(*source, *words, '--to', 'sdf_rpy')
    assert (code, numbers(out)) == (0, pytest.approx([0.1, -0.2, 0.3, 0.0, 0.0, 1.5]))
    assert err.startswith('' if source else 'sdf_pose convert: read as ')


def test_a_text_of_a_form_is_a_format_of_input_too(convert):
    text = '<origin xyz="1 2 3" rpy="0 0 0.5"/>'
    assert convert('--from', 'urdf_origin', '--to', 'urdf_origin', text)[1] == (
        '<origin xyz="1.0 2.0 3.0" rpy="0.0 0.0 0.5"/>\n')
    for words in (['--from', 'sdf_pose', text], ['--from', 'kuka_abc', text]):
        assert convert(*words)[:2] == (1, '')
    _, out, _ = convert(
        '--from', 'sdf_rpy_degrees', *'100000', '--times', text, '--to', 'sdf_rpy')
    assert numbers(out) == pytest.approx([2.0, 2.0, 3.0, 0.0, 0.0, 0.5])


def test_options_may_follow_the_numbers(convert):
    assert convert('0', '0', '90', '--from', 'rpy_degrees', '--to', 'quaternion') == convert(
        '--from', 'rpy_degrees', '--to', 'quaternion', '0', '0', '90'
    )


@pytest.mark.parametrize('given', [
    ['-1', '0', '0'], ['--', '-1', '0', '0'], ['-1e0', '-.0', '0'], ['-1.', '-0', '-0e-3'],
    ['-1 0 0'], ['-10.0E-1', '0', '0'],
])
def test_negative_numbers_are_not_options(printed, given):
    assert printed('--from', 'rpy', '--to', 'rpy', *given) == '-1.0 0.0 0.0\n'


def test_without_a_target_all_formats_are_printed(convert):
    code, out, _ = convert('--from', 'quaternion_wxyz', '2', '0', '0', '2')
    lines = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert code == 0
    assert list(lines) == list(ROTATION_FORMATS)
    assert numbers(lines['rpy_degrees']) == [0.0, 0.0, 90.0]
    assert numbers(lines['matrix']) == pytest.approx([0, -1, 0, 1, 0, 0, 0, 0, 1], abs=1e-15)
    code, out, _ = convert('--from', 'sdf_rpy', '1', '2', '3', '0', '0', '0')
    assert code == 0
    assert [line.split()[0] for line in out.splitlines()] == list(POSE_FORMATS)


def test_numbers_are_rounded_for_people(convert, monkeypatch):
    row = ['--from', 'sdf_rpy', *'0.38000000000000006 -2.4e-18 123.4567'.split(), *'000']
    assert convert(*row, '--to', 'sdf_rpy', '--digits', '2')[1] == '0.38 0 123.46 0 0 0\n'


def test_a_terminal_gets_short_numbers_and_whole_words(on_terminal):
    row = '0.38000000000000006 -2.4e-18 123.4567 0 0 90'.split()
    text = on_terminal(
        40, 'convert', '--from', 'sdf_rpy', '--degrees', *row, '--to', 'sdf_rpy_degrees')
    assert text == (
        'sdf_pose convert: the position 0.38\n  -2.4e-18 123.457 is in metres; did you\n'
        '  mean --mm?\n0.38 0 123.4567 0 0 90\n')
    listed = on_terminal(60, 'convert', '--from', 'sdf_rpy', *'100000')
    assert max(map(len, listed.splitlines())) <= 60


def test_rounding_errors_are_zero_where_people_read_them():
    source, target = POSE_FORMATS['sdf_rpy'], POSE_FORMATS['matrix_row_major']
    rows = converted_poses([[1e-17, 0.0, 3.0, math.pi / 2, 0.0, 0.0]], source.name, target.name)
    assert rows[0, 5] != 0.0
    shown = without_rounding_errors(rows, source, target)
    assert shown[0].tolist() == [
        1.0, 0.0, 0.0, 1e-17, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0]
    assert rows[0, 5] != 0.0


@pytest.mark.parametrize(('source', 'target'), [('rpy', 'rpy'), ('rpy', 'rpy_degrees')])
def test_digits_that_a_conversion_keeps_are_shown(source, target):
    formats = ROTATION_FORMATS[source], ROTATION_FORMATS[target]
    rows = converted_rotations([[1e-20, 0.0, 1.0]], source, target)
    assert np.array_equal(without_rounding_errors(rows, *formats), rows)


def test_printed_numbers_are_read_back_exactly(convert):
    row = [0.1, 1 / 3, -2e-7, 0.3, -0.2, 1e-9]
    _, out, _ = convert('--from', 'sdf_rpy', '--to', 'franka_matrix', *map(repr, row))
    assert numbers(out) == converted_poses(row, 'sdf_rpy', 'franka_matrix').tolist()
    assert '-0.0 ' not in out


# Standard input.

def test_lines_are_converted_one_by_one(printed):
    out = printed(
        '--from', 'rpy_degrees', '--to', 'rpy', lines='0 0 0\n\t0  0\t90 \r\n-0.0 0 -180')
    assert len(out.splitlines()) == 3
    assert numbers(out) == pytest.approx(
        [0.0, 0.0, 0.0, 0.0, 0.0, math.pi / 2, 0.0, 0.0, -math.pi], abs=1e-15)


def test_a_text_of_several_lines_is_one_pose_or_one_error(convert):
    lines = '0 -1 0 5\n1 0 0 0\n0 0 1 0\n0 0 0 1\n[[1 0 0 1]\n[0 1 0 0]\n[0 0 1 0]\n[0 0 0 2]]\n'
    code, out, err = convert('--from', 'matrix_row_major', '--to', 'sdf_rpy_degrees', lines=lines)
    assert (code, out) == (1, '5.0 0.0 0.0 0.0 0.0 90.0\n# line 5 is not converted\n')
    assert len(err.splitlines()) == 1


def test_a_list_of_poses_is_a_line_each_with_its_name(convert):
    pose = '{position: {x: 1, y: 2, z: 3}, orientation: {w: 1}}'
    code, out, _ = convert('--to', 'sdf_rpy', lines=f'a: {pose}\nb: {pose}\np[1]\n')
    row = '1.0 2.0 3.0 0.0 0.0 0.0'
    assert (code, out) == (1, f'# a\n{row}\n# b\n{row}\n# line 3 is not converted\n')
    assert convert('--to', 'sdf_rpy', f'poses: [{pose}, {pose}]')[1] == 2 * f'{row}\n'


def test_a_dash_is_the_standard_input(printed):
    assert printed('--from', 'rpy', '--to', 'rpy', '-', lines='0 0 1\n') == '0.0 0.0 1.0\n'


@pytest.mark.parametrize('source', ['rzyz', 'sxyz'])
def test_a_sequence_of_axes_has_poses_and_rotations(convert, source):
    code, out, err = convert(
        '--from', source, '--degrees', '--to', source, lines='10 20 30\n1 2 3 10 20 30\n')
    assert code == 0
    assert [numbers(line) for line in out.splitlines()] == [
        pytest.approx([*position, *np.radians([10, 20, 30])]) for position in ((), (1, 2, 3))]
    assert f'read as {source}: x y z in metres, angles in degrees' in err
    assert f'{source} has no lengths' in convert('--from', source, '--mm', *'123')[2]
    assert convert('--from', source[1:].upper(), *'123')[::2] == (2, (
        f'sdf_pose convert: no format "{source[1:].upper()}"; with fixed axes it is '
        f's{source[1:]}, with turning ones r{source[1:]}\n'))


def test_questions_that_differ_in_numbers_are_asked_once(convert):
    _, _, err = convert('--from', 'rpy', lines='0 0 90\n0 0 x\n0 0 80\n0 0 x\n0 0 70\n')
    assert err.count('did you mean --degrees') == 1


@pytest.mark.parametrize(('lines', 'expected'), [
    ('# a b\n\n  \n 0 0 1\n  #\n', '0.0 0.0 1.0\n'), ('', '')])
def test_blank_lines_and_comments_are_skipped(printed, lines, expected):
    assert printed('--from', 'rpy', '--to', 'rpy', lines=lines) == expected


def test_invalid_lines_are_reported_and_the_others_converted(convert):
    code, out, err = convert(
        '--from', 'quaternion', '--to', 'quaternion',
        lines='0 0 0 1\n# note\n0 0 0\n0 0 0 0\n0 0 inf 0\n0 0 x 0\n0 3 0 0\n',
    )
    assert code == 1
    assert out.splitlines() == [
        '0.0 0.0 0.0 1.0',
        '# line 3 is not converted', '# line 4 is not converted',
        '# line 5 is not converted', '# line 6 is not converted',
        '0.0 1.0 0.0 0.0',
    ]
    messages = err.splitlines()
    assert [message.split(':')[1] for message in messages] == [
        f' line {number}' for number in (3, 4, 5, 6)
    ]
    assert 'but 3 are given' in messages[0]
    assert 'zero' in messages[1]
    assert 'inf' in messages[2]
    assert "'x'" in messages[3]


def test_bytes_that_are_not_text_make_an_invalid_line(convert):
    stdin = io.TextIOWrapper(io.BytesIO(b'0 0 1\n0 \xff 1\n0 0 2\n'), encoding='utf-8')
    code, out, err = convert('--from', 'rpy', '--to', 'rpy', stdin=stdin)
    assert code == 1
    assert out.splitlines() == ['0.0 0.0 1.0', '# line 2 is not converted', '0.0 0.0 2.0']
    assert 'xff' in err


def test_on_a_terminal_each_line_is_answered_at_once(convert, monkeypatch):
    answers_before_line = []

    class Terminal(io.StringIO):
        def isatty(self):
            return True

        def __next__(self):
            answers_before_line.append(sys.stdout.getvalue().count('\n'))
            return super().__next__()

    monkeypatch.setattr('sys.stdout', io.StringIO())
    convert('--from', 'rpy', '--to', 'rpy', stdin=Terminal('0 0 1\n0 0 2\n0 0 3\n'))
    assert answers_before_line[:4] == [0, 1, 2, 3]


def test_without_a_target_each_line_has_a_block(convert):
    _, out, _ = convert('--from', 'rpy', lines='0 0 0\n0 0 1\n')
    blocks = out.strip().split('\n\n')
    assert [len(block.splitlines()) for block in blocks] == [len(ROTATION_FORMATS)] * 2


def test_many_lines_keep_their_order_and_every_invalid_one_is_reported(convert, monkeypatch):
    monkeypatch.setattr(convert_command, 'CHARACTERS_AT_A_TIME', 7000)
    rows = [f'0 0 {0.001 * number}' for number in range(3000)]
    bad = (0, 699, 700, 1234, 1235, 2999)
    for number in bad:
        rows[number] = '0 0 nan'
    code, out, err = convert('--from', 'rpy', '--to', 'rpy', lines='\n'.join(rows))
    answers = out.splitlines()
    assert code == 1
    assert len(answers) == 3000
    assert tuple(n for n, line in enumerate(answers) if line.startswith('#')) == bad
    assert len(err.splitlines()) == len(bad)
    good = [number for number in range(3000) if number not in bad]
    assert [numbers(answers[number])[2] for number in good] == pytest.approx(
        [0.001 * number for number in good], abs=1e-15
    )
