# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find what a small file could make the reader do again and again: ``python -m growth.raw_calls``.

Functions of modules are forbidden by ruff (``banned-api`` in pyproject.toml). This finds methods,
and searches among the children of an element in a loop that is not about that element.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
import sys

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ('sdf_pose_bridge/sdformat', 'sdf_pose_bridge/scene')
COUNTED = ('counted.py', 'file_replacement.py')
"""The module that counts, and the program of which one process writes one file."""
METHODS = frozenset({'resolve', 'iterdir', 'glob', 'rglob', 'readlink'})
SEARCHES = frozenset({'first_child', 'child_value', 'numbers_of_child'})

_COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


class _Finder(ast.NodeVisitor):

    def __init__(self) -> None:
        self.found: list[tuple[int, str]] = []
        self._elements: list[set[str]] = []
        """For each loop around: the names of its variables, and of what is found by them."""

    def visit(self, node: ast.AST) -> None:
        if isinstance(node, _COMPREHENSIONS):
            self._visit_comprehension(node)
        else:
            super().visit(node)

    def visit_For(self, node: ast.For) -> None:
        self.visit(node.iter)
        self._in_loop(_names(node.target), [*node.body, *node.orelse])

    def visit_While(self, node: ast.While) -> None:
        self._in_loop(set(), [node.test, *node.body, *node.orelse])

    def _visit_comprehension(self, node: ast.expr) -> None:
        names = {name for part in node.generators for name in _names(part.target)}
        self.visit(node.generators[0].iter)
        self._in_loop(names, [
            child for child in ast.iter_child_nodes(node) if child is not node.generators[0]])

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        outer, self._elements = self._elements, []
        self.generic_visit(node)
        self._elements = outer

    def visit_Assign(self, node: ast.Assign) -> None:
        self.generic_visit(node)
        if self._elements and _is_search(node.value) and self._is_of_turn(node.value):
            self._elements[-1].update(*map(_names, node.targets))

    def visit_Call(self, node: ast.Call) -> None:
        self.generic_visit(node)
        if isinstance(node.func, ast.Attribute) and node.func.attr in METHODS:
            self.found.append((node.lineno, f'.{node.func.attr}() is not counted'))
        elif self._elements and _is_search(node) and not self._is_of_turn(node):
            self.found.append((
                node.lineno, f'{ast.unparse(node)} searches the same element in each turn'))

    def _is_of_turn(self, call: ast.Call) -> bool:
        """Return whether another element is searched in each turn, or for another tag of a few."""
        return any(name in names for name in _names(call) for names in self._elements)

    def _in_loop(self, names: set[str], nodes: list[ast.AST]) -> None:
        self._elements.append(names)
        for node in nodes:
            self.visit(node)
        self._elements.pop()


def _names(node: ast.AST) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


def _is_search(node: ast.AST) -> bool:
    return (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
            and node.func.id in SEARCHES)


def raw_calls(text: str) -> list[tuple[int, str]]:
    """Return the line of each such call in a module, and what is wrong with it."""
    finder = _Finder()
    finder.visit(ast.parse(text))
    return finder.found


def faults() -> Iterator[str]:
    """Say what is wrong in the rooms that read files."""
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob('*.py')):
            if path.name not in COUNTED:
                for line, fault in raw_calls(path.read_text(encoding='utf-8')):
                    yield f'{path.relative_to(ROOT)}:{line}: {fault}; see sdformat/counted.py'


if __name__ == '__main__':
    found = list(faults())
    print(*found, sep='\n', end='\n' if found else '')
    sys.exit(bool(found))
