# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What can be wrong with an SDFormat file: one family of errors, a class for each cause.

Codes are those of libsdformat (``sdf::ErrorCode``), so that a message found here can be looked up
there.
"""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterable
from collections.abc import Sequence
from typing import NamedTuple


class Place(NamedTuple):
    """Where in the input something stands."""

    file: str
    """Path of the file, as it was opened."""
    line: int = 0
    """Line in that file, from 1; 0 where no line can be named."""
    element: str = ''
    """Path of the element, such as ``/sdf/model[@name="m"]/link[@name="l"]``."""

    def __str__(self) -> str:
        return f'{self.file}:{self.line}' if self.line else self.file


class SdfWarning(NamedTuple):
    """Something that libsdformat accepts, but that its author should know of."""

    code: str
    """Code of the error that the same thing is elsewhere, or ``WARNING``."""
    message: str
    """One sentence for a person."""
    place: Place
    """Where it stands."""

    def __str__(self) -> str:
        return f'{self.place}: {self.code}: {self.message}'


class SdfError(Exception):
    """
    One thing that is wrong, with its place; the base of all errors of this package's core.

    :param message: one sentence that names the value and the rule that it breaks.
    :param place: where it stands.
    """

    code: str = 'ERROR'

    def __init__(self, message: str, place: Place) -> None:
        super().__init__(message, place)
        self.message = message
        self.place = place

    @property
    def file(self) -> str:
        """Path of the file, as it was opened."""
        return self.place.file

    @property
    def line(self) -> int:
        """Line in that file, from 1; 0 where no line can be named."""
        return self.place.line

    @property
    def element(self) -> str:
        """Path of the element, such as ``/sdf/model[@name="m"]/link[@name="l"]``."""
        return self.place.element

    @property
    def errors(self) -> tuple[SdfError, ...]:
        """All errors of the load that this one ended, in file order."""
        return (self,)

    @property
    def warnings(self) -> tuple[SdfWarning, ...]:
        """What the load warned about before it ended, in file order."""
        return ()

    def __str__(self) -> str:
        return f'{self.place}: {self.code}: {self.message}'


class LoadError(SdfError):
    """
    A file that cannot be used; it speaks for its first error and holds all of them.

    :param errors: one or more errors, in file order.
    :param warnings: what was only warned about, in file order.
    """

    def __init__(self, errors: Sequence[SdfError], warnings: Sequence[SdfWarning] = ()) -> None:
        super().__init__(errors[0].message, errors[0].place)
        self.args = (errors, warnings)
        self.code = errors[0].code
        self._errors = tuple(errors)
        self._warnings = tuple(warnings)

    @property
    def errors(self) -> tuple[SdfError, ...]:
        """All errors of the file, in file order."""
        return self._errors

    @property
    def warnings(self) -> tuple[SdfWarning, ...]:
        """What the load warned about, in file order."""
        return self._warnings

    def __str__(self) -> str:
        return '\n'.join(str(error) for error in self._errors)


class FileReadError(SdfError):
    """A file is missing, cannot be read, is not XML or declares no version."""

    code = 'FILE_READ'


class ParsingError(SdfError):
    """The XML is not SDFormat."""

    code = 'PARSING_ERROR'


class ConversionError(SdfError):
    """The declared version is not one that can be read."""

    code = 'CONVERSION_ERROR'


class AttributeInvalidError(SdfError):
    """An attribute has a value that it must not have."""

    code = 'ATTRIBUTE_INVALID'


class AttributeMissingError(SdfError):
    """A required attribute is missing."""

    code = 'ATTRIBUTE_MISSING'


class ElementInvalidError(SdfError):
    """An element has a value that it must not have."""

    code = 'ELEMENT_INVALID'


class ElementMissingError(SdfError):
    """A required element is missing."""

    code = 'ELEMENT_MISSING'


class ElementIncorrectTypeError(SdfError):
    """An element stands where only others, or no further one, may stand."""

    code = 'ELEMENT_INCORRECT_TYPE'


class ReservedNameError(SdfError):
    """A name is one that SDFormat keeps for itself."""

    code = 'RESERVED_NAME'


class DuplicateNameError(SdfError):
    """Two elements of one scope share a name."""

    code = 'DUPLICATE_NAME'


class ModelWithoutLinkError(SdfError):
    """A model that is not static has neither a link nor a nested model."""

    code = 'MODEL_WITHOUT_LINK'


class CanonicalLinkError(SdfError):
    """``canonical_link`` names nothing."""

    code = 'MODEL_CANONICAL_LINK_INVALID'


class RelativeToError(SdfError):
    """``relative_to`` or a placement frame names nothing."""

    code = 'POSE_RELATIVE_TO_INVALID'


class RelativeToCycleError(SdfError):
    """Poses are written relative to one another in a ring."""

    code = 'POSE_RELATIVE_TO_CYCLE'


class AttachedToError(SdfError):
    """``attached_to`` names nothing."""

    code = 'FRAME_ATTACHED_TO_INVALID'


class AttachedToCycleError(SdfError):
    """Frames are attached to one another in a ring."""

    code = 'FRAME_ATTACHED_TO_CYCLE'


class JointChildError(SdfError):
    """A joint's child names nothing that can be one."""

    code = 'JOINT_CHILD_LINK_INVALID'


