# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Write XML that is not well-formed, but that libsdformat reads all the same."""

from __future__ import annotations

import re

ATTRIBUTE = re.compile(r'(?<= )[a-z_]+="[^"]*"')
VALUE = re.compile(r'"[^"]*"|>[^<]*<')
BYTE_OF_LATIN_1 = '\udcfc'
"""A byte that is not UTF-8, when it is encoded with the error handler ``surrogateescape``."""

OUTSIDE = (
    f'<!-- f{BYTE_OF_LATIN_1}r -->', '<!-- a -- b -->', 'text before the root\n',
    '<?xml version="1.1"?>', '<?xml version="1.0" encoding="foo"?>',
    '?xml version="1.0"?>\n',
)
INSIDE = (
    f'<!-- f{BYTE_OF_LATIN_1}r -->', '<!-- a -- b --->', ' R&D ', ' &unknown; ', ' ]]> ',
    ' &#xZ; ', f' f{BYTE_OF_LATIN_1}r ',
)


def with_oddities(dice, text):
    """
    Change what libsdformat forgives; the content stays what it is.

    :param dice: what is changed.
    :param text: a well-formed file with an ``sdf`` element.
    :return: the text, in which single bytes may be surrogates.
    """
    if dice.random() < 0.5:
        text = VALUE.sub(
            lambda match: match[0].replace('&amp;', '&') if match[0].count('&') == 1 else match[0],
            text)
    if dice.random() < 0.5:
        text = ATTRIBUTE.sub(lambda match: match[0].replace('&lt;', '<'), text)
    if dice.random() < 0.3:
        text = re.sub(r'" (?=[a-z_]+=")', '"', text, count=dice.randint(1, 3))
    head, end, tail = text.rpartition('</sdf>')
    if end and dice.random() < 0.5:
        text = f'{head}{dice.choice(INSIDE)}</sdf>{tail}'
    if dice.random() < 0.5:
        text = dice.choice(OUTSIDE) + text
    return text
