# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The time of each command grows with what it is given, and not faster."""

import argparse
import contextlib
from functools import partial
import io
from pathlib import Path

from commands import COMMANDS
from growth.commands import plain, ROWS
from growth.turns import fault_of_growth
import pytest

from sdf_pose_bridge.cli.main import main


def exit_code(monkeypatch, arguments, stdin=''):
    monkeypatch.setattr('sys.stdin', io.StringIO(stdin))
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        return main(arguments)


def test_each_command_and_each_option_that_repeats_has_a_row():
    assert {*ROWS} == {*COMMANDS}
    assert all(ROWS.values())
    repeated = {
        option for parser in COMMANDS.values() for action in parser._actions
        for option in action.option_strings
        if isinstance(action, argparse._AppendAction) or action.nargs in ('+', '*')}
    given = {text.partition('=')[0] for rows in ROWS.values() for _, run_of in rows.values()
             for text in run_of(2).arguments}
    assert repeated - given == set()


@pytest.mark.parametrize(('command', 'row'), [
    (command, row) for command, rows in ROWS.items() for row in rows])
def test_time_grows_with_what_a_command_is_given(tmp_path, monkeypatch, command, row):
    if command == 'view':
        pytest.importorskip('viser', reason='needs viser')
    n, run_of = ROWS[command][row]
    runs = [run_of(n), run_of(n // 2)]
    text = ''.join((*runs[0].arguments, *runs[0].files.values(), runs[0].stdin))
    # A plain file has as many elements or bytes; a link with its pose has 60.
    runs.append(plain(command, max(text.count('<') - text.count('</'), len(text) // 30) // 2))
    folders = [tmp_path / name for name in ('hostile', 'half', 'plain')]
    for folder, run in zip(folders, runs, strict=True):
        folder.mkdir()
        for name, content in run.files.items():
            (folder / name).write_text(content)

    def start(run, folder):
        monkeypatch.chdir(folder)
        assert exit_code(monkeypatch, [command, *run.arguments], run.stdin) < 2

    fault = fault_of_growth(*map(partial(partial, start), runs, folders))
    assert not fault, fault


@pytest.mark.parametrize('command', COMMANDS)
def test_time_grows_with_a_long_text_in_the_place_of_each_argument(tmp_path, monkeypatch, command):
    if command == 'view':
        pytest.importorskip('viser', reason='needs viser')
    given = plain(command, 2)
    monkeypatch.chdir(tmp_path)
    for name, content in given.files.items():
        Path(name).write_text(content)

    def start(n):
        text = '*a::' * (n // 4)
        usual = [command, *given.arguments]
        for arguments in ([command, text], *(
                [*usual[:i], text, *usual[i + 1:]] for i in range(len(usual))), *(
                [*usual, f'{option}={text}'] for action in COMMANDS[command]._actions
                if action.nargs != 0 for option in action.option_strings)):
            with contextlib.suppress(SystemExit):
                exit_code(monkeypatch, arguments, given.stdin)

    fault = fault_of_growth(*(partial(start, n) for n in (40_000, 20_000, 4)))
    assert not fault, fault
