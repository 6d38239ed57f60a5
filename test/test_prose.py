# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation and the messages have no sentences that need a second reading."""

import ast
from pathlib import Path
import re

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGES = [*ROOT.glob('*.md'), *ROOT.glob('docs/*.md'), ROOT / 'CHANGELOG.rst']
MODULES = sorted(ROOT.glob('sdf_pose_bridge/**/*.py'))

STATEMENT_WITH_WHAT = r'(?:^|[.!?] |\* )What [^?.]*\.'
"""A sentence whose subject is a clause, such as "What cannot be read changes nothing."."""

PHRASES = {
    r'\b(?:is|are) not taken\b': 'is rejected, or is ignored',
    r'\bthat which\b': 'name the thing',
    r'\bthe name of nothing\b': 'no frame or element has this name',
    r'\b(?:takes?|goes) this way\b': 'is processed in these steps',
}
"""Phrases, and better ones."""


def paragraphs_of_page(page):
    text = page.read_text(encoding='utf-8')
    return [' '.join(each.split()) for each in re.split(r'\n\n|\n(?=[*|-] )', text)]


def messages_of_module(module):
    """Return all texts of a module but its docstrings."""
    tree = ast.parse(module.read_text(encoding='utf-8'))
    docstrings = {
        id(node.value) for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)}
    return [
        node.value for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
        and id(node) not in docstrings]


def found(pattern, texts):
    return [text for text in texts if re.search(pattern, text)]


def test_patterns():
    assert found(STATEMENT_WITH_WHAT, ['It ends. What cannot be read changes nothing.'])
    assert not found(STATEMENT_WITH_WHAT, ['What does it read?'])
    assert found('|'.join(PHRASES), ['the value is not taken'])


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_page(page):
    texts = paragraphs_of_page(page)
    assert not found(STATEMENT_WITH_WHAT, texts)
    for phrase, better in PHRASES.items():
        assert not found(phrase, texts), better


def test_messages():
    texts = [text for module in MODULES for text in messages_of_module(module)]
    assert not found(STATEMENT_WITH_WHAT, texts)
    for phrase, better in PHRASES.items():
        assert not found(phrase, texts), better
