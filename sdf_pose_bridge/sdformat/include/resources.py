# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find the files that includes name: search paths, ROS packages, the local Fuel cache."""

from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Mapping
import os
from pathlib import Path
import re
from typing import NamedTuple
from urllib.parse import unquote
from urllib.parse import urlsplit

_SCHEME = r'[A-Za-z][A-Za-z0-9+.-]*://'
_PATH_VARIABLES = ('GZ_SIM_RESOURCE_PATH', 'SDF_PATH')


class ResourceFinder(NamedTuple):
    """Where to look for what includes name."""

    search_paths: tuple[str, ...]
    """Looked through first, for every kind of URI."""
    environment_paths: tuple[str, ...]
    """Looked through after all but the working directory."""
    package_prefixes: tuple[str, ...]
    """Installation prefixes that hold ROS packages."""
    fuel_cache: str
    """Directory in which Gazebo keeps models that it downloaded."""

    def path_from_uri(self, uri: str, including_file: str) -> str | None:
        """
        Find a file or directory.

        In this order: the search paths; an absolute path; the share directory of a
        ``package://``; the Fuel cache for ``https://``; the including file's directory, for a
        relative path or ``file://``; the paths of the environment; the working directory.

        :param uri: such as ``model://box``, ``package://pkg/models/box`` or ``box.sdf``.
        :param including_file: path of the file that holds the include.
        :return: path of what was found, or None. Nothing is ever downloaded.
        """
        found = (os.fspath(path) for path in self._candidates(uri, including_file)
                 if _exists(path))
        return next(found, None)

    def _candidates(self, uri: str, including_file: str) -> Iterator[Path]:
        scheme = re.match(_SCHEME, uri)
        name = uri[scheme.end():] if scheme else uri
        scheme_name = scheme.group()[:-3].lower() if scheme else ''
        if scheme_name in ('http', 'https'):
            yield from self._in_fuel_cache(uri)
            return
        if not name:
            return
        # An absolute path replaces whatever it is joined to, so it comes out of every step.
        for directory in self.search_paths:
            yield Path(directory, name)
        if scheme_name == 'package':
            yield from self._in_packages(name)
        if scheme_name in ('', 'file'):
            yield Path(Path(including_file).parent, name)
        for directory in self.environment_paths:
            yield Path(directory, name)
        yield Path(name)

    def _in_packages(self, name: str) -> Iterator[Path]:
        package, _, rest = name.partition('/')
        for prefix in self.package_prefixes:
            share = Path(prefix, 'share', package)
            marker = Path(prefix, 'share', 'ament_index', 'resource_index', 'packages', package)
            if package and _exists(marker):
                yield share / rest

    def _in_fuel_cache(self, uri: str) -> Iterator[Path]:
        """
        Look a Fuel model up in the cache.

        Its URIs read ``https://SERVER/1.0/OWNER/models/NAME[/VERSION][/files/REST]``, the cache
        has ``SERVER/owner/models/name/VERSION/REST``.
        """
        try:
            parts = urlsplit(uri)
        except ValueError:  # a host with one square bracket
            return
        steps = [unquote(part) for part in parts.path.split('/') if part]
        if steps and re.fullmatch(r'[0-9]+\.[0-9]+', steps[0]):
            steps = steps[1:]
        if len(steps) < 3 or steps[1] != 'models' or '..' in steps:
            return
        version, rest = (steps[3] if len(steps) > 3 else 'tip'), steps[4:]
        model = Path(self.fuel_cache, parts.netloc)
        for part in steps[:3]:
            model = _entry_in_any_case(model, part)
        versions = [version]
        if version == 'tip' and _is_directory(model):
            numbers = [int(entry.name) for entry in model.iterdir() if entry.name.isdigit()]
            versions = [str(number) for number in sorted(numbers, reverse=True)]
        for candidate in versions:
            yield model.joinpath(candidate, *(rest[1:] if rest[:1] == ['files'] else rest))


def resource_finder(
    resource_paths: Iterable[str | os.PathLike[str]], environment: Mapping[str, str],
) -> ResourceFinder:
    """
    Read from the environment where to look.

    :param resource_paths: directories to look through first.
    :param environment: such as ``os.environ``: ``GZ_SIM_RESOURCE_PATH``, ``SDF_PATH``,
        ``AMENT_PREFIX_PATH``, ``GZ_FUEL_CACHE_PATH`` and ``HOME``.
    :return: the finder.
    """
    def paths(variable: str) -> list[str]:
        return [path for path in environment.get(variable, '').split(os.pathsep) if path]

    home = environment.get('HOME', '~')
    return ResourceFinder(
        tuple(os.fspath(path) for path in resource_paths),
        tuple(path for variable in _PATH_VARIABLES for path in paths(variable)),
        tuple(paths('AMENT_PREFIX_PATH')),
        environment.get('GZ_FUEL_CACHE_PATH') or os.path.join(home, '.gz', 'fuel'),  # noqa: PTH118
    )


# Those of Path raise an error for names that are too long, and what may not be looked at.


def _exists(path: Path) -> bool:
    return os.path.exists(path)  # noqa: PTH110


def _is_directory(path: Path) -> bool:
    return os.path.isdir(path)  # noqa: PTH112


def _entry_in_any_case(directory: Path, name: str) -> Path:
    """Return the entry of a name; Gazebo's cache writes owners and models in lower case."""
    plain = directory / name
    if _exists(plain) or not _is_directory(directory):
        return plain
    for entry in directory.iterdir():
        if entry.name.lower() == name.lower():
            return entry
    return plain
