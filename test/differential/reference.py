# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What libsdformat makes of a file, through the program beside this module."""

from __future__ import annotations

from dataclasses import dataclass, field
import json
from pathlib import Path
import shutil
import subprocess
from typing import NamedTuple, TypeAlias

SOURCE = Path(__file__).with_name('print_poses.cpp')
RELEASES = ('sdformat14', 'sdformat15', 'sdformat')
"""Names by which pkg-config may know libsdformat, which has no number from 16 on; the first that
is found is used."""

CRASH = 'CRASH'
EXCEPTION = 'EXCEPTION'
"""The code of an exception that leaves libsdformat."""

Key: TypeAlias = tuple[str, str, str]
"""World, kind and scoped name of an element."""

PoseValues: TypeAlias = tuple[float, ...]
"""x y z in metres, quaternion x y z w."""


class AxisValues(NamedTuple):
    """An axis of a joint."""

    xyz: tuple[float, ...]
    """Unit vector in the frame of the joint."""
    limits: tuple[float, ...]
    mimic: tuple[object, ...] | None
    """Scoped name of the leader, ``axis`` or ``axis2``, multiplier, offset and reference."""


class JointValues(NamedTuple):
    """A joint."""

    type: str
    parent: str
    """Scoped name of the body; ``world`` for the world."""
    child: str
    pitch_m: float
    axes: tuple[AxisValues | None, ...]


JOINT_TYPES = ('', 'ball', 'continuous', 'fixed', 'gearbox', 'prismatic', 'revolute', 'revolute2',
               'screw', 'universal')
"""The types by their numbers in ``sdf::JointType``."""


@dataclass(frozen=True)
class Answer:
    """What one side makes of a file."""

    accepted: bool
    codes: tuple[str, ...]
    """Codes of the errors, in the order in which they were found."""
    message: str
    poses: dict[Key, PoseValues]
    joints: dict[tuple[str, str], JointValues] = field(default_factory=dict)
    """By world and scoped name; those whose ends and axes can be resolved."""


class ReferenceMissingError(Exception):
    """libsdformat or what it takes to compile for it is not installed."""


@dataclass(frozen=True)
class Reference:
    """The compiled program."""

    program: Path
    version: str
    """Of libsdformat, such as ``14.9.0``."""

    def answers(self, files, resource_path):
        """
        Resolve files.

        :param files: absolute paths without line ends in them.
        :param resource_path: folder in which libsdformat looks for what they include.
        :return: one answer for each file; a file on which libsdformat crashes has ``CRASH``.
        """
        process = self.start(files, resource_path)
        return self.finish(process, files, resource_path)

    def start(self, files, resource_path):
        """Start resolving files in a process of their own; see :meth:`finish`."""
        # Answers go to a file: a pipe that nobody reads yet would fill up and stop the program.
        output = (resource_path / 'answers.jsonl').open('w+', encoding='utf-8')
        names = resource_path / 'names.txt'
        names.write_text(''.join(f'{file}\n' for file in files), encoding='utf-8')
        with names.open(encoding='utf-8') as listed:
            process = subprocess.Popen(
                [str(self.program), '-I', str(resource_path), '-'], cwd=resource_path, text=True,
                stdin=listed, stdout=output, stderr=subprocess.DEVNULL)
        output.close()
        return process

    def finish(self, process, files, resource_path):
        """Wait for the answers of a process that :meth:`start` made."""
        process.wait()
        text = (resource_path / 'answers.jsonl').read_text(encoding='utf-8', errors='replace')
        answers = [answer_from_json(line) for line in text.splitlines() if line.endswith('}')]
        files = list(files)
        if len(answers) < len(files):
            crashed = Answer(False, (CRASH,), f'exit code {process.returncode}', {})
            rest = files[len(answers) + 1:]
            answers += [crashed, *(self.answers(rest, resource_path) if rest else ())]
        return answers


def answer_from_json(line):
    """Read one line of the program's output."""
    fields = json.loads(line)
    errors = fields['errors']
    return Answer(
        accepted=fields['ok'],
        codes=tuple(error['code'] for error in errors),
        message=errors[0]['message'] if errors else '',
        poses={(element['world'], element['kind'], element['name']): tuple(element['pose'])
               for element in fields['elements']},
        joints={(joint['world'], joint['name']): joint_from_json(joint)
                for joint in fields['joints']},
    )


def joint_from_json(fields):
    """Read one joint of the program's output."""
    axes = tuple(
        axis and AxisValues(
            tuple(axis['xyz']), tuple(axis['limits']), axis['mimic'] and tuple(axis['mimic']))
        for axis in fields['axes'])
    return JointValues(
        JOINT_TYPES[fields['type']], fields['parent'], fields['child'], fields['pitch'], axes)


def built_reference(folder):
    """
    Compile the program, unless that was done since it last changed.

    :param folder: where it is kept; made if it does not exist.
    :return: the program.
    :raises ReferenceMissingError: with a sentence that says what to install.
    """
    compiler = shutil.which('g++') or shutil.which('c++')
    pkg_config = shutil.which('pkg-config')
    advice = 'install it with "apt install libsdformat-dev g++ pkg-config"'
    if pkg_config is None or compiler is None:
        missing = 'a C++ compiler' if pkg_config else 'pkg-config'
        msg = f'{missing}, which compiling for libsdformat takes, is not installed; {advice}'
        raise ReferenceMissingError(msg)
    for release in RELEASES:
        found = subprocess.run([pkg_config, '--modversion', release], capture_output=True,
                               text=True, check=False)
        if found.returncode == 0:
            break
    else:
        msg = f'libsdformat 14 or later is not installed; {advice}'
        raise ReferenceMissingError(msg)
    version = found.stdout.strip()
    program = folder.resolve() / f'print_poses-{version}'
    if not program.exists() or program.stat().st_mtime < SOURCE.stat().st_mtime:
        folder.mkdir(parents=True, exist_ok=True)
        flags = subprocess.run([pkg_config, '--cflags', '--libs', release], capture_output=True,
                               text=True, check=True).stdout.split()
        unfinished = program.with_suffix('.new')
        subprocess.run([compiler, '-std=c++17', '-O1', '-o', str(unfinished), str(SOURCE), *flags],
                       check=True)
        unfinished.replace(program)
    return Reference(program, version)
