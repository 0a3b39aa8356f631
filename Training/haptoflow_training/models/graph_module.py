"""ONNX graphs of a model file as PyTorch functions with gradients, so that a model file is enough to fit a material.

Supports the operators that `haptoflow-training` exports for its own tiers, and those of the tests' hand-written graphs.
Nodes that depend only on constants are computed once; nodes that depend on the batch size, once for each size. (No
package in Debian converts ONNX graphs to PyTorch.)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import onnx
import torch
from onnx import helper, numpy_helper
from torch import Tensor
from torch.nn import functional

from haptoflow_training.errors import InputError

_Attributes = dict[str, Any]
_Operation = Callable[..., Any]


def _integers(values: Tensor) -> list[int]:
    return [int(value) for value in values.reshape(-1).tolist()]


def _axes(attributes: _Attributes, operand: Tensor | None) -> list[int]:
    return _integers(operand) if operand is not None else list(attributes.get("axes", []))


def _reduced(reduce: Callable[[Tensor, list[int], bool], Tensor]) -> Callable[[_Attributes], _Operation]:
    def build(attributes: _Attributes) -> _Operation:
        def run(values: Tensor, axes: Tensor | None = None) -> Tensor:
            chosen = _axes(attributes, axes) or list(range(values.dim()))
            return reduce(values, chosen, bool(attributes.get("keepdims", 1)))

        return run

    return build


def _gemm(attributes: _Attributes) -> _Operation:
    alpha, beta = attributes.get("alpha", 1.0), attributes.get("beta", 1.0)
    turned = [bool(attributes.get(name, 0)) for name in ("transA", "transB")]

    def run(first: Tensor, second: Tensor, bias: Tensor | None = None) -> Tensor:
        first, second = (part.t() if turn else part for part, turn in zip((first, second), turned, strict=True))
        product = alpha * (first @ second) if alpha != 1.0 else first @ second
        return product if bias is None else product + (bias if beta == 1.0 else beta * bias)

    return run


def _windows(attributes: _Attributes, dimensions: int) -> tuple[list[int], list[int], list[int], int]:
    """Strides, dilations, symmetric pads and groups of a convolution."""
    if attributes.get("auto_pad", b"NOTSET") not in (b"NOTSET", b"VALID"):
        raise InputError("a graph's convolution has auto_pad; export it with explicit pads")
    pads = list(attributes.get("pads", [0] * (2 * dimensions)))
    if pads[:dimensions] != pads[dimensions:]:
        raise InputError("a graph's convolution has pads that differ before and after; this reader knows equal ones")
    ones = [1] * dimensions
    return (
        list(attributes.get("strides", ones)),
        list(attributes.get("dilations", ones)),
        pads[:dimensions],
        attributes.get("group", 1),
    )


def _convolution(attributes: _Attributes) -> _Operation:
    def run(values: Tensor, weight: Tensor, bias: Tensor | None = None) -> Tensor:
        strides, dilations, pads, groups = _windows(attributes, weight.dim() - 2)
        apply = (functional.conv1d, functional.conv2d)[weight.dim() - 3]
        return apply(values, weight, bias, strides, pads, dilations, groups)

    return run


def _transposed_convolution(attributes: _Attributes) -> _Operation:
    def run(values: Tensor, weight: Tensor, bias: Tensor | None = None) -> Tensor:
        strides, dilations, pads, groups = _windows(attributes, weight.dim() - 2)
        extra = list(attributes.get("output_padding", [0] * len(strides)))
        apply = (functional.conv_transpose1d, functional.conv_transpose2d)[weight.dim() - 3]
        return apply(values, weight, bias, strides, pads, extra, groups, dilations)

    return run


def _slice(attributes: _Attributes) -> _Operation:
    def run(
        values: Tensor, starts: Tensor, ends: Tensor, axes: Tensor | None = None, steps: Tensor | None = None
    ) -> Tensor:
        first, last = _integers(starts), _integers(ends)
        chosen = list(range(len(first))) if axes is None else _integers(axes)
        strides = [1] * len(first) if steps is None else _integers(steps)
        for axis, start, end, step in zip(chosen, first, last, strides, strict=True):
            picked = range(values.shape[axis])[slice(start, end, step)]
            if step == 1:
                values = values.narrow(axis, picked.start, len(picked))
            else:
                values = values.index_select(axis, torch.tensor(list(picked), dtype=torch.int64))
        return values

    return run


def _split(attributes: _Attributes) -> _Operation:
    axis = attributes.get("axis", 0)
    return lambda values, sizes: values.split(_integers(sizes), dim=axis)


def _gather(attributes: _Attributes) -> _Operation:
    axis = attributes.get("axis", 0)

    def run(values: Tensor, index: Tensor) -> Tensor:
        wrapped = torch.where(index < 0, index + values.shape[axis], index)
        picked = values.index_select(axis, wrapped.reshape(-1))
        where = axis % values.dim()
        return picked.reshape(*values.shape[:where], *index.shape, *values.shape[where + 1 :])

    return run


def _reshape(attributes: _Attributes) -> _Operation:
    def run(values: Tensor, shape: Tensor) -> Tensor:
        wanted = _integers(shape)
        if not attributes.get("allowzero", 0):
            wanted = [values.shape[place] if size == 0 else size for place, size in enumerate(wanted)]
        return values.reshape(wanted)

    return run


def _squeeze(values: Tensor, axes: Tensor | None = None) -> Tensor:
    chosen = range(values.dim()) if axes is None else [axis % values.dim() for axis in _integers(axes)]
    for axis in sorted(chosen, reverse=True):
        if axes is not None or values.shape[axis] == 1:
            values = values.squeeze(axis)
    return values


def _unsqueeze(values: Tensor, axes: Tensor) -> Tensor:
    rank = values.dim() + axes.numel()
    for axis in sorted(axis % rank for axis in _integers(axes)):
        values = values.unsqueeze(axis)
    return values


def _pad(attributes: _Attributes) -> _Operation:
    if attributes.get("mode", b"constant") != b"constant":
        raise InputError("a graph's Pad has a mode other than constant, which this reader does not know")

    def run(values: Tensor, pads: Tensor, filling: Tensor | None = None) -> Tensor:
        sizes = _integers(pads)
        rank = len(sizes) // 2
        pairs = [size for axis in reversed(range(rank)) for size in (sizes[axis], sizes[axis + rank])]
        return functional.pad(values, pairs, value=0.0 if filling is None else float(filling))

    return run


def _clip(values: Tensor, low: Tensor | None = None, high: Tensor | None = None) -> Tensor:
    return values.clamp(None if low is None else float(low), None if high is None else float(high))


def _filled(attributes: _Attributes) -> _Operation:
    value = attributes.get("value")
    filling = torch.zeros(1) if value is None else _tensor(value)
    return lambda shape: torch.full(_integers(shape), filling.item(), dtype=filling.dtype)


def _cast(attributes: _Attributes) -> _Operation:
    kinds = {1: torch.float32, 6: torch.int32, 7: torch.int64, 9: torch.bool, 11: torch.float64}
    kind = kinds[attributes["to"]]
    return lambda values: values.to(kind)


def _summed(*values: Tensor) -> Tensor:
    total = values[0]
    for value in values[1:]:
        total = total + value
    return total


def _plain(operation: _Operation) -> Callable[[_Attributes], _Operation]:
    return lambda attributes: operation


def _along(name: str, operation: Callable[[Any, int], Tensor], default: int) -> Callable[[_Attributes], _Operation]:
    return lambda attributes: lambda *values: operation(values, attributes.get(name, default))


_OPERATIONS: dict[str, Callable[[_Attributes], _Operation]] = {
    "Abs": _plain(torch.abs),
    "Add": _plain(torch.add),
    "Cast": _cast,
    "Clip": _plain(_clip),
    "Concat": _along("axis", lambda values, axis: torch.cat(values, dim=axis), 0),
    "ConstantOfShape": _filled,
    "Conv": _convolution,
    "ConvTranspose": _transposed_convolution,
    "Cos": _plain(torch.cos),
    "Div": _plain(torch.div),
    "Equal": _plain(torch.eq),
    "Exp": _plain(torch.exp),
    "Expand": _plain(lambda values, shape: values * torch.ones(_integers(shape), dtype=values.dtype)),
    "Floor": _plain(torch.floor),
    "Gather": _gather,
    "Gemm": _gemm,
    "Greater": _plain(torch.gt),
    "Identity": _plain(lambda values: values),
    "Less": _plain(torch.lt),
    "Log": _plain(torch.log),
    "MatMul": _plain(torch.matmul),
    "Max": _plain(torch.maximum),
    "Min": _plain(torch.minimum),
    "Mul": _plain(torch.mul),
    "Neg": _plain(torch.neg),
    "Pad": _pad,
    "Pow": _plain(torch.pow),
    "ReduceL2": _reduced(lambda values, axes, keep: torch.linalg.vector_norm(values, dim=axes, keepdim=keep)),
    "ReduceMean": _reduced(lambda values, axes, keep: values.mean(dim=axes, keepdim=keep)),
    "ReduceSum": _reduced(lambda values, axes, keep: values.sum(dim=axes, keepdim=keep)),
    "Relu": _plain(torch.relu),
    "Reshape": _reshape,
    "Shape": _plain(lambda values: torch.tensor(values.shape)),
    "Sigmoid": _plain(torch.sigmoid),
    "Sign": _plain(torch.sign),
    "Sin": _plain(torch.sin),
    "Slice": _slice,
    "Softmax": _along("axis", lambda values, axis: torch.softmax(values[0], dim=axis), -1),
    "Split": _split,
    "Sqrt": _plain(torch.sqrt),
    "Squeeze": _plain(_squeeze),
    "Sub": _plain(torch.sub),
    "Sum": _plain(_summed),
    "Tanh": _plain(torch.tanh),
    "Transpose": lambda attributes: lambda values: values.permute(attributes["perm"]),
    "Unsqueeze": _plain(_unsqueeze),
    "Where": _plain(torch.where),
}


def _tensor(value: onnx.TensorProto) -> Tensor:
    return torch.from_numpy(np.array(numpy_helper.to_array(value)))


def _is_learnt(name: str, values: Tensor) -> bool:
    """Whether a constant is a trained weight, by the exporter's naming: layers keep their names, folded weights are
    named after the operator that reads them. The rib comb's matrices are constants, whatever their names."""
    if not values.is_floating_point() or ".comb." in name:
        return False
    return name.endswith((".weight", ".bias")) or (name.startswith("onnx::") and values.dim() >= 2)


