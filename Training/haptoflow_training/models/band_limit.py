"""The edge of the recordings' band, as a last filter of one-step networks.

Recordings end a little below 1 kHz, noise does not. A network of patches cannot cancel the noise it starts from in the
last octave tenth; a filter of 65 samples that is trained with it can.
"""

from __future__ import annotations

import torch
from scipy.signal import firwin
from torch import Tensor, nn

TAPS = 65
_REACH = TAPS // 2
_EDGE_HZ, _SAMPLE_RATE_HZ = 955.0, 2000.0


class BandLimit(nn.Module):
    """previous and segment [B, 1, 200] to the filtered segment [B, 1, 200].

    The past lends its newest samples on the left; on the right, which is rarely played, the segment is mirrored.
    """

    def __init__(self) -> None:
        super().__init__()
        taps = torch.tensor(firwin(TAPS, _EDGE_HZ, fs=_SAMPLE_RATE_HZ), dtype=torch.float32)
        self.weight = nn.Parameter(taps.reshape(1, 1, TAPS))

    def forward(self, previous: Tensor, segment: Tensor) -> Tensor:
        after = torch.flip(segment[:, :, -_REACH:], dims=[2])
        return nn.functional.conv1d(torch.cat([previous[:, :, -_REACH:], segment, after], dim=2), self.weight)
