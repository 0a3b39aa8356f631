"""Discrimination of materials: the classifier on known spectra, then the shipped model through the engine."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from haptoflow_benchmark.engine_render import write_stroke
from haptoflow_benchmark.label_discrimination import (
    DiscriminationReport, LabelClassifier, StrokeOutcome, concatenate, discriminate, train_classifier,
    window_features, write_report
)
from haptoflow_training.recordings.synthetic import load_materials
from places import ENGINE


def _coloured(generator: np.random.Generator, centre_hz: float, level_mps2: float, samples: int) -> NDArray[np.float64]:
    spectrum = np.fft.rfft(generator.normal(size=samples))
    frequency = np.fft.rfftfreq(samples, 1.0 / 2000.0)
    wave = np.fft.irfft(spectrum * np.exp(-np.square(np.log((frequency + 1.0) / centre_hz))), samples)
    return level_mps2 * wave / wave.std()


def _motion(generator: np.random.Generator, samples: int) -> NDArray[np.float64]:
    speed, angle = 0.02 * 20.0 ** generator.random(), 2.0 * np.pi * generator.random()
    return np.tile([speed * np.cos(angle), speed * np.sin(angle), 0.5 + generator.random()], (samples, 1))


def _features(generator: np.random.Generator, centre_hz: float, gain: float, recordings: int) -> list:
    parts = []
    for _ in range(recordings):
        motion = _motion(generator, 8000)
        level = gain * np.hypot(motion[0, 0], motion[0, 1])
        parts.append(window_features(_coloured(generator, centre_hz, level, 8000), motion))
    return parts


def test_different_spectra_are_distinguished_at_any_speed() -> None:
    generator = np.random.default_rng(1)
    kinds = {"dull": (90.0, 5.0), "bright": (220.0, 5.0), "loud": (90.0, 15.0)}
    classifier = LabelClassifier({name: concatenate(_features(generator, *kind, 12)) for name, kind in kinds.items()})
    for name, kind in kinds.items():
        assert [classifier.name(part) for part in _features(generator, *kind, 8)] == [name] * 8


def test_a_stroke_file_moves_with_the_prescribed_velocity(tmp_path: Path) -> None:
    motion = np.tile([0.1, -0.05, 1.5], (2000, 1))
    write_stroke(tmp_path / "stroke.csv", motion)
    rows = np.loadtxt(tmp_path / "stroke.csv", delimiter=",", skiprows=1)
    velocity = np.diff(rows[:, 1:4], axis=0) / np.diff(rows[:, :1], axis=0)
    np.testing.assert_allclose(velocity, np.tile([0.1, 0.0, 0.05], (len(velocity), 1)), atol=1e-3)
    np.testing.assert_allclose(rows[:, 4], 1.5)


def test_the_report_counts_names_levels_and_order(tmp_path: Path) -> None:
    def outcome(label: str, named: str, rms: float) -> StrokeOutcome:
        return StrokeOutcome(label, "0_hand_1_1_0", named, label, rms * 1.122, rms, 1.0, 0.0)

    report = DiscriminationReport(
        ["a", "b", "c"],
        [outcome("a", "a", 1.0), outcome("b", "a", 2.0), outcome("c", "c", 3.0), outcome("c", "c", 4.0)],
    )
    assert report.render_accuracy == 0.75
    assert report.recording_accuracy == 1.0
    assert report.level_order_spearman == pytest.approx(1.0)
    assert report.level_error_median_db == pytest.approx(1.0, abs=0.01)
    assert report.confusion().tolist() == [[1, 0, 0], [1, 0, 0], [0, 0, 2]]
    write_report(report, tmp_path, "0" * 64)
    assert json.loads((tmp_path / "label-discrimination.json").read_text(encoding="utf-8"))["model_sha256"] == "0" * 64
    assert (tmp_path / "label-discrimination.png").stat().st_size > 5000
    assert "| b | 1 | 0 | 1 | a |" in (tmp_path / "label-discrimination.md").read_text(encoding="utf-8")


@pytest.mark.long(
    because="all labels are rendered from the shipped model for minutes and told apart; the classifier and the order of "
    "levels have tests of their own on short renders"
)
def test_the_shipped_model_s_renders_of_unseen_strokes_are_classified_correctly_and_ordered_by_level(
    tmp_path: Path
) -> None:
    assert ENGINE.is_file(), f"{ENGINE} is missing: build it with `npm run build`"
    materials = load_materials()
    classifier = train_classifier(materials, 10, 1001, lambda count: None, workers=2)
    report = discriminate(
        classifier, materials, engine=ENGINE, model=None, strokes_per_label=3, seed=2002, folder=tmp_path,
        advance=lambda count: None,
    )  # fmt: skip
    assert len(report.outcomes) >= 45
    assert report.render_accuracy >= 0.8
    assert report.level_order_spearman >= 0.8
