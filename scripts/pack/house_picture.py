"""Draws Documentation~/images/house.svg: the parts of the repository and which part uses which.

Run from the repository's root:

    /usr/bin/python3 scripts/pack/house_picture.py            draws the picture
    /usr/bin/python3 scripts/pack/house_picture.py --check    exit code 1 where the picture no longer agrees with the tree

The parts and their dependencies are read from the tree: libraries and programs of CMake (`target_link_libraries`, and DEPENDS
of the functions that call it), assembly definitions of the Unity package and its samples, and imports between the folders of
the Python packages. The same data stands as JSON in the picture's description, which --check compares. Where A uses B and B
uses C, the line from A to C is left out of the drawing; it stays in the data.
"""

from __future__ import annotations

import argparse
import ast
import json
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

ROOT = Path(__file__).resolve().parents[2]
PICTURE = ROOT / "Documentation~/images/house.svg"
PLUGIN = "audioplugin_haptoflow"
Uses = dict[str, list[str]]



class Panel(NamedTuple):
    """A column of the picture: its title, its boxes' colour, where it begins, how wide it is, how many boxes fit a line."""

    title: str
    colour: str
    left: float
    width: float
    columns: int


PANELS = {
    "unity": Panel("Packages/com.haptoflow.runtime, Samples~ (C#)", "#dbe7f3", 0.0, 5.6, 4),
    "native": Panel("NativePlugin (C++)", "#f3e3d0", 6.0, 3.9, 3),
    "haptoflow_training": Panel("Training/haptoflow_training (Python)", "#dcecd9", 10.3, 3.6, 3),
    "haptoflow_benchmark": Panel("Training/haptoflow_benchmark (Python)", "#e9e0f0", 14.2, 3.2, 3),
    "haptoflow_paper": Panel("Training/haptoflow_paper (Python)", "#f0e0e4", 17.7, 3.2, 3),
}


def native_parts(root: Path) -> Uses:
    """Targets of NativePlugin, by the targets of NativePlugin that they link."""
    listed = "\n".join(re.sub(r"#.*", "", file.read_text(encoding="utf-8"))
                       for file in sorted((root / "NativePlugin").rglob("CMakeLists.txt")))
    calls = re.findall(r"\b(haptoflow_add_library|add_library|add_executable|target_link_libraries)\s*\(([^()]*)\)", listed)
    words = [(call, arguments.split()) for call, arguments in calls]
    targets = {arguments[0] for call, arguments in words if call != "target_link_libraries"}
    uses: dict[str, set[str]] = {target: set() for target in targets}
    for call, (target, *arguments) in words:
        if call == "haptoflow_add_library":
            linked = arguments[arguments.index("DEPENDS") :] if "DEPENDS" in arguments else []
        else:
            linked = arguments if call == "target_link_libraries" else []
        if target in uses:
            uses[target] |= targets.intersection(linked) - {target}
    return ordered(uses)


def unity_parts(root: Path) -> Uses:
    """Assemblies of the package and the samples, by their references to each other."""
    folders = (root / "Packages", root / "Samples~")
    assemblies = [json.loads(file.read_text(encoding="utf-8")) for folder in folders for file in sorted(folder.rglob("*.asmdef"))]
    names = {assembly["name"] for assembly in assemblies}
    return ordered({assembly["name"]: names.intersection(assembly["references"]) for assembly in assemblies})


def python_parts(root: Path) -> Uses:
    """Folders of the Python packages, by imports. Modules directly in a package, such as errors.py, are left out."""
    training = root / "Training"
    packages = [folder.parent for folder in sorted(training.glob("*/__init__.py"))]
    parts = {f"{package.name}.{init.parent.name}": init.parent for package in packages
             for init in sorted(package.glob("*/__init__.py"))}
    if not parts:
        raise SystemExit(f"{training}: no Python packages with folders")
    return ordered({part: {used for used in imported_parts(folder, parts) if used != part} for part, folder in parts.items()})


def imported_parts(folder: Path, parts: Iterable[str]) -> set[str]:
    found = set()
    for file in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            modules = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            if isinstance(node, ast.ImportFrom):
                modules += [f"{node.module}.{name.name}" for name in node.names]
            if isinstance(node, ast.Import):
                modules += [name.name for name in node.names]
            found |= {part for part in parts for module in modules if module == part or module.startswith(part + ".")}
    return found


def ordered(uses: dict[str, set[str]]) -> Uses:
    return {part: sorted(uses[part]) for part in sorted(uses)}


