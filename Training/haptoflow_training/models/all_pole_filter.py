"""An all-pole filter whose reflection coefficients a network predicts: stable for every prediction."""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_training.waveform import SEGMENT_SAMPLES

# tanh(3.8) = 0.999. In single precision tanh reaches 1, where a filter never decays.
REFLECTION_ARGUMENT_LIMIT = 3.8
# Factor on every pole's radius: the longest response falls to 1/e in 250 ms, a line 1.3 Hz wide.
POLE_DAMPING = 0.998
# Limit of 50 dB between noise and waveform. Filters with reflection coefficients below 1 are stable in theory only:
# with several near 1, rounding the predictor to single precision moves poles out of the unit circle.
LOG_RESONANCE_LIMIT = math.log(10.0 ** (50.0 / 20.0))
LOG_LEVEL_LIMIT = 2.0
# A block is longer than the filter's memory.
_BLOCK_SAMPLES = 25
_BLOCKS = SEGMENT_SAMPLES // _BLOCK_SAMPLES
_DOUBLINGS = (1, 2, 4, 8, 16)


def step_up(reflection: Tensor) -> Tensor:
    """Levinson's step-up: reflection coefficients [B, M] to a_1..a_M [B, M] of A(z) = 1 + sum a_i z^-i.

    All roots of A lie inside the unit circle if every |reflection| < 1.
    """
    coefficients = reflection[:, :1]
    for order in range(1, reflection.shape[1]):
        added = reflection[:, order : order + 1]
        mirrored = torch.flip(coefficients, dims=[1])
        coefficients = torch.cat([coefficients + added * mirrored, added], dim=1)
    return coefficients


def _lags(size: int, offset: int = 0) -> Tensor:
    """[size * size]: row - column + offset of every entry of a square matrix."""
    index = torch.arange(size)
    return (index.unsqueeze(1) - index.unsqueeze(0) + offset).reshape(-1)


class AllPoleFilter(nn.Module):
    """x_t = drive_t - sum a_i x_(t-i): drive [B, 200], coefficients [B, M], the M samples before [B, M], M up to 25.

    Solved exactly, one block at a time: 8 small matrix products replace a loop of 200 steps. The inverse of a block's
    triangular matrix is the impulse response h, computed by doubling: h[n:2n] = -toeplitz(h[:n]) carry h[:n]. This is
    forward substitution in another order, with the same stability.
    """

    def __init__(self, order: int) -> None:
        super().__init__()
        if not 1 <= order <= _BLOCK_SAMPLES:
            raise ValueError(f"order {order}: expected 1 to {_BLOCK_SAMPLES}")
        self.order = order
        for size in _DOUBLINGS:
            self._keep(f"response_{size}", _lags(size), size)
            self._keep(f"carry_{size}", _lags(size, size), order + 1)
        self._keep("response", _lags(_BLOCK_SAMPLES), _BLOCK_SAMPLES)
        self._keep("carry", _lags(_BLOCK_SAMPLES, _BLOCK_SAMPLES), order + 1)

    def _keep(self, name: str, lags: Tensor, known: int) -> None:
        """Indices into [0, values]: 0 for lags that are negative or beyond the known values."""
        inside = (lags >= 0) & (lags < known)
        self.register_buffer(name, torch.where(inside, lags + 1, torch.zeros_like(lags)), persistent=False)

    def _matrix(self, values: Tensor, name: str, size: int) -> Tensor:
        padded = torch.cat([torch.zeros_like(values[:, :1]), values], dim=1)
        return torch.index_select(padded, 1, self.get_buffer(name)).reshape(-1, size, size)

    def forward(self, drive: Tensor, coefficients: Tensor, past: Tensor) -> Tensor:
        one = torch.ones_like(coefficients[:, :1])
        taps = torch.cat([one, coefficients], dim=1)
        response = one
        for size in _DOUBLINGS:
            carried = torch.matmul(self._matrix(taps, f"carry_{size}", size), response.unsqueeze(-1))
            later = torch.matmul(self._matrix(response, f"response_{size}", size), carried).reshape(-1, size)
            response = torch.cat([response, -later], dim=1)
        inverse = self._matrix(response, "response", _BLOCK_SAMPLES)
        carry = torch.matmul(inverse, self._matrix(taps, "carry", _BLOCK_SAMPLES))
        driven = torch.matmul(inverse, drive.reshape(-1, _BLOCKS, _BLOCK_SAMPLES).permute(0, 2, 1))

        block = torch.cat([torch.zeros_like(drive[:, : _BLOCK_SAMPLES - self.order]), past], dim=1).unsqueeze(-1)
        blocks = []
        for index in range(_BLOCKS):
            block = driven[:, :, index : index + 1] - torch.matmul(carry, block)
            blocks.append(block)
        return torch.cat(blocks, dim=1).reshape(-1, SEGMENT_SAMPLES)


