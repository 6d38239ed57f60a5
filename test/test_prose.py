# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation and the messages have no sentences that need a second reading."""

import ast
from itertools import chain
import re

from folders import ROOT
import pytest

PAGES = [*ROOT.glob('*.md'), *ROOT.glob('docs/*.md'), ROOT / 'CHANGELOG.rst']
MODULES = sorted(ROOT.glob('sdf_pose_bridge/**/*.py'))

STATEMENT_WITH_WHAT = r'(?:^|[.!?] |\* )What [^?.]*\.'
"""A sentence whose subject is a clause, such as "What cannot be read changes nothing."."""

NOUN_WITH_WHAT = r'(?:^|:(?:param \w+|return):\s)[Ww]hat '
"""A thing that a docstring describes by a clause, such as "What the file holds."."""

PHRASES = {
    r'\b(?:is|are) not taken\b': 'is rejected, or is ignored',
    r'\bthat which\b': 'name the thing',
    r'\bthe name of nothing\b': 'no frame or element has this name',
    r'\b(?:takes?|goes) this way\b': 'is processed in these steps',
}
"""Phrases, and better ones."""


def paragraphs_of_page(page):
    text = page.read_text()
    return [' '.join(each.split()) for each in re.split(r'\n\n|\n(?=[*|-] )', text)]


def docstrings_and_messages(module):
    """Return the docstrings of a module, also those of attributes, and all its other texts."""
    nodes = list(ast.walk(ast.parse(module.read_text())))
    texts = {
        id(node): node.value for node in nodes
        if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    docstrings = [
        texts.pop(id(node.value)) for node in nodes
        if isinstance(node, ast.Expr) and id(node.value) in texts]
    return docstrings, [*texts.values()]


def found(pattern, texts):
    return [text for text in texts if re.search(pattern, text)]


def test_patterns():
    assert found(STATEMENT_WITH_WHAT, ['It ends. What cannot be read changes nothing.'])
    assert not found(STATEMENT_WITH_WHAT, ['What does it read?'])
    assert found(NOUN_WITH_WHAT, ['What it holds.'])
    assert found(NOUN_WITH_WHAT, ['Read.\n\n:param text: what to read.'])
    assert found('|'.join(PHRASES), ['the value is not taken'])


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_page(page):
    texts = paragraphs_of_page(page)
    assert not found(STATEMENT_WITH_WHAT, texts)
    for phrase, better in PHRASES.items():
        assert not found(phrase, texts), better


def test_docstrings_and_messages():
    docstrings, messages = (
        list(chain(*texts)) for texts in zip(*map(docstrings_and_messages, MODULES), strict=True))
    assert not found(NOUN_WITH_WHAT, [text.strip() for text in docstrings])
    for texts in (docstrings, messages):
        assert not found(STATEMENT_WITH_WHAT, texts)
        for phrase, better in PHRASES.items():
            assert not found(phrase, texts), better
