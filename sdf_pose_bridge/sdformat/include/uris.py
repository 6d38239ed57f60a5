# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the files that URIs name: in search paths, in ROS packages and in Gazebo's Fuel cache.

Nothing is ever downloaded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from itertools import islice
import os
from pathlib import Path
import re
import shlex
from typing import NamedTuple
from urllib.parse import unquote, urlsplit

from sdf_pose_bridge.errors import AddressError
from sdf_pose_bridge.nearest_names import NameIndex
from sdf_pose_bridge.printed_text import quoted_names
from sdf_pose_bridge.sdformat.include.manifests import MANIFEST
from sdf_pose_bridge.sdformat.templates import hint_about_missing_file

_SCHEME = re.compile(r'([A-Za-z][A-Za-z0-9+.-]*)://')
_SCHEME_OF_ADDRESS = re.compile(r'[A-Za-z][A-Za-z0-9+.-]+(?=:/)')
_WEB = ('http', 'https')
_FUEL_MODEL = re.compile(
    r'(?i)https?://[^/]{1,99}/([0-9.]+/)?[^/]{1,99}/models/[^/]{1,200}(/([0-9]+|tip))?(?=/|$)')
"""The address of a model, not too long for a message; a file in it cannot be fetched alone."""
_FUEL_HOSTS = ('fuel.gazebosim.org', 'fuel.ignitionrobotics.org', 'app.gazebosim.org')
"""Names of one server; Gazebo's cache has its models under the first, and older ones elsewhere."""
_SHARED = ('model', 'package')
"""Schemes of URIs that begin with the name of a model or package."""
_RELATIVE = ('', 'file')
"""Schemes of paths, which may be relative to the including file."""
_MODELS_OF_GAZEBO_CLASSIC = ('model://sun', 'model://ground_plane')

_MOST_LEVELS = 4
"""Number of directories around a file in which a model is searched for a message."""


class _Candidate(NamedTuple):
    """A path at which a file may be."""

    directory: str
    """A directory that is searched, or that of a model or package."""
    relative: str
    """The rest of the path; an absolute path replaces the directory."""
    is_owner: bool = False
    """Whether the directory is that of the model or package in the URI."""

    @property
    def path(self) -> str:
        return os.path.join(self.directory, self.relative)  # noqa: PTH118


def _entries(directory: str) -> list[str]:
    try:
        return os.listdir(directory or '.')  # noqa: PTH208
    except OSError:
        return []


def _index_of_entries(directories: tuple[str, ...]) -> NameIndex:
    """Return the names of all files and directories in some directories."""
    return NameIndex(entry for each in directories for entry in _entries(each))


