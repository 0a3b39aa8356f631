"""The graphs of the tiny model and the formulas that they compute. They are linear, so that a reader can
follow them, and quadratic in time, so that solvers differ."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from onnx import TensorProto, checker, helper, numpy_helper

SAMPLES = 200
LATENT_SHAPE = [4, 25]
EMBEDDING_WEIGHTS = (0.02 * np.cos(0.3 * np.arange(64))).astype(np.float32)[:, None]
MOTION_WEIGHTS = np.array([0.5, -0.25, 0.125], dtype=np.float32)[:, None]
LEVEL_EMBEDDING_WEIGHTS = (0.03 * np.sin(0.2 * np.arange(64))).astype(np.float32)[:, None]
LEVEL_MOTION_WEIGHTS = np.array([0.4, 0.3, 0.2], dtype=np.float32)[:, None]
LEVEL_OFFSET = np.float32(0.5)


def ramp(shape: list[int]) -> np.ndarray:
    return np.linspace(-1.0, 1.0, int(np.prod(shape)), dtype=np.float32).reshape(shape)


def condition(embedding: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """[B,1]"""
    return embedding @ EMBEDDING_WEIGHTS + motion @ MOTION_WEIGHTS


def log_level(embedding: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """[B,1]"""
    return embedding @ LEVEL_EMBEDDING_WEIGHTS + motion @ LEVEL_MOTION_WEIGHTS + LEVEL_OFFSET


def flow(point: np.ndarray, time: float, previous: np.ndarray, cond: np.ndarray) -> np.ndarray:
    """The velocity field of kind `flow`; `cond` broadcasts over the point."""
    return -0.5 * point + 0.75 * time * time + 0.25 * previous + ramp(list(point.shape[1:])) * cond


def average(point: np.ndarray, time: float, interval: float, cond: np.ndarray) -> np.ndarray:
    """Kind `average-velocity`; it leaves out `previous`."""
    return -0.5 * point + 0.75 * time + 0.3 * interval + ramp(list(point.shape[1:])) * cond


def direct(point: np.ndarray, time: float, previous: np.ndarray, cond: np.ndarray) -> np.ndarray:
    return 0.5 * point + time + 0.25 * previous + ramp(list(point.shape[1:])) * cond


def encode(waveform: np.ndarray) -> np.ndarray:
    return waveform.reshape(-1, *LATENT_SHAPE, 2).mean(axis=-1)


def decode(latent: np.ndarray) -> np.ndarray:
    return (latent[..., None] * np.array([1.0, 0.5])).reshape(-1, 1, SAMPLES)


class _Graph:
    """Collects nodes and constants; each method returns the name of its result."""

    def __init__(self) -> None:
        self.nodes: list = []
        self.constants: list = []

    def constant(self, value: np.ndarray | float | list) -> str:
        array = np.asarray(value)
        array = array.astype(np.int64 if array.dtype.kind == "i" else np.float32)
        name = f"constant{len(self.constants)}"
        self.constants.append(numpy_helper.from_array(array, name))
        return name

    def apply(self, operator: str, *inputs: str, output: str | None = None, **attributes) -> str:
        name = output or f"node{len(self.nodes)}"
        self.nodes.append(helper.make_node(operator, list(inputs), [name], **attributes))
        return name

    def scaled(self, factor: float, value: str) -> str:
        return self.apply("Mul", self.constant(np.float32(factor)), value)

    def total(self, output: str, *terms: str) -> str:
        return self.apply("Sum", *terms, output=output)

    def broadcast(self, value: str, dimensions: int) -> str:
        """[B,1] -> [B,1,...] of `dimensions` behind the batch."""
        return self.apply("Reshape", value, self.constant([-1] + [1] * dimensions))

    def finish(self, inputs: dict[str, list], outputs: dict[str, list],
               element: int = TensorProto.FLOAT) -> bytes:
        graph = helper.make_graph(
            self.nodes, "tiny",
            [helper.make_tensor_value_info(name, element, shape) for name, shape in inputs.items()],
            [helper.make_tensor_value_info(name, element, shape) for name, shape in outputs.items()],
            self.constants)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 16)], producer_name="")
        model.ir_version = 8
        checker.check_model(model)
        return model.SerializeToString()


def _conditioned(graph: _Graph, shape: list[int]) -> str:
    weighted = graph.apply("Add", graph.apply("MatMul", "embedding", graph.constant(EMBEDDING_WEIGHTS)),
                           graph.apply("MatMul", "motion", graph.constant(MOTION_WEIGHTS)))
    return graph.apply("Mul", graph.constant(ramp(shape)), graph.broadcast(weighted, len(shape)))


def flow_graph(shape: list[int]) -> bytes:
    graph = _Graph()
    time = graph.broadcast("time", len(shape))
    graph.total("velocity", graph.scaled(-0.5, "noisy"), graph.scaled(0.75, graph.apply("Mul", time, time)),
                graph.scaled(0.25, "previous"), _conditioned(graph, shape))
    return graph.finish({"noisy": ["B", *shape], "time": ["B", 1], "previous": ["B", *shape],
                         "embedding": ["B", 64], "motion": ["B", 3]}, {"velocity": ["B", *shape]})


def average_graph() -> bytes:
    graph = _Graph()
    shape = [1, SAMPLES]
    graph.total("velocity", graph.scaled(-0.5, "noisy"), graph.scaled(0.75, graph.broadcast("time", 2)),
                graph.scaled(0.3, graph.broadcast("interval", 2)), _conditioned(graph, shape))
    return graph.finish({"noisy": ["B", *shape], "time": ["B", 1], "interval": ["B", 1],
                         "embedding": ["B", 64], "motion": ["B", 3]}, {"velocity": ["B", *shape]})


def direct_graph() -> bytes:
    graph = _Graph()
    shape = [1, SAMPLES]
    graph.total("segment", graph.scaled(0.5, "noisy"), graph.broadcast("time", 2),
                graph.scaled(0.25, "previous"), _conditioned(graph, shape))
    return graph.finish({"noisy": ["B", *shape], "time": ["B", 1], "previous": ["B", *shape],
                         "embedding": ["B", 64], "motion": ["B", 3]}, {"segment": ["B", *shape]})


def level_graph() -> bytes:
    graph = _Graph()
    graph.total("log_level", graph.apply("MatMul", "embedding", graph.constant(LEVEL_EMBEDDING_WEIGHTS)),
                graph.apply("MatMul", "motion", graph.constant(LEVEL_MOTION_WEIGHTS)),
                graph.constant(LEVEL_OFFSET))
    return graph.finish({"embedding": ["B", 64], "motion": ["B", 3]}, {"log_level": ["B", 1]})


def encoder_graph() -> bytes:
    graph = _Graph()
    pairs = graph.apply("Reshape", "waveform", graph.constant([-1, *LATENT_SHAPE, 2]))
    graph.apply("ReduceMean", pairs, axes=[3], keepdims=0, output="latent")
    return graph.finish({"waveform": ["B", 1, SAMPLES]}, {"latent": ["B", *LATENT_SHAPE]})


def decoder_graph() -> bytes:
    graph = _Graph()
    column = graph.apply("Reshape", "latent", graph.constant([-1, *LATENT_SHAPE, 1]))
    pairs = graph.apply("Mul", column, graph.constant(np.array([1.0, 0.5])))
    graph.apply("Reshape", pairs, graph.constant([-1, 1, SAMPLES]), output="waveform")
    return graph.finish({"latent": ["B", *LATENT_SHAPE]}, {"waveform": ["B", 1, SAMPLES]})


def _one_operator(operator: str, inputs: dict[str, list], output: str, shape: list,
                  element: int = TensorProto.FLOAT) -> bytes:
    graph = _Graph()
    graph.apply(operator, *inputs, output=output)
    return graph.finish(inputs, {output: shape}, element)


def wrong_graphs() -> dict[str, bytes]:
    """Graphs that a reader must refuse at loading, or whose results it must refuse when they run."""
    segment: list = ["B", 1, SAMPLES]
    short: list = ["B", 1, SAMPLES - 1]
    fixed: list = [1, 1, SAMPLES]
    wrong: dict[str, Callable[[], bytes]] = {
        "wrong_shape": lambda: _one_operator("Neg", {"noisy": short}, "velocity", short),
        "wrong_rank": lambda: _one_operator("Neg", {"noisy": ["B", SAMPLES]}, "velocity", ["B", SAMPLES]),
        "wrong_batch": lambda: _one_operator("Neg", {"noisy": fixed}, "velocity", fixed),
        "wrong_type": lambda: _one_operator("Neg", {"noisy": segment}, "velocity", segment,
                                            TensorProto.DOUBLE),
        "wrong_input": lambda: _one_operator("Neg", {"wave": segment}, "velocity", segment),
        "wrong_output": lambda: _one_operator("Neg", {"noisy": segment}, "speed", segment),
        "not_finite_field": lambda: _one_operator("Log", {"noisy": segment}, "velocity", segment),
        "not_finite_level": _infinite_level,
        "not_onnx": lambda: b"these are not the bytes of a graph",
    }
    return {name: make() for name, make in wrong.items()}


def _infinite_level() -> bytes:
    """log_level = log(vx): minus infinity at rest, NaN for a negative vx."""
    graph = _Graph()
    graph.apply("Log", graph.apply("MatMul", "motion", graph.constant(np.array([[1.0], [0.0], [0.0]]))),
                output="log_level")
    return graph.finish({"motion": ["B", 3]}, {"log_level": ["B", 1]})
