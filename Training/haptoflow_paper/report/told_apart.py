"""Whether renders can be told from recordings, label by label: the error rate of a classifier of one-second excerpts.

Logistic regression over features that a hand perceives. Each motion is used either for fitting or for testing, so that
no recording and no render is on both sides.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.report.temporal_metrics import ENVELOPE_SAMPLES, crest_factor, kurtosis, variation
from haptoflow_paper.report.cell_figures import SETTLING_SAMPLES
from haptoflow_paper.report.row_metrics import CRITICAL_BAND_EDGES_HZ
from haptoflow_paper.rows.reference_set import ReferencePair
from haptoflow_training.waveform import SAMPLE_RATE_HZ

EXCERPT_SAMPLES = SAMPLE_RATE_HZ
_MODULATION_EDGES_HZ = (2.0, 5.0, 10.0, 20.0, 40.0, 100.0)
# Vibration below 0.01 m/s^2 cannot be felt; sensor noise must not distinguish a recording from silence.
_FELT_MPS2 = 0.01
_FOLDS = 4
_PENALTY = 1.0
_NEWTON_STEPS = 25

_Doubles = NDArray[np.float64]


def features(wave: NDArray[np.floating]) -> _Doubles:
    """For each whole second after the settling, [excerpts, 17]: nine critical-band energies and crest in dB, ln of
    the envelope's kurtosis and of its coefficient of variation, the envelope's power in five modulation bands, dB."""
    settled = np.asarray(wave[SETTLING_SAMPLES:], dtype=np.float64)
    count = len(settled) // EXCERPT_SAMPLES
    excerpts = settled[: count * EXCERPT_SAMPLES].reshape(count, EXCERPT_SAMPLES)
    spectra = np.square(np.abs(np.fft.rfft(excerpts, axis=1))) * 2.0 / EXCERPT_SAMPLES**2
    bands = _sums(spectra, EXCERPT_SAMPLES / SAMPLE_RATE_HZ, CRITICAL_BAND_EDGES_HZ)
    framed = excerpts.reshape(count, -1, ENVELOPE_SAMPLES)
    envelopes = np.sqrt(np.square(framed).mean(axis=2) + _FELT_MPS2**2)
    swings = envelopes / envelopes.mean(axis=1, keepdims=True) - 1.0
    modulation = np.square(np.abs(np.fft.rfft(swings, axis=1))) * 2.0 / swings.shape[1] ** 2
    crest = [20.0 * np.log10(crest_factor(excerpt) + 0.1) for excerpt in excerpts]
    shape = [[np.log(kurtosis(each) + 0.1), np.log(variation(each) + 1e-3)] for each in envelopes]
    return np.column_stack(
        [
            10.0 * np.log10(bands + _FELT_MPS2**2),
            np.reshape(crest, (count, 1)),
            np.reshape(shape, (count, 2)),
            10.0 * np.log10(_sums(modulation, 1.0, _MODULATION_EDGES_HZ) + 1e-6),
        ]
    )


def _sums(power: _Doubles, seconds: float, edges_hz: Sequence[float]) -> _Doubles:
    """power [n, bins], bins 1 / seconds apart; [n, bands]."""
    frequency = np.arange(power.shape[1]) / seconds
    bands = zip(edges_hz[:-1], edges_hz[1:], strict=True)
    return np.stack([power[:, (frequency >= low) & (frequency < high)].sum(axis=1) for low, high in bands], axis=1)


def told_apart_percent(pairs: Sequence[ReferencePair], waves: Sequence[NDArray[np.floating]]) -> list[float | None]:
    """For each pair, the percentage of its excerpts (of `recorded` and of its wave) that regressions fitted to other
    motions of the label classify correctly; chance is 50. None for changes of label."""
    result: list[float | None] = [None] * len(pairs)
    labels: dict[str, list[int]] = {}
    for index, pair in enumerate(pairs):
        if pair.condition.kind != "change":
            labels.setdefault(pair.condition.label, []).append(index)
    for rows in labels.values():
        recorded = [features(pairs[row].recorded) for row in rows]
        made = [features(waves[row]) for row in rows]
        for row, percent in zip(rows, _cross_validated(recorded, made), strict=True):
            result[row] = percent
    return result


def _cross_validated(recorded: list[_Doubles], made: list[_Doubles]) -> list[float | None]:
    folds = np.arange(len(recorded)) % _FOLDS
    found: list[float | None] = [None] * len(recorded)
    for fold in range(_FOLDS):
        learnt, asked = np.flatnonzero(folds != fold), np.flatnonzero(folds == fold)
        if not len(learnt) or not len(asked):
            continue
        given = np.concatenate([*(recorded[row] for row in learnt), *(made[row] for row in learnt)])
        sides = np.repeat([0.0, 1.0], [sum(len(set_[row]) for row in learnt) for set_ in (recorded, made)])
        mean, deviation = given.mean(axis=0), given.std(axis=0) + 1e-9
        weights = logistic_regression((given - mean) / deviation, sides)
        for row in asked:
            named = [_classified_as_render((set_[row] - mean) / deviation, weights) for set_ in (recorded, made)]
            if len(named[0]) and len(named[1]):
                found[row] = 50.0 * float((1.0 - named[0].mean()) + named[1].mean())
    return found


def logistic_regression(given: _Doubles, sides: _Doubles) -> _Doubles:
    """Weights [features + 1], the constant last, that minimise the logistic loss plus half the squared weights (without
    the constant), by Newton's method.

    (scikit-learn is no dependency of this project.)
    """
    design = np.column_stack([given, np.ones(len(given))])
    penalty = _PENALTY * np.eye(design.shape[1])
    penalty[-1, -1] = 1e-6
    weights = np.zeros(design.shape[1])
    for _ in range(_NEWTON_STEPS):
        chance = _chance(design @ weights)
        gradient = design.T @ (chance - sides) + penalty @ weights
        curvature = (design * (chance * (1.0 - chance) + 1e-6)[:, None]).T @ design + penalty
        step = np.linalg.solve(curvature, gradient)
        weights = weights - step
        if np.abs(step).max() < 1e-6:
            break
    return weights


def _chance(logits: _Doubles) -> _Doubles:
    return 1.0 / (1.0 + np.exp(-np.clip(logits, -30.0, 30.0)))


def _classified_as_render(given: _Doubles, weights: _Doubles) -> NDArray[np.float64]:
    """1 where an excerpt is classified as a render, 0 where as a recording."""
    return (np.column_stack([given, np.ones(len(given))]) @ weights > 0.0).astype(np.float64)
