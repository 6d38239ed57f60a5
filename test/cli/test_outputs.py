# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Outputs are written whole, and replace no file that was read.

All options of all commands that take a text are tried as if they named an output.
"""

import argparse
import os
import stat
from threading import Thread

from commands import COMMANDS
from deadline import DEADLINE_S
import pytest
from sdf_texts import LINK, model_file

GIVEN = {'FILE': ['cell'], 'OLD': ['cell'], 'NEW': ['cell'], 'FRAME': ['m'], 'NUMBER': ['0'] * 6}
"""Values of the arguments that are no options; "cell" is the file that is read."""

WRITES_ITS_SOURCE = {'set'}
WRITERS = {('urdf', '-o'), ('gz_bridge', '-o'), ('graph', '-o'), ('view', '-o')}
"""The options that write."""


def cases():
    """Iterate over commands, and their options that take a text, with each ending that it has."""
    for name, parser in COMMANDS.items():
        for action in parser._actions:
            if action.option_strings and action.nargs != 0 and action.choices is None:
                try:
                    parser._get_value(action, 'x.out')
                    endings = ['.out']
                except argparse.ArgumentError as error:
                    _, _, listed = str(error).partition('must end with one of ')
                    endings = listed.split(', ') if listed else []
                for ending in endings:
                    yield name, action.option_strings[0], ending


OPTIONS = [*cases()]
OUTPUTS = [case for case in OPTIONS if case[:2] in WRITERS]


@pytest.fixture
def arguments(case, files, monkeypatch):
    """Returns the arguments of a command, with the option and its value, and the file to read."""
    name, option, ending = case
    if name == 'view':
        pytest.importorskip('viser', reason='needs viser')
    # Programs that may not be installed here.
    for program, script in (('dot', 'cat > /dev/null; echo graph'), ('chromium', (
            'for each; do case $each in --screenshot=*) echo page > "${each#*=}"; esac; done'))):
        path = files / 'bin' / program
        path.parent.mkdir(exist_ok=True)
        path.write_text(f'#!/bin/sh\n{script}\n')
        path.chmod(0o755)
    monkeypatch.setenv('PATH', f'{files}/bin:{os.environ["PATH"]}')
    (files / f'arm{ending}').write_text(model_file(LINK))
    (files / f'cell{ending}').write_text(model_file(
        f'{LINK}<include><name>arm</name><uri>arm{ending}</uri></include>'))

    def with_value(output, file=f'cell{ending}'):
        given = [each for action in COMMANDS[name]._actions if not action.option_strings
                 for each in GIVEN[action.metavar]]
        return [name, *(file if each == 'cell' else each for each in given), option, output]

    return with_value


@pytest.fixture
def output(arguments, case, files, run_main):
    """The path of an output, in a folder of its own, after the command was to write it."""
    folder = files / 'new'
    folder.mkdir()
    path = folder / f'output{case[2]}'
    run_main(*arguments(str(path)))
    return path


@pytest.mark.parametrize('case', OPTIONS, ids=' '.join)
def test_the_options_that_write_are_known(case, output):
    assert [*output.parent.iterdir()] == ([output] if case in OUTPUTS else [])


@pytest.mark.parametrize('case', OPTIONS, ids=' '.join)
def test_no_option_replaces_a_file_that_was_read(arguments, case, files, run_main):
    ending = case[2]
    sources = [files / f'{name}{ending}' for name in ('cell', 'arm')]
    before = [path.read_bytes() for path in sources]
    os.link(sources[0], files / f'hard{ending}')
    for name, source in (('link', 'cell'), ('link_to_part', 'arm')):
        (files / f'{name}{ending}').symlink_to(f'{source}{ending}')
    for name in ('cell', 'arm', 'hard', 'link', 'link_to_part'):
        done = run_main(*arguments(f'{name}{ending}'))
        if case[0] not in WRITES_ITS_SOURCE:
            assert [path.read_bytes() for path in sources] == before
        if case in OUTPUTS:
            assert (done.returncode, done.stdout) == (1, '')
            assert done.stderr == (
                f'{name}{ending}: FILE_WRITE: this file was read, so no output replaces it; name '
                'another one\n')
    if case in OUTPUTS:
        done = run_main(*arguments(f'cell{ending}', '-'), stdin=sources[0])
        assert 'FILE_WRITE: this file was read' in done.stderr
        assert [path.read_bytes() for path in sources] == before


@pytest.mark.parametrize('case', OUTPUTS, ids=' '.join)
def test_a_new_output_has_the_mode_of_new_files(output):
    plain = output.with_name('plain')
    plain.touch()
    assert output.stat().st_mode == plain.stat().st_mode
    assert output.stat().st_size > 0


@pytest.mark.parametrize('case', OUTPUTS, ids=' '.join)
def test_an_existing_output_is_replaced_whole_and_its_mode_stays(output, arguments, run_main):
    new = output.read_bytes()
    other = output.with_name('other')
    output.write_text('old')
    output.chmod(0o640)
    os.link(output, other)
    assert run_main(*arguments(str(output))).returncode == 0
    assert (output.read_bytes(), other.read_text()) == (new, 'old')
    assert stat.S_IMODE(output.stat().st_mode) == 0o640
    assert {*output.parent.iterdir()} == {output, other}


@pytest.mark.parametrize('case', OUTPUTS, ids=' '.join)
@pytest.mark.parametrize('exists', [True, False])
def test_of_a_link_the_target_is_replaced(output, arguments, run_main, exists):
    new = output.read_bytes()
    target = output.with_name('target')
    if exists:
        target.write_text('old')
    output.unlink()
    output.symlink_to('target')
    assert run_main(*arguments(str(output))).returncode == 0
    assert output.is_symlink()
    assert target.read_bytes() == new


@pytest.mark.parametrize('case', OUTPUTS, ids=' '.join)
def test_a_pipe_is_written_into(output, arguments, run_main):
    new = output.read_bytes()
    output.unlink()
    os.mkfifo(output)
    read = []
    reader = Thread(target=lambda: read.append(output.read_bytes()), daemon=True)
    reader.start()
    assert run_main(*arguments(str(output))).returncode == 0
    reader.join(DEADLINE_S)
    assert read == [new]
    assert stat.S_ISFIFO(output.stat().st_mode)


@pytest.mark.parametrize('end', ['', ' > log', ' >> log'])
def test_the_standard_output_is_written_into(sdf_pose_in_shell, files, end):
    (files / 'log').write_text('before\n')
    urdf = sdf_pose_in_shell('urdf good.sdf').stdout
    assert urdf
    done = sdf_pose_in_shell(f'urdf good.sdf -o /dev/stdout{end}')
    shown = (files / 'log').read_text() if 'log' in end else done.stdout
    assert shown == ('before\n' if '>>' in end else '') + urdf
