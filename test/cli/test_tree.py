# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose tree``: the TF tree and the tree of scopes."""

import pytest
from sdf_texts import fixed_joint, model_file

ARM = """
    <sdf version="1.9">
      <model name="arm">
        <frame name="tip" attached_to="hand"><pose relative_to="base">0 0 1 0 0 0</pose></frame>
        <link name="base"/>
        <link name="hand"><pose>0.5 0 0 0 0 1.5707963267948966</pose></link>
        <joint name="j" type="revolute"><parent>base</parent><child>hand</child><axis/></joint>
      </model>
    </sdf>"""


@pytest.fixture
def tree(run_on):
    """Lines that ``sdf_pose tree`` prints for the arm, without its head."""
    def lines(*arguments):
        done = run_on(ARM, 'tree', *arguments)
        assert (done.returncode, done.stderr) == (0, '')
        return done.stdout.splitlines()[1:]
    return lines


def names_in(lines):
    return [line.lstrip(' │├└─|`-').split()[0] for line in lines]


def test_invalid_file_is_reported_and_the_next_one_printed(run_main):
    done = run_main('tree', 'bad.sdf', 'good.sdf')
    assert done.returncode == 1
    assert done.stderr.startswith('bad.sdf:3: ELEMENT_INVALID: ')
    assert done.stdout.startswith('good.sdf\n')


@pytest.mark.parametrize('option', [(), ('--scope',)])
def test_unknown_model_is_an_error(refused, option):
    assert 'there is no model "n"' in refused('tree', '--model', 'n', *option, 'good.sdf')


@pytest.mark.parametrize('depth', ['-1', 'x'])
def test_depth_must_be_a_number_of_levels(run_main, depth):
    done = run_main('tree', f'--depth={depth}', 'good.sdf')
    assert done.returncode == 2
    assert f'"{depth}" is not a number of levels' in done.stderr


@pytest.mark.parametrize(('options', 'count'), [((), 3), (('--scope',), 4)])
def test_name_cannot_forge_a_line(run_on, options, count):
    done = run_on(model_file('<link name="a&#10;b\x9b"/>'), 'tree', *options)
    assert r'a\nb\x9b ' in done.stdout
    assert len(done.stdout.splitlines()) == count


def test_frames_are_below_their_parents(tree):
    lines = tree()
    assert [line[:7].rstrip() for line in lines] == ['base', '├ arm', '└ hand', '  └ tip']


@pytest.mark.parametrize(('options', 'pose'), [
    ((), ['0.500', '0.000', '0.000', '0.0', '0.0', '90.0']),
    (('--mm', '--radians'), ['500', '0', '0', '0.000', '0.000', '1.571'])])
def test_pose_is_in_the_parent(tree, options, pose):
    hand = next(line for line in tree(*options) if ' hand ' in line)
    assert hand.split()[-6:] == pose


@pytest.mark.parametrize(('options', 'names'), [
    ('--scope --kinds model,frame,link', '__root__ arm tip attached base hand'),
    ('--scope --kinds link', '__root__ base hand'),
    ('--match ti?', 'base hand tip'), ('--match arm', 'base arm'),
])
def test_elements_are_below_those_that_hold_them(tree, options, names):
    assert names_in(tree(*options.split())) == names.split()


def test_scope_says_what_poses_are_relative_to(tree):
    lines = tree('--scope')
    assert lines[2].startswith('  ├ tip ')
    assert lines[2].split()[2:6] == ['frame', '0.000', '0.000', '1.000']
    assert lines[3] == '  │   attached to arm::hand, relative to arm::base'
    assert lines[7] == '      revolute: arm::base -> arm::hand'


def test_scope_has_worlds_that_are_empty(run_on):
    text = '<sdf version="1.10"><world name="v"/><world name="w"/></sdf>'
    done = run_on(text, 'tree', '--scope')
    assert names_in(done.stdout.splitlines()[1:]) == ['v', 'w']


def test_depth_hides_what_is_deeper_and_says_how_much(tree):
    lines = tree('--depth', '1')
    assert names_in(lines) == ['base', 'arm', 'hand', '1']
    assert lines[3].endswith('  1 more below')


def test_match_of_nothing_is_reported(run_main):
    done = run_main('tree', 'good.sdf', '--match', 'nothing')
    assert (done.stdout, done.stderr) == (
        '', 'sdf_pose tree: no whole name in good.sdf matches "nothing"\n')


def test_terminal_without_the_characters_has_others(sdf_pose_in_shell, files):
    (files / 'arm.sdf').write_text(ARM)
    assert '\n`-hand' in sdf_pose_in_shell('tree arm.sdf', PYTHONIOENCODING='ascii').stdout


@pytest.mark.parametrize('environment', [{}, {'NO_COLOR': '1'}])
def test_terminal_has_colors_unless_the_user_wants_none(on_terminal, environment):
    assert ('\x1b' in on_terminal(80, 'tree', 'good.sdf', **environment)) is not bool(environment)


def test_chain_of_thousands_of_links_is_printed(run_on):
    count = 2000
    links = ''.join(f'<link name="l{number}"/>' for number in range(count))
    joints = ''.join(
        fixed_joint(f'j{number}', f'l{number}', f'l{number + 1}') for number in range(count - 1))
    lines = run_on(model_file(links + joints), 'tree').stdout.splitlines()
    assert len(lines) == count + 2
    assert max(map(len, lines)) < 250
