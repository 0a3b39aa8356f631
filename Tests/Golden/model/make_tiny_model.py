"""Writes tiny.haptoflow, a model whose every output can be worked out by hand, and what it must answer:
tiny.expected.json, noise.expected.json. Run: python3 make_tiny_model.py"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import tiny_graphs as graphs

from haptoflow_writer import write_model
from reference_noise import latent_noise, philox, standard_normal

HERE = Path(__file__).parent
REQUESTS = 3
SEED_SAMPLES = 400


def label(name: str, row: int, wavelength_metres: float | None) -> dict:
    return {"name": name, "embedding_row": row, "level_exponents": {"speed": 0.5, "force": 0.25},
            "frequency_exponent": 1.0 if wavelength_metres else 0.5,
            "periodic": wavelength_metres is not None, "wavelength_metres": wavelength_metres,
            "stiffness_newtons_per_metre": 600.0, "friction_coefficient": 0.3, "category": "test"}


def tier(name: str, kind: str, field: str, solver: str, steps: int) -> dict:
    return {"name": name, "kind": kind, "field": field, "level": "level", "solver": solver, "steps": steps,
            "parameters": 267, "representation": "raw", "accuracy": {}, "cost": {}}


def header() -> dict:
    latent = tier("latent", "flow", "latent_field", "midpoint", 2)
    latent |= {"representation": "latent", "latent_shape": graphs.LATENT_SHAPE, "encoder": "encoder",
               "decoder": "decoder"}
    return {
        "name": "tiny",
        "description": "Linear graphs for the tests. It does not sound like anything.",
        "provenance": {"statement": "not trained: written by hand for the tests", "recordings": "none",
                       "licence": "MIT", "seed": 0, "commit": "", "configuration": {}, "created": ""},
        "sample_rate_hz": 2000, "segment_samples": graphs.SAMPLES, "embedding_size": 64,
        "normalisation": {"unit": "m/s^2", "peak_mps2": 10.0},
        "range": {"speed_mps": [0.0, 0.5], "force_newtons": [0.0, 5.0],
                  "speed_percentiles_mps": [0.02, 0.06, 0.1, 0.2, 0.3],
                  "force_percentiles_newtons": [0.2, 0.5, 1.0, 2.0, 3.0]},
        "labels": [label("plain", 0, None), label("ruled", 1, 0.001)],
        "tiers": [tier("draft", "average-velocity", "average_field", "euler", 1),
                  tier("standard", "flow", "flow_field", "midpoint", 2),
                  tier("fine", "flow", "flow_field", "heun", 8),
                  tier("direct", "direct", "direct_field", "euler", 1), latent],
        "default_tier": "standard",
        "seed_bank": {"samples": SEED_SAMPLES, "tensor": "seeds",
                      "entries": [{"label": "plain", "velocity_mps": [0.1, 0.0], "force_newtons": 1.0},
                                  {"label": "ruled", "velocity_mps": [0.1, 0.0], "force_newtons": 1.0}]},
    }


def blobs() -> dict[str, bytes | np.ndarray]:
    rows = np.arange(2)[:, None]
    phase = 2.0 * np.pi * np.arange(SEED_SAMPLES) / SEED_SAMPLES
    return {
        "embedding": np.sin(rows + 0.1 * np.arange(64)[None, :]),
        "seeds": np.sqrt(2.0) * np.sin(np.array([[20.0], [50.0]]) * phase[None, :]),
        "flow_field": graphs.flow_graph([1, graphs.SAMPLES]), "average_field": graphs.average_graph(),
        "direct_field": graphs.direct_graph(), "level": graphs.level_graph(),
        "latent_field": graphs.flow_graph(graphs.LATENT_SHAPE), "encoder": graphs.encoder_graph(),
        "decoder": graphs.decoder_graph(), **graphs.wrong_graphs(),
    }


def solve(field, point: np.ndarray, solver: str, steps: int) -> np.ndarray:
    step = 1.0 / steps
    for index in range(steps):
        time = index * step
        slope = field(point, time)
        if solver == "euler":
            point = point + step * slope
        elif solver == "midpoint":
            point = point + step * field(point + 0.5 * step * slope, time + 0.5 * step)
        else:
            point = point + 0.5 * step * (slope + field(point + step * slope, time + step))
    return point


def answer(case: dict, requests: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Levels [B,1] and segments [B,200], both in m/s^2."""
    level = np.exp(graphs.log_level(requests["embedding"], requests["motion"]))
    cond = graphs.condition(requests["embedding"], requests["motion"])[:, :, None]
    previous = np.clip(requests["previous"] / level, -16.0, 16.0)[:, None, :]
    noise = requests["noise"][:, None, :]
    steps = case["steps"]
    if case["tier"] == "direct":
        point = graphs.direct(noise, 0.0, previous, cond)
    elif case["tier"] == "draft":
        point = solve(lambda x, t: graphs.average(x, t, 1.0 / steps, cond), noise, "euler", steps)
    elif case["tier"] == "latent":
        start = np.stack([latent_noise(row, 100).reshape(graphs.LATENT_SHAPE) for row in requests["noise"]])
        encoded = graphs.encode(previous)
        latent = solve(lambda x, t: graphs.flow(x, t, encoded, cond), start, case["solver"], steps)
        point = graphs.decode(latent)
    else:
        point = solve(lambda x, t: graphs.flow(x, t, previous, cond), noise, case["solver"], steps)
    return level, point[:, 0, :] * level


