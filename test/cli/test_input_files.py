# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a command."""

import contextlib
import os
import pty
import re
import subprocess

from command_line import COMMAND, ENVIRONMENT
from deadline import DEADLINE_S
from processes import started
import pytest
from sdf_texts import model_file

from sdf_pose_bridge import SdfError
from sdf_pose_bridge.cli.input_files import load_file, scene_of, told_on_terminal
from sdf_pose_bridge.sdformat.limits import FOLLOWED


def test_a_terminal_is_read_to_its_end(on_terminal):
    # Ctrl-D ends the input at the beginning of a line.
    text = on_terminal(80, 'check', '-', typed='<sdf>\n</sdf>\n\x04', NO_COLOR='1')
    assert text.splitlines()[-1].startswith('<stdin>:1: FILE_READ: <sdf> declares no version')


def test_an_invalid_file_has_errors_and_no_scene(options):
    scene, errors, _ = load_file('bad.sdf', options('bad.sdf'))
    assert scene is None
    assert [error.line for error in errors] == [3, 4]


def test_a_command_that_needs_a_scene_ends_with_the_errors_of_its_file(options):
    with pytest.raises(SdfError) as error:
        scene_of('bad.sdf', options('bad.sdf'))
    assert [each.line for each in error.value.errors] == [3, 4]


def test_a_long_load_tells_bytes_and_elements_on_a_terminal_until_it_ends(files):
    count = 100_000
    frames = ''.join(f'<frame name="f{number}"/>' for number in range(count))
    begin = b'<sdf version="1.9">'.ljust(600_000)
    rest = f'<model name="m"><link name="l"/>{frames}</model></sdf>'.encode()
    reader, writer = pty.openpty()
    with os.fdopen(reader, 'rb') as terminal, started(
            [*COMMAND, 'check', '-'], cwd=files, env=ENVIRONMENT, stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL, stderr=writer) as process:
        os.close(writer)
        told = terminal.read1()
        assert told == b'\x1b[K\x1b[?7lread 0.0 MB and 0 elements of -\x1b[?7h\r'
        process.stdin.write(begin)
        process.stdin.flush()
        while b' 0.6 MB and 0 ' not in told:
            told += terminal.read1()
        process.stdin.write(rest)
        process.stdin.close()
        # Linux reports the end of a terminal as an error.
        with contextlib.suppress(OSError):
            while part := terminal.read1():
                told += part
        process.wait(DEADLINE_S)
    assert process.returncode == 0
    size = f'{1e-6 * len(begin + rest):.1f} MB'
    counts = [int(each.replace(',', '')) for each in re.findall(
        rf'read {size} and ([0-9,]+) elements', told.decode())]
    assert counts == sorted({*counts})
    assert 0 < counts[-1] <= count + 3
    assert told.endswith(b' of -\x1b[?7h\r\x1b[K')


def test_a_load_in_another_process_is_told_on_the_terminal(files):
    pytest.importorskip('viser', reason='needs viser')
    reader, writer = pty.openpty()
    with os.fdopen(reader, 'rb') as terminal, started(
            [*COMMAND, 'view', '-', '-o', 'page.html'], cwd=files, env=ENVIRONMENT,
            stdin=subprocess.PIPE, stderr=writer) as process:
        os.close(writer)
        assert b'read 0.0 MB and 0 elements of -' in terminal.read1()
        process.communicate((files / 'good.sdf').read_bytes(), timeout=DEADLINE_S)
        assert terminal.read1() == b'\x1b[K'
    assert process.returncode == 0


def test_a_load_without_a_terminal_is_not_followed(tmp_path):
    with (tmp_path / 'log').open('w') as log, told_on_terminal('a.sdf', log.fileno()):
        assert FOLLOWED.get() is None


@pytest.mark.parametrize(('path', 'cure'), [
    ('.', 'name a file in it'), ('$HOME/cell.sdf', '$ and ~ stay as they are'),
    ('~/cell.sdf', '$ and ~ stay as they are'), ('model://table', 'this is a URI')])
def test_a_path_that_the_shell_left_as_it_is_has_a_cure(options, path, cure):
    _, (error,), _ = load_file(path, options('good.sdf'))
    assert cure in error.message


def test_frames_that_would_share_an_id_are_found_by_their_names_in_sdf(run_on):
    clash = model_file('<link name="a/b"/><model name="a"><link name="b"/></model>')
    done = run_on(clash, 'set', '--dry-run', 'm::a::b', *'100000')
    assert (done.returncode, done.stderr) == (0, '')


def test_warnings_about_gazebo_are_counted(run_main, files):
    moments = ' '.join(f'i{axes}="0"' for axes in ('xx', 'xy', 'xz', 'yy', 'yz'))
    (files / 'r.urdf').write_text(
        '<robot name="r"><link name="l"><inertial><mass value="1"/>'
        f'<inertia {moments} izz="1"/></inertial></link></robot>')
    done = run_main('tree', 'r.urdf')
    assert (done.returncode, done.stderr) == (
        0, 'r.urdf: "sdf_pose check" has 1 warning about Gazebo\n')
    assert 'LINK_INERTIA_INVALID' in run_main('check', 'r.urdf').stdout


@pytest.mark.parametrize('command', [
    ('check', '-'), ('poses', '-'), ('tree', '-'), ('graph', '-'), ('diff', '-', 'good.sdf')])
def test_standard_input_is_read(run_main, command):
    done = run_main(*command, stdin='good.sdf')
    assert (done.returncode, done.stderr) == (0, '')


def test_errors_of_the_standard_input_name_it(run_main):
    done = run_main('check', '-', stdin='bad.sdf')
    assert done.stdout.startswith('<stdin>:3: ELEMENT_INVALID: ')


def test_includes_of_the_standard_input_are_searched_in_the_working_directory(sdf_pose_in_shell):
    done = sdf_pose_in_shell(
        'check - <<EOF\n<sdf version="1.9"><include><uri>box.sdf</uri></include></sdf>\nEOF')
    assert '"box.sdf" cannot be included: it is not in "."; ' in done.stdout


@pytest.mark.parametrize('command', ['set - f 1 2 3 0 0 0', 'view --edit -'])
def test_standard_input_cannot_be_changed(run_main, command):
    done = run_main(*command.split(), stdin='good.sdf')
    assert done.returncode == 1
    assert 'the standard input cannot be changed' in done.stderr
