# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of tests that run the command line as a process."""

import contextlib
import fcntl
import io
import os
from pathlib import Path
import pty
import shlex
import struct
import termios
from types import SimpleNamespace

from command_line import COMMAND, completed, ENVIRONMENT
from deadline import DEADLINE_S
from processes import started
import pytest

from sdf_pose_bridge.cli.main import main, new_parser

GOOD = """<sdf version="1.10">
  <world name="w">
    <frame name="f"><pose>1 2 3 0 0 0</pose></frame>
    <model name="m"><pose relative_to="f">1 0 0 0 0 0</pose><link name="l"/></model>
  </world>
</sdf>
"""
BAD = GOOD.replace('relative_to="f"', 'relative_to="ff"').replace('1 2 3', '1 2')
WARNED = GOOD.replace('<link name="l"/>', """<link name="l">
      <light name="lamp" type="point"><pose relative_to="nowhere"/></light>
    </link>""")


@pytest.fixture
def files(tmp_path):
    """Folder with a valid file, an invalid one and one with a warning."""
    for name, text in (('good', GOOD), ('bad', BAD), ('warned', WARNED)):
        (tmp_path / f'{name}.sdf').write_text(text)
    return tmp_path


@pytest.fixture
def options(files, monkeypatch):
    """Parses arguments of ``sdf_pose tree`` there: ``options('--kinds', 'link', 'good.sdf')``."""
    monkeypatch.chdir(files)
    return lambda *arguments: new_parser().parse_args(['tree', *arguments])


@pytest.fixture
def sdf_pose_in_shell(files):
    """Runs the installed one there from a shell: ``sdf_pose_in_shell('arguments > output')``."""
    def run(command, before='', **environment):
        return completed(
            f'{before} {shlex.join(map(str, COMMAND))} {command}', shell=True, cwd=files,
            env={**ENVIRONMENT, **environment})
    return run


@pytest.fixture
def on_terminal(files):
    """Runs it on a terminal of some columns: ``on_terminal(80, *arguments, **environment)``."""
    def run(columns, *arguments, typed='', **environment):
        reader, writer = pty.openpty()
        os.write(reader, typed.encode())
        fcntl.ioctl(writer, termios.TIOCSWINSZ, struct.pack('4H', 24, columns, 0, 0))
        with os.fdopen(reader, 'rb') as output, started(
                [*COMMAND, *arguments], cwd=files, env={**ENVIRONMENT, **environment},
                stdin=writer, stdout=writer, stderr=writer) as process:
            os.close(writer)
            text = b''
            # Linux reports the end of a terminal as an error.
            with contextlib.suppress(OSError):
                while part := output.read1():
                    text += part
            process.wait(timeout=DEADLINE_S)
        return text.decode().replace('\r\n', '\n')
    return run


@pytest.fixture
def run_main(files, monkeypatch, capsys):
    """Runs the command line in that folder, but in this process."""
    monkeypatch.chdir(files)

    def run(*arguments, stdin=os.devnull):
        before = os.dup(0)
        with Path(stdin).open('rb') as file:
            os.dup2(file.fileno(), 0)
        try:
            code = main(arguments)
        except SystemExit as stop:
            code = stop.code
        finally:
            os.dup2(before, 0)
            os.close(before)
        out, err = capsys.readouterr()
        return SimpleNamespace(returncode=code, stdout=out, stderr=err)
    return run


@pytest.fixture
def run_on(run_main, files):
    """Runs a command on a file with this text: ``run_on(text, 'poses', *arguments)``."""
    def run(text, command, *arguments):
        (files / 'model.sdf').write_text(text)
        return run_main(command, 'model.sdf', *arguments)
    return run


@pytest.fixture
def refused(run_main):
    """Runs a command that must print one line of errors alone; returns it."""
    def run(*arguments):
        done = run_main(*arguments)
        assert (done.returncode, done.stdout) == (1, '')
        (line,) = done.stderr.splitlines()
        return line
    return run


@pytest.fixture
def convert(capsys, monkeypatch):
    """Run the command with arguments and lines; return exit code, output and errors."""
    def run(*arguments, lines='', stdin=None):
        monkeypatch.setattr('sys.stdin', stdin or io.StringIO(lines))
        try:
            code = main(['convert', *arguments])
        except SystemExit as stop:
            code = stop.code
        out, err = capsys.readouterr()
        return code, out, err
    return run
