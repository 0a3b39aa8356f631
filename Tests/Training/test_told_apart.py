"""Classification of renders and recordings: at chance level for draws of one process."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from haptoflow_paper.metrics.told_apart import logistic_regression, told_apart_percent
from haptoflow_paper.reference.reference_conditions import Condition
from haptoflow_paper.reference.reference_set import ReferencePair

_SAMPLES = 24400


def _wave(seed: int, level: float, impacts: float = 0.0) -> NDArray[np.float32]:
    generator = np.random.default_rng(seed)
    wave = np.convolve(generator.standard_normal(_SAMPLES), np.hanning(7), mode="same")
    wave += impacts * np.where(generator.random(_SAMPLES) < 0.001, generator.choice([-1.0, 1.0], _SAMPLES), 0.0)
    return (level * wave).astype(np.float32)


def _pairs(label: str, kind: str = "constant", impacts: float = 0.0) -> list[ReferencePair]:
    motion = np.zeros((_SAMPLES, 3), dtype=np.float32)
    pairs = []
    for number in range(12):
        condition = Condition(label, 0, kind, 0.1 + 0.05 * number, 1.0, 0.0, 12.0, number)
        recorded, again = (_wave(100 * repeat + number, 1.0 + 0.3 * number, impacts) for repeat in (1, 2))
        pairs.append(ReferencePair(condition, recorded, again, motion))
    return pairs


def _mean(values: list[float | None]) -> float:
    return float(np.mean([value for value in values if value is not None]))


def test_another_draw_of_the_same_process_is_told_apart_only_by_chance() -> None:
    pairs = _pairs("stone", impacts=30.0)
    found = told_apart_percent(pairs, [pair.independent for pair in pairs])
    assert len(found) == 12 and 35.0 < _mean(found) < 62.0


def test_gaussian_noise_of_the_right_spectrum_is_told_from_rare_impacts() -> None:
    pairs = _pairs("stone", impacts=60.0)
    made = [
        (pair.recorded.std() / np.std(_wave(n, 1.0)) * _wave(7000 + n, 1.0)).astype(np.float32)
        for n, pair in enumerate(pairs)
    ]
    assert _mean(told_apart_percent(pairs, made)) > 85.0


def test_no_motion_is_used_for_both_fitting_and_testing() -> None:
    # Every motion has its own pitch. Memorised, each would identify its render; from other motions, none does.
    generator = np.random.default_rng(3)
    time = np.arange(_SAMPLES) / 2000.0
    motion = np.zeros((_SAMPLES, 3), dtype=np.float32)
    pairs, made = [], []
    for number in range(12):
        pitches = generator.uniform(50.0, 900.0, size=2)
        tones = [(np.sin(2 * np.pi * pitch * time) + 0.1 * generator.standard_normal(_SAMPLES)) for pitch in pitches]
        condition = Condition("a", 0, "constant", 0.1, 1.0, 0.0, 12.0, number)
        pairs.append(ReferencePair(condition, tones[0].astype(np.float32), tones[0].astype(np.float32), motion))
        made.append(tones[1].astype(np.float32))
    assert _mean(told_apart_percent(pairs, made)) < 75.0


def test_the_regression_recovers_the_weights_that_made_the_classes() -> None:
    generator = np.random.default_rng(5)
    given = generator.standard_normal((40000, 3))
    truth = np.array([1.0, -2.0, 0.0])
    sides = (generator.random(40000) < 1.0 / (1.0 + np.exp(-(given @ truth + 0.5)))).astype(np.float64)
    assert logistic_regression(given, sides) == pytest.approx([1.0, -2.0, 0.0, 0.5], abs=0.06)