def callers_of_the_plugin(root: Path) -> list[str]:
    """Assemblies and Python folders that load the native library at run time."""
    native = root / "Packages/com.haptoflow.runtime/Runtime/Core"
    found = [json.loads(next(native.glob("*.asmdef")).read_text(encoding="utf-8"))["name"]] if any(
        f'"{PLUGIN}"' in file.read_text(encoding="utf-8") for file in native.rglob("*.cs")) else []
    for file in sorted((root / "Training").rglob("*.py")):
        package, part, *rest = file.relative_to(root / "Training").parts
        if rest and PLUGIN in file.read_text(encoding="utf-8") and f"{package}.{part}" not in found:
            found.append(f"{package}.{part}")
    return found


def house(root: Path) -> dict[str, object]:
    """Everything that the picture shows."""
    python = python_parts(root)
    packages = sorted({part.split(".")[0] for part in python})
    return {"unity": unity_parts(root), "native": native_parts(root),
            **{package: {part: used for part, used in python.items() if part.startswith(package + ".")} for package in packages},
            "loads the library": callers_of_the_plugin(root)}


def reachable(uses: Uses, part: str) -> set[str]:
    found: set[str] = set()
    waiting = list(uses[part])
    while waiting:
        next_part = waiting.pop()
        if next_part not in found:
            found.add(next_part)
            waiting += uses[next_part]
    return found


def rows_of(uses: Uses) -> list[list[str]]:
    """Parts by the longest way down, the lowest row first. Parts that use each other in a circle share a row."""
    below = {part: reachable(uses, part) for part in uses}
    circle = {part: frozenset({part} | {other for other in below[part] if part in below[other]}) for part in uses}
    height: dict[str, int] = {}

    def height_of(part: str) -> int:
        if part not in height:
            lower = {other for member in circle[part] for other in uses[member]} - circle[part]
            height[part] = max((height_of(other) + 1 for other in lower), default=0)
        return height[part]

    rows: list[list[str]] = [[] for _ in range(max(map(height_of, uses)) + 1)]
    for part in uses:
        rows[height[part]].append(part)
    return rows


def drawn_uses(uses: Uses) -> list[tuple[str, str]]:
    """Pairs without those that follow from others."""
    below = {part: reachable(uses, part) for part in uses}
    pairs = []
    for part, used in uses.items():
        for other in used:
            between = [third for third in used
                       if third != other and other in below[third] and third not in below[other] and part not in below[third]]
            if not between:
                pairs.append((part, other))
    return pairs


def short(part: str) -> str:
    """What stands in a box: the name without what all parts of a panel share."""
    for start, instead in (("HaptoFlow.Samples.", "sample "), ("HaptoFlow.", ""), ("haptoflow_training.", ""),
                           ("haptoflow_benchmark.", ""), ("haptoflow_paper.", ""), ("haptoflow_", "")):
        if part.startswith(start):
            return instead + part.removeprefix(start)
    return part


def places_of(uses: Uses, left: float, width: float, columns: int) -> dict[str, tuple[float, float]]:
    """The middle of each box. A row with more parts than columns takes several lines."""
    places: dict[str, tuple[float, float]] = {}
    line = 0.0
    for row in rows_of(uses):
        by_below = sorted(row, key=lambda part: (
            sum(places[used][0] for used in uses[part] if used in places) / max(1, sum(used in places for used in uses[part])),
            part))
        lines = [by_below[start : start + columns] for start in range(0, len(by_below), columns)]
        for parts in lines:
            for index, part in enumerate(parts):
                places[part] = (left + width * (index + 0.5) / len(parts), line)
            line += 1.0
        line += 0.35
    return places