class _Node:
    """An operator with the names of its inputs and outputs."""

    def __init__(self, node: onnx.NodeProto, where: str) -> None:
        if node.op_type not in _OPERATIONS:
            raise InputError(
                f"{where}: operator {node.op_type} has no gradient here; materials are fitted to flow, "
                "average-velocity and direct tiers that haptoflow-training exported"
            )
        attributes = {entry.name: helper.get_attribute_value(entry) for entry in node.attribute}
        self.run = _OPERATIONS[node.op_type](attributes)
        self.kind = node.op_type
        self.inputs, self.outputs = list(node.input), list(node.output)

    def apply(self, values: dict[str, Any]) -> None:
        made = self.run(*(values[name] if name else None for name in self.inputs))
        for name, value in zip(self.outputs, made if isinstance(made, tuple) else (made,), strict=True):
            values[name] = value


class GraphModule:
    """One graph. `inputs` and `output` are the names in the file. trainable: the layers' weights take gradients, as
    `weights`; otherwise none does."""

    def __init__(self, graph: bytes, where: str = "graph", *, trainable: bool = False) -> None:
        document = onnx.load_from_string(graph).graph
        known: dict[str, Any] = {entry.name: _tensor(entry) for entry in document.initializer}
        self.inputs = [entry.name for entry in document.input if entry.name not in known]
        self.weights: dict[str, Tensor] = {}
        if trainable:
            self.weights = {name: known[name].requires_grad_() for name in known if _is_learnt(name, known[name])}
        self.output = document.output[0].name
        self._nodes: list[_Node] = []
        self._sized: list[_Node] = []
        by_size: set[str] = set()
        by_weights: set[str] = set()
        for node in document.node:
            if node.op_type == "Constant":
                known[node.output[0]] = _tensor(helper.get_attribute_value(node.attribute[0]))
                continue
            compiled = _Node(node, where)
            read = [name for name in compiled.inputs if name]
            moving = any(name in self.weights or name in by_weights for name in read)
            if moving:
                by_weights.update(compiled.outputs)
                self._nodes.append(compiled)
            elif all(name in known for name in read):
                compiled.apply(known)
            elif all(name in known or name in by_size for name in read) or (
                compiled.kind == "Shape" and read[0] in self.inputs
            ):
                by_size.update(compiled.outputs)
                self._sized.append(compiled)
            else:
                self._nodes.append(compiled)
        self._known = known
        self._by_size: dict[tuple[tuple[int, ...], ...], dict[str, Any]] = {}

    def __call__(self, given: dict[str, Tensor]) -> Tensor:
        """The output for inputs by name; inputs that the graph does not read are ignored."""
        read = {name: given[name] for name in self.inputs}
        sizes = tuple(tuple(value.shape) for value in read.values())
        if sizes not in self._by_size:
            fixed = {**self._known, **read}
            for node in self._sized:
                node.apply(fixed)
            self._by_size[sizes] = {name: fixed[name] for node in self._sized for name in node.outputs}
        values = {**self._known, **self._by_size[sizes], **read}
        for node in self._nodes:
            node.apply(values)
        made: Tensor = values[self.output]
        return made

    @property
    def operators(self) -> Sequence[str]:
        """The kinds of operators that run in each call, in order."""
        return [node.kind for node in self._nodes]
