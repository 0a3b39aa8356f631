"""The distance between a decoded segment and the original, in time and in spectra of several resolutions."""

from __future__ import annotations

import torch
from torch import Tensor

_WINDOWS = (16, 32, 64, 128, 200)
_POWER_FLOOR = 1e-4


def _magnitudes(waveform: Tensor, window: int) -> Tensor:
    spectrum = torch.stft(
        waveform.squeeze(1),
        n_fft=window,
        hop_length=max(4, window // 4),
        window=torch.hann_window(window, device=waveform.device),
        center=False,
        return_complex=True,
    )
    # Scaled so that white noise of unit variance has unit power at every resolution.
    return torch.sqrt(spectrum.abs().square() / (0.375 * window) + _POWER_FLOOR)


def time_loss(decoded: Tensor, original: Tensor) -> Tensor:
    """Batch mean of the RMS of the difference, both [B, 1, N]. Not squared, so that good segments still count."""
    return (decoded - original).square().mean(dim=(1, 2)).add(1e-8).sqrt().mean()


def spectral_loss(decoded: Tensor, original: Tensor) -> Tensor:
    """Mean |log magnitude ratio| over Hann windows of 16 to 200 samples, power floor 1e-4; N >= 200."""
    distances = []
    for window in _WINDOWS:
        ratio = _magnitudes(decoded, window) / _magnitudes(original, window)
        distances.append(ratio.log().abs().mean())
    return torch.stack(distances).mean()


@torch.no_grad()
def signal_to_noise_ratio_db(decoded: Tensor, original: Tensor) -> float:
    """10 log10 of the original's power over the error's, over all of [B, 1, N]; infinite without error."""
    signal = original.double().square().sum()
    noise = (decoded.double() - original.double()).square().sum()
    return float(10.0 * torch.log10(signal / noise))
