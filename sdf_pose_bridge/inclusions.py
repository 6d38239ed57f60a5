# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read what a document includes, file by file, until nothing is left to be read."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import os
from pathlib import Path
from typing import NamedTuple

from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import document_from_file
from sdf_pose_bridge.document import is_data
from sdf_pose_bridge.document import value_of
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.errors import UriLookupError
from sdf_pose_bridge.expansion import expanded
from sdf_pose_bridge.include_params import apply_params
from sdf_pose_bridge.include_params import params_of
from sdf_pose_bridge.inclusion import Inclusion
from sdf_pose_bridge.inclusion import is_merge
from sdf_pose_bridge.manifest import model_file_from_directory
from sdf_pose_bridge.resources import ResourceFinder
from sdf_pose_bridge.versions import upgrade

DEEPEST = 64
"""Files may include one another to this depth."""

_HOLDERS = frozenset({'sdf', 'world', 'model'})


class DocumentSet(NamedTuple):
    """A document and everything that it includes, each upgraded by its own version."""

    document: Document
    inclusions: Mapping[XmlElement, Inclusion]
    """What each ``<include>`` of any of the documents stands for."""
    files: Sequence[str]
    """All files that were read, manifests among them."""
    changed: frozenset[XmlElement] = frozenset()
    """The roots of documents whose trees differ from their texts."""

    def all_documents(self) -> list[Document]:
        """
        Return all documents that were read.

        :return: each once, the first one first; one that parameters change, in each form.
        """
        found = {self.document.root: self.document}
        for inclusion in self.inclusions.values():
            if inclusion.document is not None:
                found.setdefault(inclusion.document.root, inclusion.document)
        return list(found.values())

    def merged(self) -> list[Document]:
        """
        Return the documents that some include merges.

        :return: each once, those that are merged into another before that one.
        """
        found: dict[XmlElement, Document] = {}
        for include, inclusion in self.inclusions.items():
            if inclusion.document is not None and is_merge(include):
                found[inclusion.document.root] = inclusion.document
        return list(found.values())


def document_set(document: Document, finder: ResourceFinder) -> DocumentSet:
    """
    Read everything that a document includes.

    :param document: a file as it was read.
    :param finder: finds what includes name.
    :return: the documents; what cannot be read is told by its inclusion.
    :raises ConversionError: if the document itself cannot be brought to the newest version.
    """
    reader = _Reader(finder)
    reader.read_includes_of(document, (os.path.realpath(document.path),))
    inclusions = reader.inclusions
    if reader.has_copies:
        inclusions = _reachable(document, inclusions, {})
    return DocumentSet(
        document, inclusions, [document.path, *reader.files], frozenset(reader.changed))


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


class _Reader:

    def __init__(self, finder: ResourceFinder) -> None:
        self.inclusions: dict[XmlElement, Inclusion] = {}
        self.files: dict[str, None] = {}
        self.has_copies = False
        self.changed: set[XmlElement] = set()
        self._finder = finder
        self._known: dict[str, Inclusion] = {}

    def read_includes_of(self, document: Document, chain: tuple[str, ...]) -> None:
        if upgrade(document):
            self.changed.add(document.root)
        self._read_new_includes(document, document, chain)

    def _read_new_includes(
        self, document: Document, source: Document, chain: tuple[str, ...],
    ) -> None:
        for include in _includes_of(document):
            if include not in self.inclusions:
                # What is included inside comes first in the mapping, for it is read first.
                self.inclusions[include] = self._inclusion(include, source, chain)

    def _inclusion(
        self, include: XmlElement, document: Document, chain: tuple[str, ...],
    ) -> Inclusion:
        uri = ' '.join(value_of(element).split()) if (
            element := next(include.iterchildren('uri'), None)) is not None else ''
        path = self._finder.path_from_uri(uri, document.path) if uri else None
        if path is None:
            return Inclusion(None, 'nothing of that name was found')
        warnings: tuple[SdfWarning, ...] = ()
        if Path(path).is_dir():
            try:
                path, manifest, warnings = model_file_from_directory(path)
            except SdfError as error:
                return Inclusion(None, f'{error.place}: {error.message}')
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
        self.has_copies = True
        self.inclusions.update(inclusions)

    def _read(self, path: str, chain: tuple[str, ...]) -> Inclusion:
        self.files[path] = None
        try:
            document = document_from_file(path)
            self.read_includes_of(document, chain)
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


def _error_of(include: XmlElement, inclusion: Inclusion, path: str) -> SdfError | None:
    if inclusion.document is not None or inclusion.error is not None:
        return inclusion.error
    msg = f'the file cannot be included: {inclusion.reason}'
    return UriLookupError(msg, Place(path, include.sourceline or 0, '/sdf/include/uri'))
