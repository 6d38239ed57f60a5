# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read what a document includes, file by file, until nothing is left to be read."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import os
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.document import boolean_from_text
from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import document_from_file
from sdf_pose_bridge.document import is_data
from sdf_pose_bridge.document import value_of
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.manifest import model_file_from_directory
from sdf_pose_bridge.resources import ResourceFinder
from sdf_pose_bridge.versions import upgrade

DEEPEST = 64
"""Files may include one another to this depth."""

_INCLUDES = etree.XPath('//include')
_HOLDERS = frozenset({'sdf', 'world', 'model'})


class Inclusion(NamedTuple):
    """What an ``<include>`` stands for."""

    document: Document | None
    """The file that was read; None if there is none."""
    reason: str = ''
    """Why nothing could be found; empty if something was."""
    error: SdfError | None = None
    """What is wrong with the file that was found, or None."""
    warnings: tuple[SdfWarning, ...] = ()


class DocumentSet(NamedTuple):
    """A document and everything that it includes, each upgraded by its own version."""

    document: Document
    inclusions: Mapping[XmlElement, Inclusion]
    """What each ``<include>`` of any of the documents stands for."""
    files: Sequence[str]
    """All files that were read, manifests among them."""

    def all_documents(self) -> list[Document]:
        """
        Return all documents that were read.

        :return: each once, the first one first.
        """
        found = {self.document.path: self.document}
        for inclusion in self.inclusions.values():
            if inclusion.document is not None:
                found.setdefault(inclusion.document.path, inclusion.document)
        return list(found.values())

    def merged(self) -> list[Document]:
        """
        Return the documents that some include merges.

        :return: each once, those that are merged into another before that one.
        """
        found: dict[str, Document] = {}
        for include, inclusion in self.inclusions.items():
            if inclusion.document is not None and boolean_from_text(include.get('merge', '')):
                found[inclusion.document.path] = inclusion.document
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
    return DocumentSet(document, reader.inclusions, [document.path, *reader.files])


class _Reader:

    def __init__(self, finder: ResourceFinder) -> None:
        self.inclusions: dict[XmlElement, Inclusion] = {}
        self.files: dict[str, None] = {}
        self._finder = finder
        self._known: dict[str, Inclusion] = {}

    def read_includes_of(self, document: Document, chain: tuple[str, ...]) -> None:
        upgrade(document)
        found: list[XmlElement] = _INCLUDES(document.root)
        for include in found:
            holder = include.getparent()
            if holder is not None and holder.tag in _HOLDERS and is_data(include):
                # What is included inside comes first in the mapping, for it is read first.
                self.inclusions[include] = self._inclusion(include, document, chain)

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
        return self._known[real]._replace(warnings=warnings)

    def _read(self, path: str, chain: tuple[str, ...]) -> Inclusion:
        self.files[path] = None
        try:
            document = document_from_file(path)
            self.read_includes_of(document, chain)
        except SdfError as error:
            return Inclusion(None, error=error)
        return Inclusion(document)