def draw_panel(axes: Axes, panel: Panel, data: Uses) -> dict[str, tuple[float, float]]:
    uses = {part: [other for other in used if other in data] for part, used in data.items()}
    places = places_of(uses, panel.left, panel.width, panel.columns)
    box = panel.width / panel.columns - 0.12
    pairs = drawn_uses(uses)
    for part, used in pairs:
        mutual = (used, part) in pairs
        if mutual and used < part:
            continue
        (x0, y0), (x1, y1) = places[part], places[used]
        # Within a line a bow over the boxes; otherwise from the lower edge of one box to the upper edge of the other.
        level = y0 == y1
        lift = 0.19 if level else -0.19
        bow = 0.0 if not level else 0.3 if x0 > x1 else -0.3
        axes.add_patch(FancyArrowPatch((x0, y0 + lift), (x1, y1 + 0.19), arrowstyle="<|-|>" if mutual else "-|>",
                                       mutation_scale=7, linewidth=0.7, color="#808890", zorder=1,
                                       connectionstyle=f"arc3,rad={bow}", shrinkA=0, shrinkB=0))
    for part, (x, y) in places.items():
        axes.add_patch(FancyBboxPatch((x - box / 2, y - 0.17), box, 0.34, boxstyle="round,pad=0.02", facecolor=panel.colour,
                                      edgecolor="#4a525a", linewidth=0.8, zorder=2))
        axes.text(x, y, short(part), ha="center", va="center", fontsize=7.5, zorder=3)
    top = max(y for _, y in places.values())
    axes.text(panel.left + panel.width / 2, top + 0.55, panel.title, ha="center", va="bottom", fontsize=9, fontweight="bold")
    return places


def draw_package_use(axes: Axes, data: dict[str, object], places: dict[str, tuple[float, float]]) -> None:
    """One thick arrow from a Python package to another that it imports; the single imports stay in the data."""
    packages = [name for name in PANELS if name.startswith("haptoflow_") and name in data]
    imports = {package: {part.split(".")[0] for parts in data[package].values() for part in parts} - {package}
               for package in packages}
    for package, other in drawn_uses(ordered(imports)):
        here, there = PANELS[package], PANELS[other]
        # Beside the highest boxes, of which there are few.
        height = max(y for part, (_, y) in places.items() if part.startswith(other))
        right = here.left > there.left
        start = here.left + (0.1 if right else here.width - 0.1)
        end = there.left + (there.width - 0.8 if right else 0.8)
        axes.add_patch(FancyArrowPatch((start, height), (end, height), arrowstyle="-|>", mutation_scale=14,
                                       linewidth=2.0, color="#4a525a"))


def draw(data: dict[str, object], file: Path) -> None:
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "house"})
    figure, axes = plt.subplots(figsize=(20.4, 6.4), layout="constrained")
    places: dict[str, tuple[float, float]] = {}
    for name, panel in PANELS.items():
        if name in data:
            places |= draw_panel(axes, panel, data[name])
    draw_package_use(axes, data, places)
    x1, y1 = places[PLUGIN]
    for caller in data["loads the library"]:
        x0, y0 = places[caller]
        axes.add_patch(FancyArrowPatch((x0, y0), (x1, y1), arrowstyle="-|>", mutation_scale=10, linewidth=1.1, linestyle="--",
                                       color="#b0442c", zorder=1, shrinkA=20, shrinkB=48))
    axes.set_xlim(-0.1, 21.0)
    axes.set_ylim(-0.5, max(y for _, y in places.values()) + 1.0)
    axes.axis("off")
    axes.text(10.4, -0.35, "A line leads from a part to what it uses. Thick: one package imports the other. "
              "Dashed: loads the native library at run time.",
              ha="center", va="top", fontsize=8)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, metadata={"Date": None, "Creator": None, "Description": json.dumps(data)})
    plt.close(figure)


def data_of(picture: Path) -> dict[str, object]:
    """The data that a picture was drawn from."""
    text = picture.read_text(encoding="utf-8")
    described = re.search(r"<dc:description>(.*?)</dc:description>", text, re.DOTALL)
    if described is None:
        raise SystemExit(f"{picture}: no description: draw it anew")
    return json.loads(described[1].replace("&quot;", '"').replace("&amp;", "&"))


def differences(drawn: dict[str, object], found: dict[str, object]) -> list[str]:
    """One sentence for each part that differs."""
    sentences = []
    for room in found:
        before, now = drawn.get(room), found[room]
        if not isinstance(now, dict) or not isinstance(before, dict):
            if before != now:
                sentences.append(f"{room}: drawn {before}, in the tree {now}")
            continue
        for part in sorted({*before, *now}):
            if before.get(part) != now.get(part):
                sentences.append(f"{part}: drawn {before.get(part, 'not at all')}, in the tree {now.get(part, 'not at all')}")
    return sentences


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare the picture with the tree instead of drawing it")
    check = parser.parse_args().check
    found = house(ROOT)
    if not check:
        draw(found, PICTURE)
        return 0
    wrong = differences(data_of(PICTURE), found)
    if wrong:
        print("\n".join([*wrong, "run /usr/bin/python3 scripts/pack/house_picture.py"]), file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
