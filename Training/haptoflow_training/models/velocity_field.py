"""The velocity field: a two-level U-Net over patches of the segment, with FiLM at every level.

HaptoFlow (paper, section 3.1): U-Net of two levels; the previous waveform is encoded and concatenated at each
down-sampling stage; material, motion and time modulate every level. The details are ours, chosen for ONNX Runtime on
one CPU core: convolutions over patches of 8 samples, two-dimensional convolutions of height 1, one linear layer for the
FiLM parameters of all blocks, and few nodes.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE, MotionEncoder, TimeEncoder
from haptoflow_training.models.rib_comb import COMB_CHANNELS, GAINS, RibComb, spread_gains
from haptoflow_training.models.rung_impulses import GAINS as IMPULSE_GAINS
from haptoflow_training.models.rung_impulses import RungImpulses

_CONDITION_SIZE = 96


def _unit_length(features: Tensor) -> Tensor:
    """Channels [B, C, 1, P] divided by their length: RMS normalisation up to a factor that the following layer
    absorbs."""
    return features / (features.norm(p=2, dim=1, keepdim=True) + 1e-3)


def _convolution(inputs: int, outputs: int, width: int, stride: int = 1) -> nn.Conv2d:
    return nn.Conv2d(inputs, outputs, (1, width), stride=(1, stride), padding=(0, width // 2))


def _silent(outputs: int) -> nn.Linear:
    """A layer whose output, gains of the condition, is zero at the start of training."""
    layer = nn.Linear(_CONDITION_SIZE, outputs)
    nn.init.zeros_(layer.weight)
    nn.init.zeros_(layer.bias)
    return layer


class PositionMixer(nn.Module):
    """A dense layer across positions, shared within each channel group: the last patch can affect the whole segment.

    A ruled surface keeps its phase over a segment; convolutions of width 3 alone would need many layers for that.
    """

    def __init__(self, channels: int, positions: int) -> None:
        super().__init__()
        self.mix = nn.Linear(positions, positions)
        self.project = _convolution(channels, channels, 1)
        nn.init.zeros_(self.project.weight)
        nn.init.zeros_(self.project.bias)

    def forward(self, features: Tensor) -> Tensor:
        return features + self.project(nn.functional.silu(self.mix(features)))


class FilmBlock(nn.Module):
    """Residual block: norm, FiLM, SiLU, convolution, SiLU, convolution, plus position mixing."""

    def __init__(self, inputs: int, outputs: int, positions: int) -> None:
        super().__init__()
        self.channels = inputs
        self.first = _convolution(inputs, outputs, 3)
        self.second = _convolution(outputs, outputs, 3)
        self.shortcut = _convolution(inputs, outputs, 1) if inputs != outputs else nn.Identity()
        self.mixer = PositionMixer(outputs, positions)

    def forward(self, features: Tensor, scale: Tensor, shift: Tensor) -> Tensor:
        modulated = nn.functional.silu(_unit_length(features) * scale + shift)
        change = self.second(nn.functional.silu(self.first(modulated)))
        return self.mixer(self.shortcut(features) + change)


class VelocityField(nn.Module):
    """u(x_t, t | previous, embedding, motion) in unit scale.

    noisy and previous: [B, C, N] with C channels of the representation (1 for raw samples) and N positions (200); time:
    [B, 1], or [1, 1] for all; embedding: [B, 64]; motion: [B, 3]. Returns [B, C, N]. N must be a multiple of `patch`.
    With `ribs` (raw samples only), the rib comb predicts the partials of a ruled surface from the past and from
    rib_phase [B, 2] in turns. With `impulses` (raw samples only), rare events come from the tails of the noise.
    levels: 2 for a U-Net whose second level has half the positions; 1 for its first block alone, in less than half the
    time.
    """

    film_factors: Tensor
    newest_first: Tensor
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
        super().__init__()
        if levels not in (1, 2):
            raise ValueError(f"levels: 1 or 2, not {levels}")
        self.levels = levels
        if positions % patch != 0:
            raise ValueError(f"{positions} positions do not divide into patches of {patch}")
        self.channels, self.positions, self.patch = channels, positions, patch
        self.patches = positions // patch
        coarse = (self.patches + 1) // 2

        newest_first = torch.arange(positions - 1, -1, -1)
        self.register_buffer("newest_first", newest_first, persistent=False)

        self._encode_time()
        self.motion = MotionEncoder()
        self.comb = RibComb(positions) if ribs else None
        self.impulses = RungImpulses(positions) if impulses else None
        entering = channels + (COMB_CHANNELS if ribs else 0) + (1 if impulses else 0)
        self.enter = nn.Conv2d(entering, width, (1, patch), stride=(1, patch))
        self.previous_fine = nn.Conv2d(
            channels, previous_width, (1, 3 * patch), stride=(1, patch), padding=(0, patch)
        )
        self.fine_down = FilmBlock(width + previous_width, width, self.patches)
        blocks = [self.fine_down]
        if levels == 2:
            self.previous_coarse = _convolution(previous_width, previous_width, 3, stride=2)
            self.down = _convolution(width, 2 * width, 3, stride=2)
            self.coarse = FilmBlock(2 * width + previous_width, 2 * width, coarse)
            self.up = nn.ConvTranspose2d(
                2 * width, width, (1, 3), stride=(1, 2), padding=(0, 1), output_padding=(0, 1 - self.patches % 2)
            )
            self.fine_up = FilmBlock(2 * width, width, self.patches)
            blocks += [self.coarse, self.fine_up]
        self.leave = nn.ConvTranspose2d(width, channels, (1, patch), stride=(1, patch))
        nn.init.zeros_(self.leave.weight)
        nn.init.zeros_(self.leave.bias)

        self._film_sizes = [size for block in blocks for size in (block.channels, block.channels)]
        # The material's and the flow time's contributions are added, so that the flow time's part of a one-step graph
        # is a constant.
        # The name `told` is part of checkpoints and exported graphs.
        self.told = nn.Linear(2 * EMBEDDING_SIZE, _CONDITION_SIZE)
        self.moment = nn.Linear(EMBEDDING_SIZE, _CONDITION_SIZE, bias=False)
        self.film = nn.Linear(_CONDITION_SIZE, sum(self._film_sizes))
        factors = [part for block in blocks for part in (block.channels**0.5, 1.0)]
        repeats = torch.tensor(self._film_sizes)
        self.register_buffer("film_factors", torch.tensor(factors).repeat_interleave(repeats), persistent=False)
        with torch.no_grad():
            self.film.bias += torch.tensor([1.0, 0.0] * len(blocks)).repeat_interleave(repeats)
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
        rib_phase: Tensor | None = None,
    ) -> Tensor:
        return self.velocity(noisy, self.time(time), previous, embedding, motion, rib_phase)

    def _encode_time(self) -> None:
        self.time = TimeEncoder()

    def velocity(
        self,
        noisy: Tensor,
        moment: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        rib_phase: Tensor | None,
    ) -> Tensor:
        """`forward`, with the encoded flow time in place of the time: moment [B, 64], or [1, 64] for all."""
        given = torch.cat([embedding, self.motion(motion)], dim=1)
        condition = nn.functional.silu(self._condition(given, moment))
        film, line_gains, impulse_gains = self._modulation(condition)
        film_parts = film.reshape(-1, sum(self._film_sizes), 1, 1).split(self._film_sizes, dim=1)

        mirrored = self._heard(previous)
        past = self.previous_fine(mirrored.unsqueeze(2))

        entering, added = [noisy], []
        if self.comb is not None:
            if rib_phase is None:
                raise ValueError("a field with ribs needs the rib phase")
            combed = self.comb(mirrored, embedding, motion, rib_phase, line_gains)
            entering.append(combed)
            added.append(combed[:, -1:])
        if self.impulses is not None:
            struck = self.impulses(noisy, impulse_gains)
            entering.append(struck)
            added.append(struck)
        entered = self.enter(torch.cat(entering, dim=1).unsqueeze(2))
        fine = self.fine_down(torch.cat([entered, past], dim=1), film_parts[0], film_parts[1])
        if self.levels == 2:
            past_coarse = self.previous_coarse(nn.functional.silu(past))
            coarse = self.coarse(torch.cat([self.down(fine), past_coarse], dim=1), film_parts[2], film_parts[3])
            fine = self.fine_up(torch.cat([self.up(coarse), fine], dim=1), film_parts[4], film_parts[5])
        made = self._leave(fine)
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

    def _leave(self, features: Tensor) -> Tensor:
        """The transposed convolution `leave`, [B, C, N]: since patches do not overlap, one linear layer for each
        place in a patch followed by a transposition, in half the time of ONNX Runtime's transposed convolution."""
        width, channels, patch = len(self.leave.weight), self.channels, self.patch
        weight = self.leave.weight.reshape(width, channels * patch).t().reshape(channels * patch, width, 1, 1)
        samples = nn.functional.conv2d(features, weight, self.leave.bias.repeat_interleave(patch))
        return samples.reshape(-1, channels, patch, self.patches).transpose(2, 3).reshape(-1, channels, self.positions)


def parameter_count(module: nn.Module) -> int:
    """Weights of a module, buffers not counted."""
    return sum(parameter.numel() for parameter in module.parameters())