def rounded(values: np.ndarray) -> list:
    return np.vectorize(lambda value: float(f"{value:.9g}"))(values).tolist()


def expected() -> dict:
    random = np.random.default_rng(2024)
    requests = {
        "embedding": random.normal(0.0, 1.0, (REQUESTS, 64)),
        "motion": np.array([[0.1, 0.05, 1.0], [-0.2, 0.0, 2.5], [0.0, 0.3, 0.4]]),
        # The last row is loud enough to be limited.
        "previous": random.normal(0.0, 1.0, (REQUESTS, graphs.SAMPLES)) * np.array([[1.0], [3.0], [40.0]]),
        "noise": random.normal(0.0, 1.0, (REQUESTS, graphs.SAMPLES)),
    }
    requests = {name: values.astype(np.float32).astype(np.float64) for name, values in requests.items()}
    cases = [{"tier": "standard", "solver": solver, "steps": steps}
             for solver, steps in [("euler", 1), ("euler", 4), ("euler", 16), ("midpoint", 1),
                                   ("midpoint", 3), ("heun", 1), ("heun", 2), ("heun", 16)]]
    cases += [{"tier": "draft", "solver": "euler", "steps": steps} for steps in (1, 4)]
    cases += [{"tier": "direct", "solver": "euler", "steps": 1},
              {"tier": "latent", "solver": "midpoint", "steps": 2}]
    for case in cases:
        level, segments = answer(case, requests)
        case["levels_mps2"] = rounded(level[:, 0])
        case["segments_mps2"] = rounded(segments)
    return {"requests": {name: rounded(values) for name, values in requests.items()}, "cases": cases}


def expected_noise() -> dict:
    keys = [(0, 0, 0, 8), (1, 0, 0, 8), (0, 1, 0, 8), (0, 0, 1, 8), (2**64 - 1, 2**32 - 1, 2**64 - 1, 7),
            (42, 3, 2**32, 200)]
    return {"philox_of_zeros": philox([0] * 4, [0] * 2),
            "noise": [{"seed": seed, "voice": voice, "segment": segment,
                       "values": rounded(standard_normal(seed, voice, segment, count))}
                      for seed, voice, segment, count in keys]}


def main() -> None:
    write_model(HERE / "tiny.haptoflow", header(), blobs())
    (HERE / "tiny.expected.json").write_text(json.dumps(expected()) + "\n", encoding="utf-8")
    (HERE / "noise.expected.json").write_text(json.dumps(expected_noise(), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
