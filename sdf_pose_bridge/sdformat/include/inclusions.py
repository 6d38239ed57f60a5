# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A document and everything that it includes."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
from typing import NamedTuple
from typing import TYPE_CHECKING

from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.include.resources import ResourceFinder
from sdf_pose_bridge.sdformat.versions import upgrade

if TYPE_CHECKING:
    from sdf_pose_bridge.sdformat.include.inclusion import Inclusion

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
        if not self.inclusions:
            return []
        # Only what includes something needs it.
        from sdf_pose_bridge.sdformat.include.inclusion import is_merge
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
    upgrade(document)
    if next(document.root.iter('include'), None) is None:
        return DocumentSet(document, {}, [document.path])
    # Many files include nothing, and what reads others takes long to import.
    from sdf_pose_bridge.sdformat.include.included_files import IncludedFiles
    included = IncludedFiles(document, finder)
    return DocumentSet(document, included.inclusions, [document.path, *included.files])
