"""The rules that hold the code together, read from the code itself."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LONGEST_MODULE = 320
LONGEST_FUNCTION = 45
"""Lines, without the docstring."""

NUMERIC = {"dtaidistance", "numpy", "scipy"}
VISER_USERS = ("server", "web", "guard", "session", "viewers", "binding", "panels", "scene")
"""Serving (server, web, guard), one person's session (session, viewers), and what is drawn."""
LOWER_THAN = {
    # The direction of imports: a layer may import those before it, never those after it.
    "document": 0,
    "history": 0,
    "edits": 1,
    "model": 1,
    "store": 1,
    "gesture": 1,
    "binding": 1,
    "panels": 2,
    "scene": 2,
    "viewers": 3,
    "session": 3,
    "server": 4,
    "__main__": 5,
}


def sources(*folders: str) -> list[Path]:
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def part_of(module: str) -> str:
    """The first name under `app`: ``app.panels.teach`` belongs to ``panels``."""
    return [*module.split("."), ""][1]


def top_of(module: str) -> str:
    return module.partition(".")[0]


def imports_of(path: Path) -> Iterator[str]:
    """Full names of the modules a file imports; of ``from a import b`` both ``a`` and ``a.b``."""
    package = name_of(path).removesuffix(".py").removesuffix("/__init__").split("/")
    inside = package if path.name == "__init__.py" else package[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = inside[: len(inside) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


def offences(paths: list[Path], allowed: Callable[[Path, str], bool]) -> list[str]:
    return [
        f"{name_of(path)} imports {module}"
        for path in paths
        for module in sorted(set(imports_of(path)))
        if not allowed(path, module)
    ]


def test_the_core_imports_only_numpy_scipy_one_dtw_library_and_the_standard_library() -> None:
    def allowed(_: Path, module: str) -> bool:
        top = top_of(module)
        return top in NUMERIC | {"gc_core"} or top in sys.stdlib_module_names

    assert offences(sources("gc_core"), allowed) == []


def test_the_core_does_no_input_output_and_starts_no_threads() -> None:
    banned = {"asyncio", "io", "logging", "multiprocessing", "os", "pathlib", "pickle", "socket", "threading"}

    def allowed(_: Path, module: str) -> bool:
        return top_of(module) not in banned

    assert offences(sources("gc_core"), allowed) == []


def test_the_arm_knows_neither_viser_nor_the_core_nor_the_rest_of_the_app() -> None:
    def allowed(_: Path, module: str) -> bool:
        top = top_of(module)
        return top not in {"viser", "gc_core"} and (
            top != "app" or module in {"app", "app.arm"} or part_of(module) == "arm"
        )

    assert offences(sources("app/arm"), allowed) == []


@pytest.mark.parametrize("folder", ["files", "library"])
def test_files_and_library_know_the_document_its_history_and_the_core_only(folder: str) -> None:
    def allowed(_: Path, module: str) -> bool:
        return not module.startswith("app.") or part_of(module) in {folder, "document", "history"}

    assert offences(sources(f"app/{folder}"), allowed) == []


def test_only_what_draws_and_listens_imports_viser() -> None:
    def allowed(path: Path, module: str) -> bool:
        part = path.relative_to(ROOT / "app").parts[0].removesuffix(".py")
        return top_of(module) != "viser" or part in VISER_USERS

    assert offences(sources("app"), allowed) == []


def test_imports_go_down_the_layers_only() -> None:
    def allowed(path: Path, module: str) -> bool:
        mine = LOWER_THAN.get(path.relative_to(ROOT / "app").parts[0].removesuffix(".py"))
        theirs = LOWER_THAN.get(part_of(module)) if module.startswith("app.") else None
        return mine is None or theirs is None or theirs <= mine

    assert offences(sources("app"), allowed) == []


def test_panels_do_not_import_panels() -> None:
    """What several panels share lies beside them in modules that are no panel."""
    panels = {
        "app.panels." + path.stem
        for path in sources("app/panels")
        if path.stem != "__init__"
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef) and node.name.endswith("Panel")
    }

    def allowed(path: Path, module: str) -> bool:
        return path.stem == "__init__" or module not in panels

    assert panels
    assert offences(sources("app/panels"), allowed) == []


def test_nothing_of_ours_imports_the_tests() -> None:
    def allowed(_: Path, module: str) -> bool:
        return top_of(module) not in {"tests", "pytest"}

    assert offences(sources("app", "gc_core"), allowed) == []


def test_modules_are_short() -> None:
    lengths = {name_of(p): len(p.read_text(encoding="utf-8").splitlines()) for p in sources("app", "gc_core")}

    assert {name: length for name, length in lengths.items() if length > LONGEST_MODULE} == {}


def body_length(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Lines from the ``def`` to the end, without the docstring."""
    total = (function.end_lineno or function.lineno) - function.lineno + 1
    first = function.body[0]
    if (
        isinstance(first, ast.Expr)
        and isinstance(first.value, ast.Constant)
        and isinstance(first.value.value, str)
    ):
        total -= (first.end_lineno or first.lineno) - first.lineno + 1
    return total


def test_functions_are_short() -> None:
    lengths = {
        f"{name_of(path)}:{node.lineno} {node.name}": body_length(node)
        for path in sources("app", "gc_core")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    }

    assert {name: length for name, length in lengths.items() if length > LONGEST_FUNCTION} == {}


def test_every_module_says_what_lives_in_it() -> None:
    silent = [
        name_of(path)
        for path in sources("app", "gc_core")
        if ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) is None
    ]

    assert silent == []


def test_no_type_is_ignored_without_a_reason() -> None:
    ignoring = re.compile(r"#\s*(type|pyright):\s*ignore")
    reasoned = re.compile(r"#\s*(type|pyright):\s*ignore\[[\w, -]+\]\s*[-#:]+\s*\w+")
    bare = [
        f"{name_of(path)}:{number}"
        for path in sources("app", "gc_core", "tests")
        if path != Path(__file__)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if ignoring.search(line) and not reasoned.search(line)
    ]

    assert bare == []


def test_no_file_depends_on_one_machine() -> None:
    home = re.compile(r"/(?:home|Users)/\w+/|/root/\.(?:pyenv|venv|cache)|/work/\w")
    folders = ("app", "gc_core", "tests", "docker", "static", ".ci", "docs")
    paths = [path for name in folders for path in (ROOT / name).rglob("*")]
    paths += [path for pattern in ("*.md", "*.toml", "*.lock", "Makefile") for path in ROOT.glob(pattern)]
    tied: list[str] = []
    for path in paths:
        if path == Path(__file__) or not path.is_file() or path.suffix in (".png", ".npz", ".npy", ".pyc"):
            continue
        text = path.read_text(encoding="utf-8", errors="replace")
        tied += [f"{path.relative_to(ROOT)}: {found}" for found in home.findall(text)]

    assert tied == []


def test_the_rules_are_about_code_that_exists() -> None:
    assert len(sources("gc_core")) > 5
    assert len(sources("app")) > 10