class ResourceFinder(NamedTuple):
    """Finds files in the directories of the user's settings."""

    search_paths: tuple[str, ...]
    """Directories that are searched first, for every scheme."""
    environment_paths: tuple[str, ...]
    """Directories that are searched before the working directory, the last one."""
    package_prefixes: tuple[str, ...]
    """Installation prefixes of ROS packages."""
    fuel_cache: str
    """Directory of the models that Gazebo has downloaded."""
    index_of_entries: Callable[[tuple[str, ...]], NameIndex]
    """Returns the names in some directories for hints, each listed once."""

    def path_from_uri(self, uri: str, including_file: str) -> str | None:
        """
        Find a file or directory; return its path, or None.

        The order is: an absolute path, and the directory of the including file for a relative path
        or ``file://``; the search paths; the share directory of a package for ``package://``; the
        Fuel cache for ``https://``; the paths of the environment; for ``model://`` and
        ``package://`` the model or package of that name that the including file is in; the working
        directory.

        :param uri: such as ``model://box``, ``package://pkg/models/box`` or ``box.sdf``.
        """
        return next(self._paths(uri, including_file), None)

    def other_path_from_uri(self, uri: str, including_file: str) -> str | None:
        """Return the second file or directory that a relative path could mean, or None."""
        found = self._paths(uri, including_file) if _scheme_and_name(uri)[0] in _RELATIVE else ()
        real_paths = dict.fromkeys(map(os.path.realpath, found))
        return next(islice(real_paths, 1, None), None)

    def _paths(self, uri: str, including_file: str) -> Iterator[str]:
        paths = (candidate.path for candidate in self._candidates(uri, including_file))
        return (str(Path(path)) for path in paths if os.path.exists(path))  # noqa: PTH110

    def file_from_uri(self, uri: str, naming_file: str) -> str | None:
        """Find a file, such as a mesh, as :meth:`path_from_uri`, but no directory."""
        path = self.path_from_uri(uri, naming_file)
        return path if path is not None and os.path.isfile(path) else None  # noqa: PTH113

    def uri_for_others(self, uri: str, naming_file: str) -> str | None:
        """
        Return the URI of a file, such as a mesh, for programs with other search paths.

        :return: ``package://`` unchanged, since the package is elsewhere on another machine; else
            ``file://`` with an absolute path. None if there is no such file.
        """
        # ROS knows no third slash.
        if uri.startswith('package://') and not uri.startswith('package:///'):
            return uri
        path = self.file_from_uri(uri, naming_file)
        return None if path is None else Path(path).absolute().as_uri()

    def path_from_address(self, address: str) -> Path:
        """
        Return the path of a file from a user's address.

        :param address: an absolute path, a path relative to the working directory (``~`` is the
            home directory), ``file:///absolute/path``, ``package://name/path`` relative to the
            share directory of a package, or ``model://name/path`` relative to a directory that is
            searched for models. Per cent escapes are decoded in the first two kinds of URI.
        :return: an absolute path, which need not exist.
        :raises AddressError: for other URIs, and for packages and models that are not found.
        """
        if _SCHEME_OF_ADDRESS.match(address) is None:
            try:
                return Path(address).expanduser().absolute()
            except RuntimeError:
                msg = f'"{address}" begins with the name of a user who does not exist'
                raise AddressError(msg) from None
        try:
            parts = urlsplit(address)
        except ValueError as error:
            msg = f'"{address}" is not a URI: {error}'
            raise AddressError(msg) from error
        path = unquote(parts.path)
        if parts.query or parts.fragment:
            fault = 'has a "?" or "#" in it; write %3F or %23 in a URI'
        elif parts.scheme == 'file':
            if parts.netloc in ('', 'localhost'):
                return Path(path)
            fault = (f'names the host "{parts.netloc}"; a file:// URI has three slashes before an '
                     'absolute path')
        elif parts.scheme == 'package':
            for share in self._package_shares(parts.netloc):
                return Path(share, path.lstrip('/')).absolute()
            fault = f'names the package "{parts.netloc}", which is not installed here'
        elif parts.scheme == 'model':
            found = self.path_from_uri(address, including_file='')
            if found is not None:
                return Path(found).absolute()
            fault = ('is found neither in resource_paths nor in the directories of '
                     'GZ_SIM_RESOURCE_PATH and SDF_PATH')
        else:
            fault = (f'is a {parts.scheme}:// URI; it must be a path, or a file://, package:// or '
                     'model:// URI')
        msg = f'"{address}" {fault}'
        raise AddressError(msg)

    def reason_not_found(self, uri: str, including_file: str, *, has_hint: bool = True) -> str:
        """
        Return the reason why :meth:`path_from_uri` finds no path for a URI, with a remedy.

        :param has_hint: whether the remedy may be the nearest name.
        """
        scheme, name = _scheme_and_name(uri)
        if scheme in _WEB:
            reason, model = 'it is not in the cache of Gazebo Fuel', _FUEL_MODEL.match(uri)
            command = ['gz', 'fuel', 'download', '-u', model[0]] if model else []
            return f'{reason}; fetch it with: {shlex.join(command)}' if model else reason
        if uri in _MODELS_OF_GAZEBO_CLASSIC:
            return 'it comes with Gazebo Classic, and no frame needs it'
        folder, missing = self._deepest_folder(uri, including_file)
        if folder:
            hint = self._hint_about_missing(missing, (folder,), has_hint=has_hint)
            return f'"{folder}" has no "{missing}"{hint}'
        directories = [*dict.fromkeys(
            each.directory or '.' for each in self._candidates(uri, including_file)
            if not each.is_owner)] or ['.']
        reason = f'it is not in {quoted_names(directories)}'
        first, _, rest = name.lstrip('/').partition('/')
        if scheme == 'package':
            reason = f'no package "{first}" is installed, and {reason}'
        elsewhere = _directory_near(including_file, first)
        if elsewhere:
            return f'{reason}, but in "{elsewhere}"; add that to resource_paths'
        hint = '' if rest else self._hint_about_missing(
            first, tuple(directories), has_hint=has_hint)
        return f'{reason}; resource_paths and GZ_SIM_RESOURCE_PATH add directories{hint}'

    def _hint_about_missing(
        self, name: str, directories: tuple[str, ...], *, has_hint: bool,
    ) -> str:
        """Return the template of a missing file, or else the nearest name."""
        hints = (hint_about_missing_file(f'{each}/{name}') for each in directories)
        template = next(filter(None, hints), '')
        return template or (self.index_of_entries(directories).hint(name) if has_hint else '')

    def _deepest_folder(self, uri: str, including_file: str) -> tuple[str, str]:
        """
        Find the part of a URI that does not exist.

        :return: the folder in which it is missing, and its name; empty texts if not even the
            model, the package or the first folder exists.
        """
        deepest = 0
        found = '', ''
        for candidate in self._candidates(uri, including_file):
            directory, relative, is_owner = candidate
            folder = '/' if relative.startswith('/') else directory
            for depth, part in enumerate(filter(None, relative.split('/')), is_owner):
                path = os.path.join(folder, part)  # noqa: PTH118
                if not os.path.exists(path):  # noqa: PTH110
                    if depth > deepest:
                        deepest, found = depth, (folder, part)
                    break
                folder = path
        return found

    def _candidates(self, uri: str, including_file: str) -> Iterator[_Candidate]:
        scheme, name = _scheme_and_name(uri)
        if scheme in _WEB:
            for path in self._paths_in_fuel_cache(uri):
                yield _Candidate('', path)
            return
        if not name:
            return
        # Joined to another path, an absolute path is unchanged. A Path is made only of a path that
        # is found, as this takes long for a name with many slashes. Gazebo ignores a third slash.
        relative = name.lstrip('/') if scheme in _SHARED else name
        if scheme in _RELATIVE:
            yield _Candidate(os.path.dirname(including_file), name)  # noqa: PTH120
        for directory in self.search_paths:
            yield _Candidate(directory, relative)
        if scheme == 'package':
            package, _, rest = relative.partition('/')
            for share in self._package_shares(package):
                yield _Candidate(str(share), rest, is_owner=True)
        for directory in self.environment_paths:
            yield _Candidate(directory, relative)
        if scheme in _SHARED:
            owner, _, rest = relative.partition('/')
            for folder in Path(including_file).absolute().parents:
                if _is_root_of(folder, owner):
                    yield _Candidate(str(folder), rest, is_owner=True)
        yield _Candidate('', name)

    def _package_shares(self, package: str) -> Iterator[Path]:
        for prefix in self.package_prefixes:
            marker = Path(prefix, 'share', 'ament_index', 'resource_index', 'packages', package)
            if package and os.path.exists(marker):  # noqa: PTH110
                yield Path(prefix, 'share', package)

    def _paths_in_fuel_cache(self, uri: str) -> Iterator[str]:
        # The URI is https://SERVER/1.0/OWNER/models/NAME[/VERSION][/files/REST], and the cache has
        # the model as SERVER/owner/models/name/VERSION/REST.
        try:
            parts = urlsplit(uri)
        except ValueError:  # a host with one square bracket
            return
        steps = [unquote(part) for part in parts.path.split('/') if part]
        if steps and re.fullmatch(r'[0-9]+\.[0-9]+', steps[0]):
            steps = steps[1:]
        if steps[1:3] == ['fuel', 'models']:  # in addresses of its web pages
            del steps[1]
        # Without its per cent escapes, each step must be the name of one file.
        if len(steps) < 3 or steps[1] != 'models' or any(
                step in ('', '.', '..') or '/' in step or '\0' in step
                for step in (parts.netloc, *steps)):
            return
        version, *rest = steps[3:] or ['tip']
        for host in _FUEL_HOSTS if parts.netloc in _FUEL_HOSTS else (parts.netloc,):
            model = f'{self.fuel_cache}/{host}'
            for part in steps[:3]:
                model = _entry_in_any_case(model, part)
            versions = [version]
            if version == 'tip':
                numbers = [name for name in _entries(model) if name.isascii() and name.isdecimal()]
                versions = sorted(numbers, key=int, reverse=True)
            for candidate in versions:
                yield '/'.join([model, candidate, *(rest[1:] if rest[:1] == ['files'] else rest)])