def log_cosh(argument: Tensor) -> Tensor:
    size = argument.abs()
    return size + torch.log1p(torch.exp(-2.0 * size)) - math.log(2.0)


def log_level(raw: Tensor) -> Tensor:
    """The log RMS of a waveform in unit scale, limited, of a raw prediction."""
    return LOG_LEVEL_LIMIT * torch.tanh(raw / LOG_LEVEL_LIMIT)


class PredictedFilter(nn.Module):
    """From raw predictions [B, M + 1] to coefficients a_1..a_M [B, M] of A(z) and the log RMS [B, 1] of the noise that
    drives it.

    The last prediction is the RMS of the waveform; that of the noise follows from it, sigma_e^2 = sigma_x^2 prod(1 -
    k_i^2), so that the waveform stays bounded however much the filter resonates. pole_damping: a factor on every pole's
    radius; it multiplies the impulse response's n-th sample by its n-th power, which can only lower the level.
    """

    damping: Tensor

    def __init__(self, order: int, pole_damping: float = POLE_DAMPING) -> None:
        super().__init__()
        self.order = order
        damping = pole_damping ** torch.arange(1.0, order + 1.0).unsqueeze(0)
        self.register_buffer("damping", damping, persistent=False)

    def forward(self, raw: Tensor) -> tuple[Tensor, Tensor]:
        argument = raw[:, : self.order].clamp(-REFLECTION_ARGUMENT_LIMIT, REFLECTION_ARGUMENT_LIMIT)
        # log cosh is convex and 0 at 0, so that a scaled argument gives at most the scaled sum.
        resonance = log_cosh(argument).sum(dim=1, keepdim=True)
        argument = argument * (LOG_RESONANCE_LIMIT / resonance.clamp(min=LOG_RESONANCE_LIMIT))
        # For k = tanh(u), log sqrt(1 - k^2) = -log cosh(u), which avoids the difference of nearly equal numbers.
        log_gain = log_level(raw[:, self.order :]) - log_cosh(argument).sum(dim=1, keepdim=True)
        return step_up(torch.tanh(argument)) * self.damping, log_gain


def prediction_errors(wave: Tensor, coefficients: Tensor) -> Tensor:
    """[B, N]: the one-step prediction errors of wave [B, M + N] under coefficients [B, M]."""
    taps = torch.cat([torch.ones_like(coefficients[:, :1]), coefficients], dim=1)
    # Windows run forwards in time, filter coefficients backwards.
    windows = wave.unfold(1, coefficients.shape[1] + 1, 1)
    return torch.matmul(windows, torch.flip(taps, dims=[1]).unsqueeze(-1)).squeeze(-1)


_SMALL = 1e-9
_MAXIMUM_REFLECTION = 0.999


def burg_reflection(waves: Tensor, order: int) -> Tensor:
    """waves [B, N] to the reflection coefficients [B, order] that minimise the sum of squared forward and backward
    prediction errors, order after order; all within -1 and 1, in the sign of `step_up` (models/all_pole_filter.py)."""
    forward, backward, found = waves, waves, []
    for _ in range(order):
        ahead, behind = forward[:, 1:], backward[:, :-1]
        power = ahead.square().sum(dim=1) + behind.square().sum(dim=1)
        reflection = -2.0 * (ahead * behind).sum(dim=1) / (power + _SMALL)
        found.append(reflection)
        column = reflection.unsqueeze(1)
        forward, backward = ahead + column * behind, behind + column * ahead
    return torch.stack(found, dim=1)


def burg_distance(raw: Tensor, waves: Tensor) -> Tensor:
    """[B]: the squared distance of predictions [B, M + 1] for `PredictedFilter` from Burg's estimates of recorded
    segments [B, N], in the arguments of the reflection coefficients, and of the predicted level from that of unit scale.

    The mean of short estimates is not the best filter, but near it, and there is one way there: a likelihood alone,
    from a random start, often ends with a false peak near the band's end.
    """
    reflection = burg_reflection(waves, raw.shape[1] - 1).clamp(-_MAXIMUM_REFLECTION, _MAXIMUM_REFLECTION)
    wanted = torch.cat([torch.atanh(reflection), torch.zeros_like(raw[:, :1])], dim=1)
    return (raw - wanted).square().sum(dim=1)
