"""Analysis of the tracker's kernels: which fields of their records each reads and writes.

It follows names, views of fields and calls from module to module, and takes every branch, so a
field counts that is used in any case.  Fields of nested records count as their outermost one.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

Place = tuple[str, str]  # parameter, and its field; empty: the parameter itself


class Kernel(NamedTuple):
    """Function of a module of the tracker."""

    module: str
    name: str


class Effects(NamedTuple):
    """Places that a kernel reads and writes."""

    reads: frozenset[Place]
    writes: frozenset[Place]


class _Module:
    def __init__(self, source: str) -> None:
        body = ast.parse(source).body
        self.functions = {node.name: node for node in body if isinstance(node, ast.FunctionDef)}
        self.imports = {
            alias.asname or alias.name: Kernel(node.module, alias.name)
            for node in body
            if isinstance(node, ast.ImportFrom) and node.module is not None
            for alias in node.names
        }


class KernelEffects:
    """Effects of all kernels below ``folder``, the package ``package``."""

    def __init__(self, folder: Path, package: str) -> None:
        self._modules = {
            ".".join((package, *path.relative_to(folder).with_suffix("").parts)): _Module(
                path.read_text()
            )
            for path in sorted(folder.rglob("*.py"))
        }
        self.of = cache(self._of)

    def function(self, kernel: Kernel) -> ast.FunctionDef:
        return self._modules[kernel.module].functions[kernel.name]

    def calls(self, kernel: Kernel) -> Iterator[tuple[Kernel, str]]:
        """Kernels that a kernel calls, in order, each with the condition of the call."""
        yield from self._calls(kernel.module, self.function(kernel).body, ())

    def _calls(
        self, module: str, body: list[ast.stmt], conditions: tuple[str, ...]
    ) -> Iterator[tuple[Kernel, str]]:
        for statement in body:
            if isinstance(statement, ast.If):
                test = ast.unparse(statement.test)
                yield from self._called(module, statement.test, conditions)
                yield from self._calls(module, statement.body, (*conditions, test))
                yield from self._calls(module, statement.orelse, (*conditions, f"not ({test})"))
            elif isinstance(statement, ast.While):
                yield from self._called(module, statement.test, conditions)
                yield from self._calls(module, statement.body, conditions)
            else:
                yield from self._called(module, statement, conditions)

    def _called(
        self, module: str, node: ast.AST, conditions: tuple[str, ...]
    ) -> Iterator[tuple[Kernel, str]]:
        calls = (call for call in ast.walk(node) if isinstance(call, ast.Call))
        for call in sorted(calls, key=lambda call: (call.lineno, call.col_offset)):
            kernel = self.resolve(module, call.func)
            if kernel is not None:
                yield kernel, " and ".join(conditions)

    def resolve(self, module: str, function: ast.expr) -> Kernel | None:
        """Return the kernel that is called; None of a builtin or a library's function."""
        if not isinstance(function, ast.Name):
            return None
        if function.id in self._modules[module].functions:
            return Kernel(module, function.id)
        kernel = self._modules[module].imports.get(function.id)
        if kernel is None or kernel.module not in self._modules:
            return None
        return kernel if kernel.name in self._modules[kernel.module].functions else None

    def _of(self, kernel: Kernel) -> Effects:
        visitor = _Visitor(self, kernel)
        for statement in self.function(kernel).body:
            visitor.visit(statement)
        return Effects(frozenset(visitor.reads), frozenset(visitor.writes))


class _Visitor(ast.NodeVisitor):
    """Collects the effects of one kernel; names stand for views of what they were assigned."""

    def __init__(self, effects: KernelEffects, kernel: Kernel) -> None:
        self._effects = effects
        self._module = kernel.module
        self.reads: set[Place] = set()
        self.writes: set[Place] = set()
        self._views: defaultdict[str, set[Place]] = defaultdict(set)
        for argument in effects.function(kernel).args.args:
            self._views[argument.arg] = {(argument.arg, "")}

    def _places(self, node: ast.expr) -> set[Place]:
        match node:
            case ast.Name(id=name):
                return self._views.get(name, set())
            case ast.Attribute(value=value, attr=attr):
                return {(owner, field or attr) for owner, field in self._places(value)}
            case ast.Subscript(value=value):
                return self._places(value)
        return set()

    def _visit_indices(self, node: ast.expr) -> None:
        while isinstance(node, ast.Attribute | ast.Subscript):
            if isinstance(node, ast.Subscript):
                self.visit(node.slice)
            node = node.value
        if not isinstance(node, ast.Name):
            self.visit(node)

    def visit_Attribute(self, node: ast.Attribute) -> None:
        self.reads |= self._places(node)
        self._visit_indices(node)

    def visit_Subscript(self, node: ast.Subscript) -> None:
        self.reads |= self._places(node)
        self._visit_indices(node)

    def visit_Call(self, node: ast.Call) -> None:
        kernel = self._effects.resolve(self._module, node.func)
        if kernel is None:
            self.generic_visit(node)
            return
        names = [argument.arg for argument in self._effects.function(kernel).args.args]
        reads, writes = self._effects.of(kernel)
        for argument, name in zip(node.args, names, strict=True):
            places = self._places(argument)
            if not places:
                self.visit(argument)
                continue
            self._visit_indices(argument)
            for owner, field in places:
                self.reads |= {(owner, field or inner) for own, inner in reads if own == name}
                self.writes |= {(owner, field or inner) for own, inner in writes if own == name}

    def visit_Assign(self, node: ast.Assign) -> None:
        for target in node.targets:
            self._assign(target, node.value)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        self.visit(node.value)
        self.reads |= self._places(node.target)
        self.writes |= self._places(node.target)
        self._visit_indices(node.target)

    def _assign(self, target: ast.expr, value: ast.expr) -> None:
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
            for one, other in zip(target.elts, value.elts, strict=True):
                self._assign(one, other)
            return
        self.visit(value)
        targets = target.elts if isinstance(target, ast.Tuple) else [target]
        for one in targets:
            if isinstance(one, ast.Name):
                if isinstance(value, ast.Name | ast.Attribute | ast.Subscript):
                    self._views[one.id] |= self._places(value)
            else:
                self.writes |= self._places(one)
                self._visit_indices(one)
