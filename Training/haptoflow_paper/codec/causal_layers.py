"""Causal layers of EnCodec (Defossez et al. 2022): padded convolutions, residual block, LSTM with skip.

The nesting of modules (`conv.conv`, `convtr.convtr`, `block`, `shortcut`, `lstm`) is that of the published
checkpoint.
"""

from __future__ import annotations

from torch import Tensor, nn
from torch.nn.utils import remove_weight_norm, weight_norm


class CausalConvolution(nn.Module):
    """Convolution of [B, C, N] to [B, D, ceil(N / stride)] that reads no sample after its own stride.

    All padding is on the left, mirrored, except what the last stride needs to be full. Because of the mirroring, the
    first outputs depend on up to `kernel - stride` later samples; N must exceed that number, or ValueError is raised.
    """

    def __init__(self, inputs: int, outputs: int, kernel: int, stride: int = 1) -> None:
        super().__init__()
        self.stride = stride
        self.left = kernel - stride
        self.conv = nn.ModuleDict({"conv": weight_norm(nn.Conv1d(inputs, outputs, kernel, stride=stride))})

    def forward(self, signal: Tensor) -> Tensor:
        length = int(signal.shape[-1])
        if length <= self.left:
            raise ValueError(f"{length} positions are too few to mirror {self.left} of them; expected more")
        padded = nn.functional.pad(signal, (self.left, -length % self.stride), mode="reflect")
        return self.conv["conv"](padded)


class CausalTransposedConvolution(nn.Module):
    """Transposed convolution of [B, C, N] to [B, D, N stride], kernel twice the stride, cut on the right."""

    def __init__(self, inputs: int, outputs: int, stride: int) -> None:
        super().__init__()
        self.stride = stride
        layer = nn.ConvTranspose1d(inputs, outputs, 2 * stride, stride=stride)
        self.convtr = nn.ModuleDict({"convtr": weight_norm(layer)})

    def forward(self, signal: Tensor) -> Tensor:
        return self.convtr["convtr"](signal)[..., : -self.stride]


class CausalResidualBlock(nn.Module):
    """Bottleneck of half the channels (kernel 3, then 1) beside a shortcut of kernel 1; keeps [B, C, N]."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.block = nn.Sequential(
            nn.ELU(),
            CausalConvolution(channels, channels // 2, 3),
            nn.ELU(),
            CausalConvolution(channels // 2, channels, 1),
        )
        self.shortcut = CausalConvolution(channels, channels, 1)

    def forward(self, signal: Tensor) -> Tensor:
        return self.shortcut(signal) + self.block(signal)


class ResidualLstm(nn.Module):
    """Two LSTM layers over positions, added to their input; keeps [B, C, N]."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.lstm = nn.LSTM(channels, channels, num_layers=2)

    def forward(self, signal: Tensor) -> Tensor:
        sequence = signal.permute(2, 0, 1)
        recalled, _ = self.lstm(sequence)
        return (recalled + sequence).permute(1, 2, 0)


def fold_weight_norm(module: nn.Module) -> None:
    """Replace every weight-normalised layer by a plain one with the same output, in place; not for training.

    Weights are then computed once instead of in every call; the state dict loses its published names.
    """
    for layer in module.modules():
        if hasattr(layer, "weight_g"):
            remove_weight_norm(layer)
