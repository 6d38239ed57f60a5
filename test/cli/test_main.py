# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line as a process: wrong arguments, exit codes and closed pipes."""

import re
import subprocess
import sys
import xml.etree.ElementTree as ET

from command_line import COMMAND, completed, ENVIRONMENT
from deadline import DEADLINE_S
from folders import ROOT
import pytest
from sdf_texts import model_file, write_files


def test_without_a_command_all_are_listed_with_a_line_each(run_main):
    done = run_main()
    assert (done.returncode, done.stderr) == (0, '')
    listed = re.findall(r'^    ([a-z_]+) +\S.*$', done.stdout, re.MULTILINE)
    modules = (ROOT / 'sdf_pose_bridge/cli').glob('*.py')
    assert set(listed) == {
        module.stem for module in modules if '\nHELP = ' in module.read_text()}


def test_version(sdf_pose_in_shell):
    done = sdf_pose_in_shell('--version')
    version = ET.parse(ROOT / 'package.xml').getroot().findtext('version')
    assert (done.returncode, done.stdout, done.stderr) == (0, f'sdf_pose {version}\n', '')


def test_the_shell_completes_commands(files):
    pytest.importorskip('argcomplete', reason='needs argcomplete')
    line = 'sdf_pose ch'
    environment = {
        **ENVIRONMENT, '_ARGCOMPLETE': '1', '_ARGCOMPLETE_STDOUT_FILENAME': str(files / 'answer'),
        'COMP_LINE': line, 'COMP_POINT': str(len(line))}
    subprocess.run(COMMAND, env=environment, cwd=files, check=True, timeout=DEADLINE_S)
    assert (files / 'answer').read_text().split() == ['check']


def test_an_unknown_command_is_an_error_that_lists_the_known_ones(run_main):
    done = run_main('chekc')
    assert done.returncode == 2
    assert all(name in done.stderr for name in ('poses', 'convert', 'did you mean "check"?'))


def test_an_option_is_not_abbreviated(run_main):
    done = run_main('check', 'good.sdf', '--stric')
    assert (done.returncode, done.stdout) == (2, '')
    assert 'unrecognized arguments: --stric; did you mean "--strict"?' in done.stderr
    assert done.stderr.startswith('usage: sdf_pose check ')


@pytest.mark.parametrize(('arguments', 'hint'), [
    # No option that forces is offered.
    ('set good.sdf f --frame g 1 2 3', '--frame\n'),
    ('set good.sdf f 1 2 3 --forc', '"--format"?\n'),
    ('graph good.sdf --format png', '; -o writes the format of the ending of a file\n'),
    ('view good.sdf --format=png', '; -o writes the format of the ending of a file\n'),
    ('good.sdf', '; did you mean "sdf_pose check good.sdf"?\n'), ('missing.sdf', ')\n')])
def test_hints_of_a_wrong_command_line(run_main, arguments, hint):
    done = run_main(*arguments.split())
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr.endswith(hint)


@pytest.fixture
def large_file(files):
    """The folder has a file of 200,000 links."""
    write_files(files, large=model_file(''.join(f'<link name="l{i}"/>' for i in range(200_000))))


LIMITED = """
import sys
from sdf_pose_bridge.cli import main
main.FOR_FILES = main.FOR_FILES._replace({}, seconds_per_megabyte=0, memory_bytes_per_megabyte=0)
sys.exit(main.main())
"""


@pytest.mark.parametrize(('limit', 'message'), [
    ('processor_s=0', r'sdf_pose tree: this needs more than \d+ s of processor time'),
    ('memory_bytes=10**7', 'sdf_pose tree: this needs more than 10 MB of memory'),
    # The parser has not enough memory.
    ('memory_bytes=5 * 10**7', 'sdf_pose tree: this needs more than 50 MB of memory'),
])
def test_a_file_that_needs_too_much_is_one_sentence(large_file, files, limit, message):
    done = completed(
        [sys.executable, '-c', LIMITED.format(limit), 'tree', 'large.sdf'], cwd=files,
        env=ENVIRONMENT)
    assert done.returncode == 1
    assert re.fullmatch(f'{message}\n', done.stderr)


def test_output_that_cannot_be_written_is_one_sentence(sdf_pose_in_shell):
    done = sdf_pose_in_shell('--version > /dev/full')
    assert done.stderr == (
        'sdf_pose: the output cannot be written: no space left on device\n')


def test_a_lack_of_memory_is_one_sentence(large_file, sdf_pose_in_shell):
    # Libraries alone have about 200 MB of addresses.
    done = sdf_pose_in_shell('tree large.sdf', 'ulimit -v 300000;', OPENBLAS_NUM_THREADS='1')
    assert done.returncode == 1
    assert done.stderr == 'sdf_pose tree: there is not enough memory\n'


def test_errors_of_a_file_are_printed_behind_what_was_printed_before(sdf_pose_in_shell):
    done = sdf_pose_in_shell('tree good.sdf bad.sdf 2>&1')
    assert done.returncode == 1
    first, *_, before_last, last = done.stdout.splitlines()
    assert first == 'good.sdf'
    assert before_last.startswith('bad.sdf:3: ELEMENT_INVALID: ')
    assert last.startswith('bad.sdf:4: ')


def test_a_closed_pipe_prints_no_error(sdf_pose_in_shell):
    assert sdf_pose_in_shell(f'poses {"good.sdf " * 2000}| head -1').stderr == ''
