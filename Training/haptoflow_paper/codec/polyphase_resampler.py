"""Resamples between 2 kHz and a whole multiple of it by one fixed FIR filter, in operations that ONNX graphs have.

SciPy's resample_poly cannot be exported to a graph.
"""

from __future__ import annotations

import torch
from scipy.signal import firwin
from torch import Tensor, nn

# 63 dB stop band; with 16 samples a side the pass band reaches 880 of 1,000 Hz.
_KAISER_BETA = 6.0
_HALF_WIDTH = 16


def _continued(waveform: Tensor, reach: int) -> Tensor:
    """Extended by point reflection about its ends, so that value and slope are continuous; [B, 1, N] to [B, 1, N + 2
    reach].

    A plain mirror image has a kink: band noise of 20-450 Hz was reconstructed with 42 dB instead of 58 dB.
    """
    before = 2.0 * waveform[..., :1] - waveform[..., 1 : reach + 1].flip(-1)
    after = 2.0 * waveform[..., -1:] - waveform[..., -reach - 1 : -1].flip(-1)
    return torch.cat([before, waveform, after], dim=-1)


class PolyphaseResampler(nn.Module):
    """Windowed sinc with its corner at the lower rate's Nyquist frequency, 16 lower-rate samples a side.

    Sample i of the lower rate is sample i * factor of the higher one: no delay. The lower-rate length must
    exceed 16.
    """

    taps: Tensor

    def __init__(self, factor: int) -> None:
        super().__init__()
        self.factor = factor
        taps = firwin(2 * _HALF_WIDTH * factor + 1, 1.0 / factor, window=("kaiser", _KAISER_BETA))
        kernel = torch.tensor(taps, dtype=torch.float32).reshape(1, 1, -1)
        self.register_buffer("taps", kernel, persistent=False)

    def upsample(self, waveform: Tensor) -> Tensor:
        """[B, 1, N] to [B, 1, N factor]; the samples themselves are kept to within 2e-4."""
        return nn.functional.conv_transpose1d(
            _continued(waveform, _HALF_WIDTH),
            self.taps * self.factor,
            stride=self.factor,
            padding=2 * _HALF_WIDTH * self.factor,
            output_padding=self.factor - 1,
        )

    def downsample(self, waveform: Tensor) -> Tensor:
        """[B, 1, N factor] to [B, 1, N], what lies above the lower rate's Nyquist frequency removed."""
        return nn.functional.conv1d(
            _continued(waveform, _HALF_WIDTH * self.factor), self.taps, stride=self.factor
        )
