# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Programs in Python that get signals at a place of their work instead of after some time."""

import os

_AT_PLACE = """
import os
import signal
import sys

pid, place, numbers = os.getpid(), os.environ['PLACE'], [*map(int, os.environ['SIGNALS'].split())]
passed = []
for number in numbers:
    # A parent may have ignored them.
    signal.signal(number, signal.SIG_IGN if os.environ['ARE_IGNORED'] else (
        signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL))


def send(event, arguments):
    if passed or f'{event} {"".join(map(str, arguments[:1]))}' == place:
        passed.append(place)
        # This is an event too.
        for number in () if event == 'os.kill' else numbers:
            os.kill(pid, number)


sys.addaudithook(send)
"""


def with_signals_at(place, numbers, folder, environment=os.environ, are_ignored=''):
    """
    Return the environment of a program that gets signals at a place, also one in its children.

    They come again at each event of Python that follows.

    :param place: an audit event of Python, and its first argument, such as ``import numpy``.
    :param folder: a folder for a module that Python imports first.
    """
    (folder / 'sitecustomize.py').write_text(_AT_PLACE)
    return {
        **environment, 'PLACE': place, 'SIGNALS': ' '.join(str(int(each)) for each in numbers),
        'PYTHONPATH': f'{folder}:{environment.get("PYTHONPATH", "")}', 'ARE_IGNORED': are_ignored}
