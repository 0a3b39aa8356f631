"""A simple classifier of materials: averaged spectrum and level, given the speed and force of the stroke."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch

from haptoflow_training.waveform import SAMPLE_RATE_HZ

WINDOW_SECONDS = 1.0
_WINDOW = int(SAMPLE_RATE_HZ * WINDOW_SECONDS)
_BAND_EDGES_HZ = 22.4 * 2.0 ** (np.arange(17) / 3.0)
_MINIMUM_SPEED_MPS = 0.01


@dataclass(frozen=True)
class WindowFeatures:
    """spectra [n, 17]: band levels in dB (m/s^2), third octaves from 22 Hz to 900 Hz, which include the level.
    conditions [n, 6]: 1, log speed, its square, log force, and cosine and sine of twice the direction."""

    spectra: NDArray[np.float64]
    conditions: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.spectra)


def window_features(
    waveform_mps2: NDArray[np.floating], motion: NDArray[np.floating], step_samples: int = _WINDOW // 2
) -> WindowFeatures:
    """Features of every whole second of sliding (mean speed above 10 mm/s, force above 0.05 N), a window every
    `step_samples`.

    waveform_mps2: [n] at 2 kHz. motion: [n, 3] vx, vy (m/s), force (N).
    """
    spectra, conditions = [], []
    for start in range(0, len(waveform_mps2) - _WINDOW + 1, step_samples):
        part = motion[start : start + _WINDOW]
        velocity, force = part[:, :2], part[:, 2].mean()
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        if np.quantile(speed, 0.2) < _MINIMUM_SPEED_MPS or force < 0.05:
            continue
        frequency, power = welch(waveform_mps2[start : start + _WINDOW], SAMPLE_RATE_HZ, nperseg=400)
        bands = np.digitize(frequency, _BAND_EDGES_HZ)
        energy = np.array([power[bands == band].sum() for band in range(1, len(_BAND_EDGES_HZ))])
        spectra.append(10.0 * np.log10(energy * (frequency[1] - frequency[0]) + 1e-8))
        axial = (velocity[:, 0] + 1j * velocity[:, 1]) ** 2 / np.square(speed + 1e-6)
        mean_log_speed = np.log(speed + 0.002).mean()
        conditions.append(
            [1.0, mean_log_speed, mean_log_speed**2, np.log(force), axial.real.mean(), axial.imag.mean()]
        )
    count = len(_BAND_EDGES_HZ) - 1
    return WindowFeatures(np.array(spectra).reshape(-1, count), np.array(conditions).reshape(-1, 6))


def concatenate(parts: list[WindowFeatures]) -> WindowFeatures:
    """The windows of several recordings as one set."""
    return WindowFeatures(
        np.concatenate([part.spectra for part in parts]), np.concatenate([part.conditions for part in parts])
    )


class LabelClassifier:
    """A linear prediction of the spectrum from the condition and a covariance for each label; the most likely label
    wins.

    Gaussian discriminant analysis with the condition as covariate; covariances are drawn a fifth towards their mean.
    (scikit-learn is no dependency of this project.)
    """

    def __init__(self, training: dict[str, WindowFeatures], fewest_windows: int = 30) -> None:
        self.labels = list(training)
        self._coefficients, covariances = [], []
        for label, features in training.items():
            if len(features) < fewest_windows:
                raise ValueError(
                    f"label '{label}' has {len(features)} windows of sliding, expected {fewest_windows} or more"
                )
            coefficients, *_ = np.linalg.lstsq(features.conditions, features.spectra, rcond=None)
            self._coefficients.append(coefficients)
            covariances.append(np.cov((features.spectra - features.conditions @ coefficients).T))
        mean = np.mean(covariances, axis=0)
        shrunk = [0.8 * covariance + 0.2 * mean + 0.1 * np.eye(len(mean)) for covariance in covariances]
        self._precisions = [np.linalg.inv(covariance) for covariance in shrunk]
        self._log_determinants = [np.linalg.slogdet(covariance)[1] for covariance in shrunk]

    def log_likelihood(self, features: WindowFeatures) -> NDArray[np.float64]:
        """[windows, labels], up to a constant."""
        columns = []
        for coefficients, precision, determinant in zip(
            self._coefficients, self._precisions, self._log_determinants, strict=True
        ):
            residual = features.spectra - features.conditions @ coefficients
            columns.append(-0.5 * (np.einsum("ij,jk,ik->i", residual, precision, residual) + determinant))
        return np.stack(columns, axis=1)

    def name(self, features: WindowFeatures) -> str:
        """The label of one stroke: the likelihoods of its windows are averaged, because neighbouring windows
        overlap."""
        return self.labels[int(self.log_likelihood(features).mean(axis=0).argmax())]
