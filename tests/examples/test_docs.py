"""The pages in docs, and the docstrings: they name what exists, and leave nothing public out."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import gc_core

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "equations.md").read_text(encoding="utf-8")
NAMED = sorted(set(re.findall(r"`(gc_core(?:\.\w+)+)`", PAGE)))


def found(name: str) -> object:
    """What a dotted name stands for; modules are imported on the way."""
    parts = name.split(".")
    value: Any = importlib.import_module(parts[0])
    for index, part in enumerate(parts[1:], 2):
        if not hasattr(value, part):
            importlib.import_module(".".join(parts[:index]))
        value = getattr(value, part)
    return value


def public_functions() -> Iterator[tuple[str, Callable[..., object]]]:
    """Functions of `gc_core.__all__`, those of `gc_core.metrics`, and methods of the public classes."""
    for name in gc_core.__all__:
        value = getattr(gc_core, name)
        if inspect.isfunction(value):
            yield f"gc_core.{name}", value
        elif inspect.isclass(value) and not issubclass(value, gc_core.GcError):
            for method, member in vars(value).items():
                function = getattr(member, "__func__", member)
                if inspect.isfunction(function) and not method.startswith("_"):
                    yield f"gc_core.{name}.{method}", function
    for name, value in vars(gc_core.metrics).items():
        if inspect.isfunction(value) and value.__module__ == "gc_core.metrics" and not name.startswith("_"):
            yield f"gc_core.metrics.{name}", value


FUNCTIONS = dict(public_functions())
PENDING = {"gc_core.generalize"}
"""Known to lack a section; whoever writes one takes the name out, or the test says so."""


def type_of(name: str) -> type:
    """The class of that name, or the type of what else is called so."""
    value = getattr(gc_core, name)
    return value if inspect.isclass(value) else type(value)


def called_names(function: ast.FunctionDef) -> set[str]:
    calls = (node.func for node in ast.walk(function) if isinstance(node, ast.Call))
    return {
        f.id if isinstance(f, ast.Name) else f.attr for f in calls if isinstance(f, ast.Name | ast.Attribute)
    }


@cache
def raising_names() -> set[str]:
    """Functions and classes of the core that raise a `GcError`, themselves or by calling one of these."""
    calls: dict[str, set[str]] = {}
    raising: set[str] = set()
    for path in sorted((ROOT / "gc_core").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            within = node.body if isinstance(node, ast.ClassDef) else []
            inside = [f for f in within if isinstance(f, ast.FunctionDef) and f.name == "__post_init__"]
            inside += [node] if isinstance(node, ast.FunctionDef) else []
            for function in inside:
                calls.setdefault(node.name, set()).update(called_names(function))
                if any(isinstance(part, ast.Raise) for part in ast.walk(function)):
                    raising.add(node.name)
    while more := {name for name, called in calls.items() if called & raising} - raising:
        raising |= more
    return raising


def lacking(name: str, function: Callable[..., object]) -> list[str]:
    """Sections that a docstring should have and has not."""
    text = inspect.getdoc(function) or ""
    signature = inspect.signature(function)
    wanted = ["Parameters"] if set(signature.parameters) - {"self"} else []
    wanted += ["Returns"] if signature.return_annotation not in (None, "None") else []
    wanted += ["Raises"] if name.rpartition(".")[2] in raising_names() else []
    return [section for section in wanted if not re.search(rf"^{section}\n-+$", text, re.MULTILINE)]


def test_every_function_named_on_the_equations_page_exists() -> None:
    missing: list[str] = []
    for name in NAMED:
        try:
            found(name)
        except (ImportError, AttributeError):
            missing.append(name)

    assert len(NAMED) > 30
    assert missing == []


def test_every_public_name_is_on_the_equations_page() -> None:
    exported = {name: getattr(gc_core, name) for name in gc_core.__all__ if name != "metrics"}
    # Errors are named by the class above them all.
    errors = {
        name for name, value in exported.items() if gc_core.GcError in getattr(value, "__mro__", ())[1:]
    }
    public = {f"gc_core.{name}" for name in exported if name not in errors}

    assert sorted((public | set(FUNCTIONS)) - set(NAMED)) == []


@pytest.mark.parametrize("name", sorted(set(FUNCTIONS) - PENDING))
def test_a_public_function_says_what_goes_in_what_comes_out_and_what_can_go_wrong(name: str) -> None:
    assert lacking(name, FUNCTIONS[name]) == []


def test_what_is_pending_is_still_lacking() -> None:
    assert {name for name in PENDING if not lacking(name, FUNCTIONS[name])} == set()


@pytest.mark.parametrize("page", sorted((ROOT / "docs").glob("*.md")), ids=lambda page: page.name)
def test_links_between_pages_lead_somewhere(page: Path) -> None:
    targets = re.findall(r"\]\((?!https?:)([^)#\s]+)", page.read_text(encoding="utf-8"))

    assert [target for target in targets if not (page.parent / target).exists()] == []


def test_formulas_are_closed() -> None:
    """A lost backtick turns the rest of a page into a formula."""
    assert PAGE.count("$`") == PAGE.count("`$")
    assert PAGE.count("```math") * 2 == PAGE.count("```")
