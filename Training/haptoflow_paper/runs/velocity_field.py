"""The velocity field, and the model that plays it: a two-level U-Net over patches of the segment, with FiLM at every level.

HaptoFlow (paper, section 3.1): U-Net of two levels; the previous waveform is encoded and concatenated at each
down-sampling stage; material, motion and time modulate every level. The details are ours, chosen for ONNX Runtime on
one CPU core: convolutions over patches of 8 samples, two-dimensional convolutions of height 1, one linear layer for the
FiLM parameters of all blocks, and few nodes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import ClassVar

import torch
from scipy.signal import firwin2
from torch import Tensor, nn

from haptoflow_paper.runs.continuing_comb import COMB_CHANNELS, GAINS, ContinuingComb, spread_gains
from haptoflow_training.models.conditioning import EMBEDDING_SIZE, MotionFeatures
from haptoflow_training.models.haptoflow_model import HaptoFlowModel
from haptoflow_training.models.refiner import PatchUnet
from haptoflow_training.models.rib_comb import RibComb
from haptoflow_training.models.skeleton import ATOMS, NOISE_BEFORE, THRESHOLDS, TailImpulses
from haptoflow_training.waveform import SAMPLE_RATE_HZ

TAPS = 129
_REACH = TAPS // 2
# The skirt that decimation to 2 kHz leaves of a flat spectrum: Hz and dB (preprocessing/signals.py).
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


_CONDITION_SIZE = 96
IMPULSE_GAINS = len(THRESHOLDS) * ATOMS


class MotionEncoder(nn.Module):
    """Motion [B, 3] to 64 values by a multi-layer perceptron."""

    def __init__(self, hidden: int = 128) -> None:
        super().__init__()
        self.features = MotionFeatures()
        self.layers = nn.Sequential(
            nn.Linear(self.features.size, hidden),
            nn.SiLU(),
            nn.Linear(hidden, hidden),
            nn.SiLU(),
            nn.Linear(hidden, EMBEDDING_SIZE),
        )

    def forward(self, motion: Tensor) -> Tensor:
        return self.layers(self.features(motion))


class TimeEncoder(nn.Module):
    """Flow time [B, 1] in [0, 1] to 64 values: sinusoids of geometrically spaced frequency, then two layers."""

    frequencies: Tensor

    def __init__(self) -> None:
        super().__init__()
        half = EMBEDDING_SIZE // 2
        frequencies = torch.exp(torch.linspace(0.0, math.log(100.0), half)).reshape(1, half)
        self.register_buffer("frequencies", frequencies, persistent=False)
        self.layers = nn.Sequential(
            nn.Linear(EMBEDDING_SIZE, EMBEDDING_SIZE), nn.SiLU(), nn.Linear(EMBEDDING_SIZE, EMBEDDING_SIZE)
        )

    def forward(self, time: Tensor) -> Tensor:
        angles = time * self.frequencies
        return self.layers(torch.cat([angles.sin(), angles.cos()], dim=1))


def _silent(outputs: int) -> nn.Linear:
    """A layer whose output, gains of the condition, is zero at the start of training."""
    layer = nn.Linear(_CONDITION_SIZE, outputs)
    nn.init.zeros_(layer.weight)
    nn.init.zeros_(layer.bias)
    return layer


class ContinuousImpulses(TailImpulses):
    """Impulses of a network: gains [B, 52], the same kernel for both tails; the noise [B, 1, N] begins with the
    segment."""

    thresholds: ClassVar[tuple[float, ...]] = THRESHOLDS
    tails: ClassVar[int] = 1

    def forward(self, noise: Tensor, gains: Tensor) -> Tensor:
        return super().forward(nn.functional.pad(noise, (NOISE_BEFORE, 0)), gains)

    def _excess(self, gathered: Tensor) -> Tensor:
        return gathered - torch.maximum(torch.minimum(gathered, self.heights), -self.heights)


class VelocityField(PatchUnet):
    """u(x_t, t | previous, embedding, motion) in unit scale.

    noisy and previous: [B, C, N] with C channels of the representation (1 for raw samples) and N positions (200); time:
    [B, 1], or [1, 1] for all; embedding: [B, 64]; motion: [B, 3]. Returns [B, C, N]. N must be a multiple of `patch`.
    With `ribs` (raw samples only), the rib comb predicts the partials of a ruled surface from the past and from
    phases [B, 6] (label_embedding.py). With `impulses` (raw samples only), rare events come from the tails of the noise.
    levels: 2 for a U-Net whose second level has half the positions; 1 for its first block alone, in less than half the
    time.
    """

    film_factors: Tensor
    line_spread: Tensor

    def __init__(
        self,
        *,
        channels: int = 1,
        positions: int = 200,
        patch: int = 8,
        width: int = 64,
        previous_width: int = 32,
        ribs: bool = False,
        impulses: bool = False,
        levels: int = 2,
    ) -> None:
        super().__init__(
            entering=channels + (COMB_CHANNELS if ribs else 0) + (1 if impulses else 0),
            channels=channels, positions=positions, patch=patch, width=width, previous_width=previous_width,
            levels=levels,
        )  # fmt: skip
        self._encode_time()
        self.motion = MotionEncoder()
        self.comb = ContinuingComb(positions) if ribs else None
        self.impulses = ContinuousImpulses(positions) if impulses else None

        # The material's and the flow time's contributions are added, so that the flow time's part of a one-step graph
        # is a constant.
        # The name `told` is part of checkpoints and exported graphs.
        self.told = nn.Linear(2 * EMBEDDING_SIZE, _CONDITION_SIZE)
        self.moment = nn.Linear(EMBEDDING_SIZE, _CONDITION_SIZE, bias=False)
        self.film = nn.Linear(_CONDITION_SIZE, sum(self.film_sizes))
        factors, starts = self.film_scales()
        self.register_buffer("film_factors", factors, persistent=False)
        with torch.no_grad():
            self.film.bias += starts
        self.line_gains = _silent(GAINS) if ribs else None
        self.register_buffer("line_spread", spread_gains(), persistent=False)
        self.impulse_gains = _silent(IMPULSE_GAINS) if impulses else None

    def forward(
        self,
        noisy: Tensor,
        time: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor | None = None,
    ) -> Tensor:
        return self.velocity(noisy, self.time(time), previous, embedding, motion, phases)

    def _encode_time(self) -> None:
        self.time = TimeEncoder()

    def velocity(
        self,
        noisy: Tensor,
        moment: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor | None,
    ) -> Tensor:
        """`forward`, with the encoded flow time in place of the time: moment [B, 64], or [1, 64] for all."""
        given = torch.cat([embedding, self.motion(motion)], dim=1)
        condition = nn.functional.silu(self._condition(given, moment))
        film, line_gains, impulse_gains = self._modulation(condition)
        mirrored = self._heard(previous)

        entering, added = [noisy], []
        if self.comb is not None:
            if phases is None:
                raise ValueError("a field with ribs needs the phases")
            combed = self.comb(mirrored, phases, line_gains)
            entering.append(combed)
            added.append(combed[:, -1:])
        if self.impulses is not None:
            impulses_made = self.impulses(noisy, impulse_gains)
            entering.append(impulses_made)
            added.append(impulses_made)
        made = self.through(torch.cat(entering, dim=1).unsqueeze(2), mirrored.unsqueeze(2), film)
        for waves in added:
            made = made + waves
        return made

    def _heard(self, previous: Tensor) -> Tensor:
        """The previous waveform with its newest sample first: the segment's first samples must continue it, and a
        convolution sees only what lies at the same place."""
        return previous[:, :, self.newest_first]

    def _modulation(self, condition: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """FiLM parameters, gains of lines and gains of impulses (empty if there are none), by one layer with all
        their weights."""
        # Applied to the weights, which are constants in a graph, rather than to the layer's output.
        factors = self.film_factors
        weights, biases = [self.film.weight * factors.unsqueeze(1)], [self.film.bias * factors]
        sizes = [len(factors)]
        for layer, places in ((self.line_gains, self.line_spread), (self.impulse_gains, None)):
            sizes.append(0)
            if layer is not None:
                weights.append(layer.weight if places is None else layer.weight[places])
                biases.append(layer.bias if places is None else layer.bias[places])
                sizes[-1] = len(biases[-1])
        made = nn.functional.linear(condition, torch.cat(weights), torch.cat(biases))
        if sizes[1:] == [0, 0]:
            return made, made[:, :0], made[:, :0]
        film, *gains = made.split([size for size in sizes if size], dim=1)
        lines, impulses = (gains.pop(0) if size else film[:, :0] for size in sizes[1:])
        return film, lines, impulses

    def _condition(self, given: Tensor, moment: Tensor) -> Tensor:
        """The condition vector. A flow time that is the same for all rows becomes a constant of the layer, which
        saves a node."""
        if moment.shape[0] > 1:
            return self.told(given) + self.moment(moment)
        return nn.functional.linear(given, self.told.weight, self.told.bias + self.moment(moment).squeeze(0))


class FieldModel(HaptoFlowModel):
    """A velocity field from noise to the segment."""

    def __init__(
        self,
        *,
        wave_vectors: Sequence[Sequence[tuple[float, float]]],
        level: nn.Module,
        field: VelocityField,
        specimens: int = 0,
    ) -> None:
        super().__init__(wave_vectors=wave_vectors, level=level, specimens=specimens)
        self.field = field
        self.band_limit = BandLimit()

    @property
    def comb(self) -> RibComb | None:
        return self.field.comb

    @property
    def network(self) -> nn.Module:
        return self.field

    def one_step(self, noise: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        change = self.field(noise, torch.zeros(1, 1), previous, embedding, motion, phases)
        return self.band_limit(previous, noise + change)
