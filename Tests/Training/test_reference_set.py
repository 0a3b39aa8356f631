"""The recordings that everything is held against: what two of a pair share is the process, not the spot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch

from haptoflow_training.evaluation import reference_set as subject
from haptoflow_training.evaluation.reference_set import Condition, conditions
from haptoflow_training.recordings.synthetic import load_materials


def _fine_structure(wave: NDArray[np.floating]) -> NDArray[np.float64]:
    """What a spectrum of 2 Hz resolution has beyond its smooth form, dB, 100 to 900 Hz."""
    frequency, power = welch(wave, 2000.0, nperseg=1024)
    decibels = 10.0 * np.log10(power)
    kernel = np.ones(21) / 21.0
    chosen = (frequency > 100.0) & (frequency < 900.0)
    return (decibels - np.convolve(decibels, kernel, mode="same"))[chosen]


def _condition(label: str, speed_mps: float) -> Condition:
    found = [entry for entry in conditions(load_materials()) if entry.label == label and entry.speed_mps == speed_mps]
    assert len(found) == 1
    return found[0]


def test_two_recordings_of_a_condition_share_no_fine_structure_of_their_spectra() -> None:
    # A straight line over a surface made of periodic tiles would have lines that no real surface has, in both the same.
    material = next(entry for entry in load_materials() if entry.label == "stone")
    recorded, independent, _ = subject._record_pair((material, _condition("stone", 1.0), 1))
    correlation = np.corrcoef(_fine_structure(recorded), _fine_structure(independent))[0, 1]
    assert abs(correlation) < 0.3, correlation


def test_the_motion_that_networks_are_told_is_the_one_that_was_recorded() -> None:
    material = next(entry for entry in load_materials() if entry.label == "stone")
    condition = _condition("stone", 0.5)
    recorded, _, motion = subject._record_pair((material, condition, 1))
    assert motion.shape == (len(recorded), 3)
    np.testing.assert_allclose(np.hypot(motion[:, 0], motion[:, 1]), 0.5, rtol=1e-5)
    turned = np.degrees(np.unwrap(np.arctan2(motion[:, 1], motion[:, 0])))
    assert abs(abs(turned[-1] - turned[0]) - condition.turn_degrees) < 0.3
    assert abs(((turned.mean() - condition.direction_degrees) + 180.0) % 360.0 - 180.0) < 0.1


def test_across_ribs_a_stroke_is_straight_since_its_direction_is_its_pitch() -> None:
    chosen = conditions(load_materials())
    ruled = {material.label for material in load_materials() if material.rulings}
    constant = [entry for entry in chosen if entry.kind == "constant"]
    assert all((entry.turn_degrees == 0.0) == (entry.label in ruled) for entry in constant)
