"""The graphs are traced by every PyTorch: older ones know no other way, newer ones have to be told."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import torch
from torch import nn

from haptoflow_training.export.onnx_graphs import export_graph

ROOT = Path(__file__).parents[2]


def test_the_default_exporter_of_pytorch_2_9_is_not_used(monkeypatch: pytest.MonkeyPatch) -> None:
    traced: Callable[..., Any] = torch.onnx.export
    told: list[bool] = []

    def as_of_2_9(model: nn.Module, args: Any, f: Any, *, dynamo: bool = True, **options: Any) -> None:
        told.append(dynamo)
        if dynamo:
            raise ModuleNotFoundError("No module named 'onnxscript'")
        traced(model, args, f, **options)

    monkeypatch.setattr(torch.onnx, "export", as_of_2_9)
    graph = export_graph(nn.Linear(4, 2), {"given": torch.zeros(2, 4)}, "made")
    assert told == [False]
    assert len(graph) > 100


def test_an_older_pytorch_is_given_no_argument_that_it_does_not_know(monkeypatch: pytest.MonkeyPatch) -> None:
    traced: Callable[..., Any] = torch.onnx.export
    names = ("opset_version", "input_names", "output_names", "dynamic_axes", "do_constant_folding")

    def as_of_1_13(
        model: nn.Module, args: Any, f: Any, opset_version: int, input_names: Any, output_names: Any,
        dynamic_axes: Any, do_constant_folding: bool,
    ) -> None:  # fmt: skip
        values = (opset_version, input_names, output_names, dynamic_axes, do_constant_folding)
        traced(model, args, f, **dict(zip(names, values, strict=True)))

    monkeypatch.setattr(torch.onnx, "export", as_of_1_13)
    assert export_graph(nn.Linear(4, 2), {"given": torch.zeros(2, 4)}, "made")


def test_every_dependency_has_a_lower_and_an_upper_bound() -> None:
    project = tomllib.loads((ROOT / "Training" / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = [*project["dependencies"], *(one for extra in project["optional-dependencies"].values() for one in extra)]
    assert len(wanted) >= 10
    assert [one for one in wanted if not re.fullmatch(r"[a-z0-9-]+>=[\d.]+,<\d+", one)] == []
