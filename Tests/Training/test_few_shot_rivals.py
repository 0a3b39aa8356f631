"""The rivals of a learnt material: their level follows the recording, their filters its spectrum."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.few_shot.few_shot_rivals import LabelPrior, fit_autoregressive, fit_level, windows_of
from haptoflow_training.export.level_table import LevelTable
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.recordings.material_recording import MaterialRecording

ROOT = Path(__file__).parents[2]
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
FLAT = LevelTable((0.1,), (0.0,), 1.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def prior() -> LabelPrior:
    return LabelPrior.of(read_model_file(DEFAULT))


def motion_of(speed_mps: np.ndarray, force_newtons: float | np.ndarray = 1.0) -> np.ndarray:
    force = np.broadcast_to(force_newtons, speed_mps.shape)
    return np.stack([speed_mps, np.zeros_like(speed_mps), force], axis=1).astype(np.float32)


def stroke(wave: np.ndarray, motion: np.ndarray) -> MaterialRecording:
    return MaterialRecording("", "", wave.astype(np.float32), motion[:, :2], motion[:, 2], "", "")


def swept(seconds: float, low: float = 0.02, high: float = 0.2, period: float = 2.5) -> np.ndarray:
    time = np.arange(int(2000 * seconds)) / 2000.0
    return np.exp(np.interp(np.sin(2.0 * np.pi * time / period), [-1.0, 1.0], np.log([low, high])))


def levels_db(law: LevelTable, speeds: list[float], force: float = 1.0) -> np.ndarray:
    return 20.0 / math.log(10.0) * law.log_level(speeds, force)


def test_the_level_follows_a_step_that_breaks_any_power_law(prior: LabelPrior) -> None:
    speed = swept(30.0, 0.03, 0.15, period=10.0)
    wanted = lambda v: 20.0 * np.log10(v / 0.05) + 14.0 * np.clip((v - 0.06) / 0.02, 0.0, 1.0)  # noqa: E731
    wave = np.random.default_rng(1).standard_normal(len(speed)) * 10.0 ** (wanted(speed) / 20.0)
    law = fit_level(windows_of([stroke(wave, motion_of(speed))], 200, 100), prior)
    speeds = [0.035, 0.05, 0.09, 0.11, 0.14]
    assert levels_db(law, speeds) == pytest.approx([float(wanted(v)) for v in speeds], abs=2.0)


def test_the_autoregressive_rival_recovers_an_autoregressive_spectrum() -> None:
    rng = np.random.default_rng(12)
    speed = swept(10.0)
    wave = lfilter([1.0], [1.0, -1.6, 0.9], rng.standard_normal(len(speed)))
    wave /= np.sqrt(np.mean(wave**2))
    rival = fit_autoregressive([stroke(wave, motion_of(speed))], FLAT, 3)
    assert len(rival.filters) == 3
    made = rival.render(motion_of(np.full(20000, 0.06)), 1)
    assert np.sqrt(np.mean(made**2)) == pytest.approx(1.0, abs=0.15)
    ratio = 10.0 * np.log10(power_spectrum(made, 256)[3:100] / power_spectrum(wave, 256)[3:100])
    assert np.sqrt(np.mean(ratio**2)) < 1.0