def resource_finder(
    resource_paths: Iterable[str | os.PathLike[str]] = (),
    environment: Mapping[str, str] = os.environ,
) -> ResourceFinder:
    """Make a finder from directories to search first and an environment."""
    def paths(variable: str) -> list[str]:
        return [path for path in environment.get(variable, '').split(os.pathsep) if path]

    return ResourceFinder(
        tuple(os.fspath(path) for path in resource_paths),
        tuple(paths('GZ_SIM_RESOURCE_PATH') + paths('SDF_PATH')),
        tuple(paths('AMENT_PREFIX_PATH')),
        environment.get('GZ_FUEL_CACHE_PATH') or os.path.join(  # noqa: PTH118
            environment.get('HOME', '~'), '.gz', 'fuel'),
        cache(_index_of_entries))


def _scheme_and_name(uri: str) -> tuple[str, str]:
    scheme = _SCHEME.match(uri)
    return (scheme[1].lower(), uri[scheme.end():]) if scheme else ('', uri)


def _is_root_of(directory: Path, name: str) -> bool:
    """Return whether a directory is that of a model or a package."""
    manifest = directory / 'package.xml'
    try:
        return (directory.name == name and os.path.isfile(directory / MANIFEST)) or (  # noqa: PTH113
            manifest.is_file()
            and f'<name>{name}</name>' in manifest.read_text(errors='replace'))
    except OSError:
        return False


def _entry_in_any_case(directory: str, name: str) -> str:
    """Return the entry of a name; Gazebo writes owners and models in lower case."""
    if not os.path.exists(f'{directory}/{name}'):  # noqa: PTH110
        entries = _entries(directory)
        name = next((entry for entry in entries if entry.lower() == name.lower()), name)
    return f'{directory}/{name}'


def _directory_near(file: str, name: str) -> str:
    """Return a directory around a file, or ``models`` in one, that holds a model; '' if none."""
    folder = os.path.abspath(file)  # noqa: PTH100
    for _ in range(_MOST_LEVELS):
        folder = os.path.dirname(folder)  # noqa: PTH120
        for directory in (f'{folder}/models', folder):
            if name and os.path.isdir(f'{directory}/{name}'):  # noqa: PTH112
                return directory
    return ''
