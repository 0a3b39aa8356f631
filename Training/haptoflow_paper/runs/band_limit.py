"""The upper edge of the recordings' band, as a last filter of one-step networks.

Recordings fade towards 1 kHz, in the skirt of their decimation filter; noise does not. A network of patches cannot
cancel the noise it starts from in the last tenth of an octave, but a filter that starts with that skirt and is trained
with the network can.
"""

from __future__ import annotations

import torch
from scipy.signal import firwin2
from torch import Tensor, nn

from haptoflow_training.waveform import SAMPLE_RATE_HZ

TAPS = 129
_REACH = TAPS // 2
# The skirt that decimation to 2 kHz leaves of a flat spectrum: Hz and dB (preprocessing/filters.py).
_SKIRT_HZ = (0.0, 950.0, 970.0, 985.0, 1000.0)
_SKIRT_DB = (0.0, 0.0, -0.8, -2.7, -6.0)

# The convolution is a product of matrices over windows of the segment, in half the time of a convolution in ONNX
# Runtime.
_WINDOWS = 8


class BandLimit(nn.Module):
    """previous and segment [B, 1, 200] to the filtered segment [B, 1, 200].

    On the left the filter reads the newest previous samples; on the right, which is rarely played, the mirrored
    segment.
    """

    mirrored: Tensor
    read: Tensor
    tap: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__()
        gains = [10.0 ** (level / 20.0) for level in _SKIRT_DB]
        taps = torch.tensor(firwin2(TAPS, _SKIRT_HZ, gains, fs=SAMPLE_RATE_HZ), dtype=torch.float32)
        self.weight = nn.Parameter(taps.reshape(1, 1, TAPS))
        # The samples of a window are computed from the window itself and three windows on each side. Of the [16 + 3]
        # windows of past, segment and mirrored segment: those that each window reads, [8, 7]; and the tap that weights
        # each input sample for each output sample, [175, 25], one index beyond the last tap where none applies.
        self.samples, self.made = samples, samples // _WINDOWS
        self.sides = -(-_REACH // self.made)
        mirrored = torch.arange(samples - 1, samples - 1 - self.sides * self.made, -1)
        self.register_buffer("mirrored", mirrored, persistent=False)
        neighbours = torch.arange(-self.sides, self.sides + 1)
        window = torch.arange(_WINDOWS, 2 * _WINDOWS)
        self.register_buffer("read", window.unsqueeze(1) + neighbours, persistent=False)
        places = torch.arange(len(neighbours) * self.made)
        tap = places.unsqueeze(1) - torch.arange(self.made) - (self.sides * self.made - _REACH)
        self.register_buffer("tap", torch.where((tap >= 0) & (tap < TAPS), tap, TAPS), persistent=False)

    def forward(self, previous: Tensor, segment: Tensor) -> Tensor:
        whole = torch.cat([previous, segment, segment[:, :, self.mirrored]], dim=2)
        windows = self._neighbours(whole.reshape(-1, 2 * _WINDOWS + self.sides, self.made))
        taps = nn.functional.pad(self.weight.reshape(TAPS), (0, 1))[self.tap]
        return (windows.reshape(-1, _WINDOWS, len(self.tap)) @ taps).reshape(-1, 1, self.samples)

    def _neighbours(self, windows: Tensor) -> Tensor:
        """[B, 8, 7, 25]: a single node of the graph in place of slices, and a faster gradient."""
        if torch.onnx.is_in_onnx_export():
            return windows[:, self.read]
        first = _WINDOWS - self.sides
        parts = [windows[:, first + shift : first + shift + _WINDOWS] for shift in range(self.read.shape[1])]
        return torch.stack(parts, dim=2)
