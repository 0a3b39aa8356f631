"""The condition inputs of the networks: material and motion."""

from __future__ import annotations

import math
from collections.abc import Sequence

import torch
from torch import Tensor, nn

EMBEDDING_SIZE = 64

REFERENCE_SPEED_MPS = 0.06
REST_SPEED_MPS = 0.0005
REST_FORCE_NEWTONS = 0.02

# Octaves of log speed covered by sine and cosine features: a ruled surface's fundamental is speed over wavelength, so
# the network must resolve speeds that differ by 1 %.
FINE_LOG_SPEED_HARMONICS = (0.5, 1.0, 2.0, 4.0, 8.0)
# A level changes slowly with speed; finer features would only fit the speeds that happen to be recorded.
SMOOTH_LOG_SPEED_HARMONICS = (0.5, 1.0)


def speed_and_force(motion: Tensor) -> Tensor:
    """Speed in m/s and force in N, [B, 2], of motion [B, 3] (vx, vy in m/s, force in N)."""
    return torch.cat([motion[:, 0:2].norm(p=2, dim=1, keepdim=True), motion[:, 2:3]], dim=1)


class LogSpeedAndForce(nn.Module):
    """log((speed + 0.5 mm/s) / 60 mm/s) and log(force + 0.02 N), [B, 2], of speed and force [B, 2].

    Negative forces count as zero.
    """

    rest: Tensor
    unit: Tensor

    def __init__(self) -> None:
        super().__init__()
        self.register_buffer("rest", torch.tensor([[REST_SPEED_MPS, REST_FORCE_NEWTONS]]), persistent=False)
        self.register_buffer("unit", torch.tensor([[REFERENCE_SPEED_MPS, 1.0]]), persistent=False)

    def forward(self, speed_force: Tensor) -> Tensor:
        return ((speed_force.clamp(min=0.0) + self.rest) / self.unit).log()


class MotionFeatures(nn.Module):
    """Physical motion [B, 3] to well-scaled features; the normalisation is part of the exported graph.

    Written with matrices in place of slices and sums, because every node of a graph costs time.
    """

    harmonics: Tensor
    phases: Tensor
    sums: Tensor
    differences: Tensor
    scale: Tensor

    def __init__(self, log_speed_harmonics: tuple[float, ...] = FINE_LOG_SPEED_HARMONICS) -> None:
        super().__init__()
        self.size = 2 + 4 + 2 * len(log_speed_harmonics) + 2
        self.logarithms = LogSpeedAndForce()
        # Sine and cosine of each harmonic of log speed; a cosine is a sine a quarter turn ahead.
        harmonics = torch.tensor(log_speed_harmonics).repeat_interleave(2)
        self.register_buffer("harmonics", torch.stack([harmonics, 0.0 * harmonics]), persistent=False)
        phases = torch.tensor([0.0, math.pi / 2.0] * len(log_speed_harmonics)).unsqueeze(0)
        self.register_buffer("phases", phases, persistent=False)
        # Cosine and sine of twice an angle: x^2 - y^2 = (x + y) (x - y), and 2 x y.
        self.register_buffer("sums", torch.tensor([[1.0, 2.0], [1.0, 0.0]]), persistent=False)
        self.register_buffer("differences", torch.tensor([[1.0, 0.0], [-1.0, 1.0]]), persistent=False)
        self.register_buffer("scale", torch.tensor([[1.0, 0.2]]), persistent=False)

    def forward(self, motion: Tensor) -> Tensor:
        velocity = motion[:, 0:2]
        speed = velocity.norm(p=2, dim=1, keepdim=True)
        speed_force = torch.cat([speed, motion[:, 2:3]], dim=1)
        logarithms = self.logarithms(speed_force)
        direction = velocity / (speed + 0.002)
        # Most surfaces vibrate alike in both directions along their grain.
        axial = (direction @ self.sums) * (direction @ self.differences)
        waves = torch.sin(logarithms @ self.harmonics + self.phases)
        return torch.cat([logarithms * 0.5, direction, axial, waves, speed_force * self.scale], dim=1)


class MaskedLinear(nn.Linear):
    """A linear layer that has only the weights where `mask` [outputs, inputs] is 1; all others are and stay zero."""

    mask: Tensor

    def __init__(self, mask: Tensor) -> None:
        outputs, inputs = mask.shape
        super().__init__(inputs, outputs)
        self.register_buffer("mask", mask, persistent=False)
        with torch.no_grad():
            # An output begins as one of a layer that has no other inputs.
            self.weight *= mask * (inputs / mask.sum(dim=1, keepdim=True)).sqrt()
            self.bias *= (inputs / mask.sum(dim=1)).sqrt()

    def forward(self, values: Tensor) -> Tensor:
        return nn.functional.linear(values, self.weight * self.mask, self.bias)


class ConditionPerceptron(nn.Module):
    """Embedding [B, 64] and motion features, and `further` numbers [B, F] if any, through two hidden layers to
    [B, outputs].

    hidden: the width of both layers. Several widths are several perceptrons side by side, which share nothing;
    `reads` [outputs, perceptrons] says which of them each output is of.
    """

    def __init__(
        self, outputs: int, hidden: int | Sequence[int] = 256, further: int = 0, reads: Tensor | None = None
    ) -> None:
        super().__init__()
        self.features = MotionFeatures()
        widths = (hidden,) if isinstance(hidden, int) else tuple(hidden)
        sums = torch.block_diag(*(torch.ones(1, width) for width in widths))
        reads = torch.ones(outputs, len(widths)) if reads is None else reads
        self.layers = nn.Sequential(
            nn.Linear(EMBEDDING_SIZE + self.features.size + further, sum(widths)),
            nn.SiLU(),
            MaskedLinear(sums.t() @ sums),
            nn.SiLU(),
            MaskedLinear(reads @ sums),
        )

    def hidden(self, embedding: Tensor, motion: Tensor, further: Tensor | None = None) -> Tensor:
        """What the last layer sees, [B, hidden]."""
        given = [embedding, self.features(motion)] + ([] if further is None else [further])
        return self.layers[:-1](torch.cat(given, dim=1))

    def forward(self, embedding: Tensor, motion: Tensor, further: Tensor | None = None) -> Tensor:
        return self.layers[-1](self.hidden(embedding, motion, further))
