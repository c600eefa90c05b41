"""Files, rooms, floors and circles of modelgen, read from the source.

    PYTHONPATH=tests python -m architecture.house [--base FOLDER]     rooms, floors, arrows and circles

A file's imports count wherever they stand in it, in functions and under TYPE_CHECKING too. Rooms of a package
are the files and sub-packages that lie in it; an arrow leads from a room to one that it imports.
"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAME = "modelgen"

Graph = Mapping[str, frozenset[str]]


@dataclass(frozen=True)
class Import:
    """One imported name. target: dotted, a file's where it is one, else the package's."""

    line: int
    target: str


def dotted(path: Path, root: Path) -> str:
    """Name of a module from its path."""
    parts = path.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports(source: str, module: str, *, package: bool) -> Iterator[Import]:
    """Everything of modelgen that the source of `module` imports, anywhere in it."""
    for node in ast.walk(ast.parse(source)):
        found: list[str] = []
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = module.split(".")
                above = above[: len(above) - node.level + package]
                base = ".".join([*above, base] if base else above)
            found = [f"{base}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] in {
            "import_module",
            "__import__",
        }:
            found = [str(arg.value) for arg in node.args if isinstance(arg, ast.Constant)]
        yield from (Import(node.lineno, name) for name in found if name.split(".")[0] == NAME)


def files(root: Path = ROOT) -> dict[str, Path]:
    """Path of every module, by its dotted name."""
    return {dotted(path, root): path for path in sorted((root / NAME).rglob("*.py"))}


def file_graph(root: Path = ROOT) -> Graph:
    """Which modules each module imports; a name that a package's face passes on is an import of the face."""
    modules = files(root)
    graph: dict[str, frozenset[str]] = {}
    for name, path in modules.items():
        source, face = path.read_text(encoding="utf-8"), path.stem == "__init__"
        targets = set()
        for found in imports(source, name, package=face):
            target = found.target
            while target not in modules:
                target = target.rpartition(".")[0]
            targets.add(target)
        graph[name] = frozenset(targets - {name})
    return graph


def circles(graph: Graph) -> list[list[str]]:
    """Groups of two and more nodes, each of which reaches the others (Tarjan 1972)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    path: list[str] = []
    found: list[list[str]] = []

    def visit(node: str) -> None:
        index[node] = low[node] = len(index)
        path.append(node)
        for other in sorted(graph[node]):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in path:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            group = path[path.index(node) :]
            del path[path.index(node) :]
            if len(group) > 1:
                found.append(sorted(group))

    for node in sorted(graph):
        if node not in index:
            visit(node)
    return found


def rooms(package: str, graph: Graph) -> Graph:
    """Rooms of a package, and which of them each imports; a package's own face is none of them."""
    inside = f"{package}."

    def room(name: str) -> str | None:
        return name[len(inside) :].split(".", maxsplit=1)[0] if name.startswith(inside) else None

    arrows: dict[str, set[str]] = {}
    for name, targets in graph.items():
        own = room(name)
        if own is not None:
            arrows.setdefault(own, set()).update(
                other for t in targets if (other := room(t)) not in (None, own)
            )
    return {name: frozenset(targets) for name, targets in arrows.items()}


def floors(graph: Graph) -> dict[str, int]:
    """Floor of every room: one above the highest that it imports, 1 where it imports none; rooms of a circle
    share one.
    """
    shared = {name: group for group in circles(graph) for name in group}
    known: dict[str, int] = {}

    def floor(name: str) -> int:
        if name not in known:
            group = shared.get(name, [name])
            below = {other for member in group for other in graph[member]} - set(group)
            level = 1 + max((floor(other) for other in below), default=0)
            known.update(dict.fromkeys(group, level))
        return known[name]

    return {name: floor(name) for name in graph}


def table(root: Path = ROOT) -> list[tuple[str, int, int, int, int]]:
    """Rows of package, rooms, floors, arrows, circles: the whole first, then what has rooms of its own."""
    graph = file_graph(root)
    packages = sorted(name for name, path in files(root).items() if path.stem == "__init__")
    rows = []
    for package in packages:
        inner = rooms(package, graph)
        if len(inner) > 1:
            arrows = sum(len(targets) for targets in inner.values())
            rows.append((package, len(inner), max(floors(inner).values()), arrows, len(circles(inner))))
    return rows


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("--base", type=Path, default=ROOT, help="a checkout")
    base: Path = parser.parse_args().base
    print(f"{'package':36s} {'rooms':>6s} {'floors':>6s} {'arrows':>6s} {'circles':>7s}")
    for name, *numbers in table(base):
        print(f"{name:36s} {numbers[0]:6d} {numbers[1]:6d} {numbers[2]:6d} {numbers[3]:7d}")
    of_files = file_graph(base)
    print(f"{len(of_files)} files, circles between them: {circles(of_files) or 'none'}")


if __name__ == "__main__":
    main()
