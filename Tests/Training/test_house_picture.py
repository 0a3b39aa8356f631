"""The picture of the repository's parts in CONTRIBUTING.md: what it reads from the tree, and that it agrees with it."""

from __future__ import annotations

import functools
import importlib.util
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
_SPEC = importlib.util.spec_from_file_location("house_picture", ROOT / "scripts/pack/house_picture.py")
house_picture = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(house_picture)


@functools.cache
def the_house() -> dict[str, object]:
    return house_picture.house(ROOT)


def test_the_picture_in_the_repository_agrees_with_the_tree() -> None:
    drawn = house_picture.data_of(house_picture.PICTURE)
    assert house_picture.differences(drawn, the_house()) == [], (
        "run /usr/bin/python3 scripts/pack/house_picture.py"
    )


def test_the_tree_itself_is_read() -> None:
    data = the_house()
    assert "haptoflow_model" in data["native"]["haptoflow_inference"]
    assert "HaptoFlow.Core" in data["unity"]["HaptoFlow"]
    assert "haptoflow_training.recordings" in data["haptoflow_training"]["haptoflow_training.training"]
    assert "HaptoFlow.Core" in data["loads the library"]


def test_no_library_of_the_plugin_uses_the_headless_contact_or_the_command_line() -> None:
    native = the_house()["native"]
    used = house_picture.reachable(native, "audioplugin_haptoflow")
    assert not used & {"haptoflow_contact", "haptoflow_headless", "haptoflow_bench", "haptoflow_cli"}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    files = {
        "NativePlugin/a/CMakeLists.txt": "# add_library(not_this)\nhaptoflow_add_library(low SOURCES x.cpp)\n"
        "haptoflow_add_library(high SOURCES y.cpp DEPENDS low Threads::Threads)\n",
        "NativePlugin/b/CMakeLists.txt": "add_executable(program main.cpp)\ntarget_link_libraries(program PRIVATE high)\n",
        "Packages/p/Runtime/Core/Core.asmdef": json.dumps({"name": "Core", "references": ["Unity.Mathematics"]}),
        "Packages/com.haptoflow.runtime/Runtime/Core/C.asmdef": json.dumps({"name": "C", "references": ["Core"]}),
        "Packages/com.haptoflow.runtime/Runtime/Core/Native.cs": 'const string Library = "audioplugin_haptoflow";',
        "Training/one/__init__.py": "",
        "Training/one/upper/__init__.py": "",
        "Training/one/upper/code.py": "def f():\n    from one.lower import thing\n",
        "Training/one/lower/__init__.py": "",
        "Training/one/lower/thing.py": "LIBRARY = 'audioplugin_haptoflow'\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def test_targets_assemblies_and_imports_become_parts(tree: Path) -> None:
    assert house_picture.house(tree) == {
        "unity": {"C": ["Core"], "Core": []},
        "native": {"high": ["low"], "low": [], "program": ["high"]},
        "one": {"one.lower": [], "one.upper": ["one.lower"]},
        "loads the library": ["C", "one.lower"],
    }


def test_a_new_dependency_is_named(tree: Path) -> None:
    before = house_picture.house(tree)
    code = tree / "NativePlugin/b/CMakeLists.txt"
    code.write_text(code.read_text(encoding="utf-8").replace("high)", "high low)"), encoding="utf-8")
    assert house_picture.differences(before, house_picture.house(tree)) == [
        "program: drawn ['high'], in the tree ['high', 'low']"
    ]


def test_a_part_lies_above_what_it_uses_and_parts_that_use_each_other_share_a_row() -> None:
    uses = {"a": ["b"], "b": ["c"], "c": ["b", "d"], "d": []}
    assert house_picture.rows_of(uses) == [["d"], ["b", "c"], ["a"]]


def test_a_use_that_follows_from_others_is_not_drawn() -> None:
    assert house_picture.drawn_uses({"a": ["b", "c"], "b": ["c"], "c": []}) == [("a", "b"), ("b", "c")]


def test_drawing_keeps_the_data_and_gives_the_same_bytes_twice(tmp_path: Path) -> None:
    data = the_house()
    first, second = tmp_path / "first.svg", tmp_path / "second.svg"
    house_picture.draw(data, first)
    house_picture.draw(data, second)
    assert house_picture.data_of(first) == data
    assert first.read_bytes() == second.read_bytes()
