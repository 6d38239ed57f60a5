# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read what a document includes, file by file, until nothing is left to be read."""

from __future__ import annotations

from collections.abc import Mapping
import os
from pathlib import Path
from typing import NamedTuple

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.errors import UriLookupError
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import is_data
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.document_reading import document_from_file
from sdf_pose_bridge.sdformat.include.expansion import expanded
from sdf_pose_bridge.sdformat.include.inclusion import DEEPEST
from sdf_pose_bridge.sdformat.include.inclusion import Inclusion
from sdf_pose_bridge.sdformat.include.manifest import model_file_from_directory
from sdf_pose_bridge.sdformat.include.params import apply_params
from sdf_pose_bridge.sdformat.include.params import params_of
from sdf_pose_bridge.sdformat.include.resources import ResourceFinder
from sdf_pose_bridge.sdformat.versions import upgrade

_HOLDERS = frozenset({'sdf', 'world', 'model'})


class _Located(NamedTuple):
    """What an include names."""

    path: str
    manifest: str
    """The file that names it; empty for none."""
    warnings: tuple[SdfWarning, ...]


class IncludedFiles:
    """
    What a document includes, each file read once and upgraded by its own version.

    ``inclusions`` has what each ``<include>`` stands for, those in included files among them;
    ``files`` are all paths that were read, in this order, with manifests.

    :param document: a file in the newest grammar.
    :param finder: finds what includes name.
    """

    def __init__(self, document: Document, finder: ResourceFinder) -> None:
        self.inclusions: dict[XmlElement, Inclusion] = {}
        self.files: dict[str, None] = {}
        self._has_copies = False
        self._finder = finder
        self._known: dict[str, Inclusion] = {}
        self._located_paths: dict[str, _Located | Inclusion] = {}
        self._read_new_includes(document, document, (os.path.realpath(document.path),))
        if self._has_copies:
            self.inclusions = _reachable(document, self.inclusions, {})

    def _read_new_includes(
        self, document: Document, source: Document, chain: tuple[str, ...],
    ) -> None:
        includes = [each for each in _includes_of(document) if each not in self.inclusions]
        located = [self._located(include, source) for include in includes]
        for include, place in zip(includes, located, strict=True):
            # What is included inside comes first in the mapping, for it is read first.
            self.inclusions[include] = place if isinstance(place, Inclusion) else (
                self._inclusion(include, place, source, chain))

    def _located(self, include: XmlElement, document: Document) -> _Located | Inclusion:
        """Find what an include names; if that fails, return what it stands for then."""
        uri = ' '.join(value_of(element).split()) if (
            element := next(include.iterchildren('uri'), None)) is not None else ''
        path = self._finder.path_from_uri(uri, document.path) if uri else None
        if path is None:
            return Inclusion(
                None, 'nothing of that name was found beside the file or in the resource paths, '
                'to which the variable GZ_SIM_RESOURCE_PATH adds')
        if path not in self._located_paths:
            self._located_paths[path] = _located(path)
        return self._located_paths[path]

    def _inclusion(
        self, include: XmlElement, located: _Located, document: Document, chain: tuple[str, ...],
    ) -> Inclusion:
        path, manifest, warnings = located
        if manifest:
            self.files[manifest] = None
        real = os.path.realpath(path)
        if real in chain:
            ring = [*chain[chain.index(real):], real]
            names = ' -> '.join(Path(file).name for file in ring)
            return Inclusion(None, f'the file includes itself: {names}')
        if len(chain) >= DEEPEST:
            return Inclusion(None, f'files include one another more than {DEEPEST} levels deep')
        if real not in self._known:
            self._known[real] = self._read(path, (*chain, real))
        known = self._known[real]
        inclusion = known._replace(warnings=(*known.warnings, *warnings))
        params = params_of(include)
        if params is None or inclusion.document is None:
            return inclusion
        return self._changed(inclusion, inclusion.document, params, document, chain)

    def _changed(
        self,
        inclusion: Inclusion,
        document: Document,
        params: XmlElement,
        source: Document,
        chain: tuple[str, ...],
    ) -> Inclusion:
        """Let the parameters of an include, which stand in another file, change a document."""
        expansion = expanded(document, self.inclusions)
        self._take_over(expansion.inclusions)
        changes = apply_params(params, expansion, source)
        merged = [inner.document for inner in expansion.inclusions.values()
                  if inner.document is not None and inner.document.origins is expansion.origins]
        for changed in (expansion.document, *merged):
            self._read_new_includes(changed, source, chain)
        return inclusion._replace(
            document=expansion.document,
            errors=(*inclusion.errors, *expansion.errors, *changes.errors),
            warnings=(*inclusion.warnings, *expansion.warnings, *changes.warnings))

    def _take_over(self, inclusions: Mapping[XmlElement, Inclusion]) -> None:
        self._has_copies = True
        self.inclusions.update(inclusions)

    def _read(self, path: str, chain: tuple[str, ...]) -> Inclusion:
        self.files[path] = None
        try:
            document = document_from_file(path)
            upgrade(document)
            self._read_new_includes(document, document, chain)
        except SdfError as failure:
            return Inclusion(None, error=failure)
        if next(document.root.iterchildren('include'), None) is None:
            return Inclusion(document)
        # Only what stands at the top can be included, so what is included there has to be there.
        expansion = expanded(document, self.inclusions)
        self._take_over(expansion.inclusions)
        errors = [
            error for include, left in expansion.inclusions.items()
            if include.getparent() is expansion.document.root
            and (error := _error_of(include, left, path)) is not None]
        return Inclusion(
            expansion.document, errors=(*expansion.errors, *errors), warnings=expansion.warnings)


def _located(path: str) -> _Located | Inclusion:
    if not Path(path).is_dir():
        return _Located(path, '', ())
    try:
        return _Located(*model_file_from_directory(path))
    except SdfError as error:
        return Inclusion(None, f'{error.place}: {error.message}')


def _reachable(
    document: Document,
    inclusions: Mapping[XmlElement, Inclusion],
    found: dict[XmlElement, Inclusion],
) -> dict[XmlElement, Inclusion]:
    """Leave out what only stands in files of which a changed copy is used."""
    for include in _includes_of(document):
        if include in inclusions and include not in found:
            inner = inclusions[include].document
            if inner is not None:
                _reachable(inner, inclusions, found)
            found[include] = inclusions[include]
    return found


def _includes_of(document: Document) -> list[XmlElement]:
    return [
        include for include in document.root.iter('include')
        if (holder := include.getparent()) is not None and holder.tag in _HOLDERS
        and is_data(include)]


def _error_of(include: XmlElement, inclusion: Inclusion, path: str) -> SdfError | None:
    if inclusion.document is not None or inclusion.error is not None:
        return inclusion.error
    msg = f'the file cannot be included: {inclusion.reason}'
    return UriLookupError(msg, Place(path, include.sourceline or 0, '/sdf/include/uri'))
