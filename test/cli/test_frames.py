# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames as tables on terminals, as CSV and as JSON."""

import csv
import io
import json
import re

from folders import ROOT
import pytest
from sdf_texts import element, fixed_joint, LINK, model_file, posed


@pytest.mark.parametrize(('columns', 'arguments'), [
    (60, 'tree {cell}'), (80, 'tree {cell}'), (120, 'tree {cell}'), (80, 'tree --scope {cell}'),
    (60, 'poses {cell}'),
    (80, 'poses {cell} --radians'), (80, 'poses --mm {cell}'), (80, 'diff {moved} {cell}'),
    (60, 'diff {moved} {cell}')])
def test_lines_are_as_long_as_those_of_the_terminal(on_terminal, files, columns, arguments):
    cell = ROOT / 'examples/work_cell.sdf'
    moved = files / 'moved.sdf'
    moved.write_text(cell.read_text().replace(
        '<pose>-1.2 -1.5 0', '<pose>-1.23456 -1.6 0').replace(
        'attached_to="fixture::nest"', 'attached_to="gear_housing::grasp"'))
    text = on_terminal(columns, *(
        each.format(cell=cell, moved=moved) for each in arguments.split()))
    lines = [
        line for line in re.sub('\x1b\\[[0-9]*m', '', text).splitlines()
        # Where reading takes long, this says so, with a path that may be long.
        if not line.startswith('reading ')]
    assert len(lines) > 2
    assert max(map(len, lines)) <= columns


CHAIN = model_file(LINK + ''.join(
    posed('frame', f'{name}_with_a_name', f'{x} 0 0 0 0 0', before) for name, before, x in (
        ('a', 'l', 0.0004), ('b', 'a_with_a_name', 1.0014), ('c', 'b_with_a_name', 0.5))))


def table_of(text):
    return re.sub('\x1b\\[[0-9]*m', '', text).splitlines()


@pytest.mark.parametrize(('columns', 'x'), [
    (80, ['0.0000', '0.0004', '1.0018', '1.5018']),
    (200, ['0.0000', '0.0004', '1.0018', '1.5018']),
    # There is no room for more digits.
    (60, ['0.000', '0.0004', '1.002', '1.502'])])
def test_lengths_have_the_digits_that_the_smallest_one_needs(on_terminal, files, columns, x):
    (files / 'chain.sdf').write_text(CHAIN)
    lines = table_of(on_terminal(columns, 'poses', 'chain.sdf', '--kinds', 'link,frame'))
    assert [line.split()[-6] for line in lines[1:]] == x


def test_digits_that_are_asked_for(run_main, files):
    (files / 'chain.sdf').write_text(CHAIN)
    done = run_main('tree', 'chain.sdf', '--digits', '7')
    assert ' 0.0004000 ' in done.stdout
    assert ' 0.0000000\n' in done.stdout


def test_guides_stay_in_60_columns_and_names_stay_different(on_terminal, files):
    names = [f'the_same_beginning_{number}_and_the_same_end' for number in range(9)]
    (files / 'arm.sdf').write_text(model_file(''.join(
        element('link', name) + (fixed_joint(f'j{number}', names[number - 1], name)
                                 if number else '') for number, name in enumerate(names))))
    lines = table_of(on_terminal(60, 'tree', 'arm.sdf', '--kinds', 'link'))
    assert max(map(len, lines)) <= 60
    shown = [line[:18].rstrip() for line in lines[1:]]
    assert [text.index('t') for text in shown] == [*range(9)]
    assert {text[text.index('t') - 1] for text in shown[1:]} == {'└'}
    assert len({text.lstrip('└ ') for text in shown}) == 9


def test_shortened_names_differ(on_terminal, files):
    names = [f'the_same_beginning_{number}_and_the_same_end' for number in range(9)]
    (files / 'arm.sdf').write_text(model_file(''.join(element('link', each) for each in names)))
    lines = table_of(on_terminal(60, 'poses', 'arm.sdf', '--kinds', 'link'))
    assert len({line.split()[0] for line in lines[1:]}) == 9
    assert max(map(len, lines)) <= 60


def rows_of(done):
    return [*csv.DictReader(io.StringIO(done.stdout))]


def test_poses_as_csv_have_all_digits(run_main, files):
    (files / 'good.sdf').write_text((files / 'good.sdf').read_text().replace('1 2 3', '0.1 2 3'))
    rows = rows_of(run_main('poses', '--format', 'csv', '--kinds', 'link', 'good.sdf', 'bad.sdf'))
    assert rows == [{
        'file': 'good.sdf', 'world': 'w', 'kind': 'link', 'name': 'm::l', 'x': '1.1', 'y': '2.0',
        'z': '3.0', 'qx': '0.0', 'qy': '0.0', 'qz': '0.0', 'qw': '1.0'}]


def test_errors_do_not_stand_in_csv(run_main):
    done = run_main('poses', '--format', 'csv', 'bad.sdf')
    assert done.stdout.count('\n') == 1
    assert done.stderr.startswith('bad.sdf:3: ')


@pytest.mark.parametrize(('arguments', 'name', 'parent'), [
    ((), 'm/l', 'world'), (('--scope',), 'm::l', 'm')])
def test_tree_as_csv_names_parents(run_main, arguments, name, parent):
    rows = rows_of(run_main('tree', '--format', 'csv', *arguments, 'good.sdf'))
    (row,) = (row for row in rows if row['kind'] == 'link')
    assert (row['name'], row['parent']) == (name, parent)
    assert (row['x'], row['qw']) == (('2.0', '1.0') if parent == 'world' else ('0.0', '1.0'))


def test_tree_as_json_has_what_is_wrong(run_main):
    done = run_main('tree', '--format', 'json', 'bad.sdf', 'good.sdf')
    bad, good = map(json.loads, done.stdout.splitlines())
    assert (done.returncode, done.stderr) == (1, '')
    assert (len(bad['errors']), bad['frames']) == (2, [])
    assert good['frames'][0] == {
        'name': 'world', 'kind': 'root', 'parent': None, 'pose': None, 'note': ''}


def test_diff_as_csv_and_json(run_main, files):
    (files / 'new.sdf').write_text((files / 'good.sdf').read_text().replace('1 2 3', '1 2 3.5'))
    (row, *_) = rows_of(run_main('diff', '--format', 'csv', 'good.sdf', 'new.sdf'))
    assert (row['change'], row['name'], row['distance_m']) == ('moved', 'f', '0.5')
    done = run_main('diff', '--format', 'json', 'good.sdf', 'new.sdf')
    answer = json.loads(done.stdout)
    assert (done.returncode, answer['old'], answer['file']) == (1, 'good.sdf', 'new.sdf')
    assert answer['differences'][0]['distance_m'] == 0.5


def test_diff_as_json_has_the_errors_of_both_files(run_main):
    done = run_main('diff', '--format', 'json', 'bad.sdf', 'missing.sdf')
    assert done.returncode == 2
    assert {error['file'] for error in json.loads(done.stdout)['errors']} == {
        'bad.sdf', 'missing.sdf'}
