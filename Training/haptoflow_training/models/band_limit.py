"""The edge of the recordings' band, as a last filter of one-step networks.

Recordings fade towards 1 kHz, in the skirt of their decimation; noise does not. A network of patches cannot
cancel the noise it starts from in the last tenth of an octave; a filter that begins with that skirt and is trained with
the network can.
"""

from __future__ import annotations

import torch
from scipy.signal import firwin2
from torch import Tensor, nn

TAPS = 129
_REACH = TAPS // 2
_SAMPLE_RATE_HZ = 2000.0
# What the step down to 2 kHz leaves of a flat spectrum: Hz and dB (preprocessing/filters.py).
_SKIRT_HZ = (0.0, 950.0, 970.0, 985.0, 1000.0)
_SKIRT_DB = (0.0, 0.0, -0.8, -2.7, -6.0)


class BandLimit(nn.Module):
    """previous and segment [B, 1, 200] to the filtered segment [B, 1, 200].

    The past lends its newest samples on the left; on the right, which is rarely played, the segment is mirrored.
    """

    def __init__(self) -> None:
        super().__init__()
        gains = [10.0 ** (level / 20.0) for level in _SKIRT_DB]
        taps = torch.tensor(firwin2(TAPS, _SKIRT_HZ, gains, fs=_SAMPLE_RATE_HZ), dtype=torch.float32)
        self.weight = nn.Parameter(taps.reshape(1, 1, TAPS))

    def forward(self, previous: Tensor, segment: Tensor) -> Tensor:
        after = torch.flip(segment[:, :, -_REACH:], dims=[2])
        return nn.functional.conv1d(torch.cat([previous[:, :, -_REACH:], segment, after], dim=2), self.weight)
