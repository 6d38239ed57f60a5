# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find the file that ``sdf_file`` names: a path, or a URI that says where to look."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
import re
from urllib.parse import unquote
from urllib.parse import urlsplit

_SCHEME = re.compile(r'[A-Za-z][A-Za-z0-9+.-]+(?=:/)')


class AddressError(ValueError):
    """An address that names no file."""


def path_from_address(
    address: str,
    share_directory: Callable[[str], str],
    resource_path: Callable[[str], str | None],
) -> Path:
    """
    Return the path that an address stands for.

    :param address: an absolute path, a path relative to the working directory (``~`` is the home
        directory), ``file:///absolute/path``, ``package://name/path`` relative to a package's
        share directory, or ``model://name/path`` relative to a directory that is searched for
        models. Per cent escapes are undone in the first two kinds of URI.
    :param share_directory: gives a package's share directory by its name, and raises LookupError
        for one that is not installed.
    :param resource_path: finds what a ``model://`` URI names, or returns None.
    :return: an absolute path; whether a file is there is not looked at.
    :raises AddressError: for other URIs, and for packages and models that are not there.
    """
    scheme = _SCHEME.match(address)
    if scheme is None:
        return Path(address).expanduser().absolute()
    try:
        parts = urlsplit(address)
    except ValueError as error:
        msg = f'"{address}" is no URI: {error}'
        raise AddressError(msg) from error
    path = unquote(parts.path)
    # Only these two characters end a path in a URI, and both may stand in a file's name.
    if parts.query or parts.fragment:
        msg = f'"{address}" has a "?" or "#" in it; write %3F or %23 in a URI'
        raise AddressError(msg)
    if parts.scheme == 'file':
        if parts.netloc not in ('', 'localhost'):
            msg = (f'"{address}" names the host "{parts.netloc}"; a file:// URI has three slashes '
                   f'before an absolute path')
            raise AddressError(msg)
        return Path(path)
    if parts.scheme == 'package':
        try:
            return Path(share_directory(parts.netloc), path.lstrip('/')).absolute()
        except (LookupError, ValueError) as error:
            msg = f'"{address}" names the package "{parts.netloc}", which is not installed here'
            raise AddressError(msg) from error
    if parts.scheme == 'model':
        found = resource_path(address)
        if found is None:
            msg = (f'"{address}" is found neither in resource_paths nor in the directories of '
                   f'GZ_SIM_RESOURCE_PATH and SDF_PATH')
            raise AddressError(msg)
        return Path(found).absolute()
    msg = (f'"{address}" is a {parts.scheme}:// URI; it must be a path, or a file://, package:// '
           f'or model:// URI')
    raise AddressError(msg)
