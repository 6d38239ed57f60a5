# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Files that Fast DDS leaves in /dev/shm where its processes are killed."""

import contextlib
import os
from pathlib import Path
import re
import time

FOLDER = Path('/dev/shm')
FIRST_PORT, PORTS = 7400, 250
"""The first UDP port of domain 0, and the number of ports of each domain."""
_IS_COMPLETE = (2).to_bytes(4, 'little')


def _files_of_ports(domain, folder):
    for path in folder.glob('*fast*_port*'):
        found = re.fullmatch(r'(?:sem\.)?fast(?:dds|rtps)_port([0-9]+)(?:_.*)?', path.name)
        if found and (int(found[1]) - FIRST_PORT) // PORTS == domain:
            yield path


def remove_ports(domain, folder=FOLDER):
    """Remove the ports of a domain that no process uses."""
    for path in _files_of_ports(domain, folder):
        path.unlink(missing_ok=True)


def remove_incomplete_ports(domain, folder=FOLDER):
    """
    Remove the ports of a domain that a killed process had begun to create.

    Fast DDS waits for their completion without a limit. The first four bytes are the state that
    boost::interprocess sets to 2 when the memory can be used.
    """
    for path in _files_of_ports(domain, folder):
        if path.name[-1].isdigit():
            with contextlib.suppress(FileNotFoundError), path.open('rb') as file:
                if file.read(4) != _IS_COMPLETE:
                    path.unlink()


def remove_dead_segments(since_s, folder=FOLDER):
    """Remove the segments of this user's processes that were made since then and have ended."""
    def dead():
        # The sixth column is the device and the inode.
        lines = Path('/proc/locks').read_text(encoding='ascii').splitlines()
        locked = {line.split()[5].rpartition(':')[2] for line in lines if '->' not in line}
        for lock in folder.glob('fast*_*_el'):
            with contextlib.suppress(FileNotFoundError):
                status = lock.stat()
                if (status.st_uid == os.getuid() and status.st_mtime >= since_s
                        and '_port' not in lock.name and str(status.st_ino) not in locked):
                    yield lock

    if found := set(dead()):
        # A process locks a moment after it has created the file.
        time.sleep(0.1)
        for lock in found.intersection(dead()):
            for path in (lock, lock.with_name(lock.name.removesuffix('_el'))):
                path.unlink(missing_ok=True)