class JointParentError(SdfError):
    """A joint's parent names nothing that can be one."""

    code = 'JOINT_PARENT_LINK_INVALID'


class JointSameLinkError(SdfError):
    """A joint's parent and child are one body."""

    code = 'JOINT_PARENT_SAME_AS_CHILD'


class ExpressedInError(SdfError):
    """The frame that a joint's axis is expressed in does not exist."""

    code = 'JOINT_AXIS_EXPRESSED_IN_INVALID'


class UriLookupError(SdfError):
    """What an include names was not found."""

    code = 'URI_LOOKUP'


class PlacementFrameError(SdfError):
    """An include names a placement frame, but not where it is placed."""

    code = 'MODEL_PLACEMENT_FRAME_INVALID'


class MergeIncludeError(SdfError):
    """Something cannot be merged into what includes it."""

    code = 'MERGE_INCLUDE_UNSUPPORTED'


class UnknownFrameError(SdfError, LookupError):
    """A query names a frame that the scene does not have, or has more than once."""

    code = 'POSE_RELATIVE_TO_INVALID'


MOST_COMPARED = 400
"""With how many names one that was not found is compared in full."""


def hint_from_names(wanted: str, names: Iterable[str]) -> str:
    """
    Return the end of a sentence about a name that was not found.

    :param wanted: the name that was looked for.
    :param names: those that exist where it was looked for.
    :return: ``; did you mean "..."?`` with the nearest name, or an empty string.
    """
    # Most processes need it for nothing.
    import difflib
    near = difflib.get_close_matches(wanted, _likeliest(wanted, list(names)), n=1, cutoff=0.6)
    return f'; did you mean "{near[0]}"?' if near else ''


def _likeliest(wanted: str, names: list[str]) -> list[str]:
    """Leave out what would take seconds to compare, as large scenes have many similar names."""
    if len(names) <= MOST_COMPARED:
        return names
    length = len(wanted)
    most = min(length, max(map(len, names)))
    beginning = _sharing_most(names, most, str.startswith, lambda size: wanted[:size])
    end = _sharing_most(names, most, str.endswith, lambda size: wanted[length - size:])
    return [*beginning[:MOST_COMPARED // 2], *end[:MOST_COMPARED // 2]]


def _sharing_most(
    names: list[str], most: int, shares: Callable[[str, str], bool], part: Callable[[int], str],
) -> list[str]:
    least = 0
    while least < most:
        size = (least + most + 1) // 2
        wanted = part(size)
        sharing = [name for name in names if shares(name, wanted)]
        if sharing:
            names, least = sharing, size
        else:
            most = size - 1
    return names
