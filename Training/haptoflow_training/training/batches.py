"""Training pairs drawn from the store: previous waveform, segment, condition."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.training.config import BatchConfig
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

# Below this speed the tip counts as resting: its direction would be sensor noise.
_MINIMUM_MOVING_SPEED_MPS = 0.002


@dataclass(frozen=True)
class HeldOut:
    """Bands [from, to), empty for none. direction_degrees: counter-clockwise from the surface's first axis, as the
    velocity (vx, vy) itself; `from` may be negative for a band around 0. A resting tip has no direction."""

    speed_mps: tuple[float, ...] = ()
    force_newtons: tuple[float, ...] = ()
    direction_degrees: tuple[float, ...] = ()

    @classmethod
    def of(cls, config: BatchConfig) -> HeldOut:
        return cls(config.held_out_speed_mps, config.held_out_force_newtons, config.held_out_direction_degrees)

    def holds(self, motion: NDArray[np.floating]) -> NDArray[np.bool_]:
        """Which motions [..., 3] (vx, vy in m/s, force in N) lie in a band."""
        speed = np.hypot(motion[..., 0], motion[..., 1])
        held = np.zeros(speed.shape, dtype=np.bool_)
        for values, band in ((speed, self.speed_mps), (motion[..., 2], self.force_newtons)):
            if band:
                held |= (values >= band[0]) & (values < band[1])
        if self.direction_degrees:
            low, high = self.direction_degrees
            direction = np.degrees(np.arctan2(motion[..., 1], motion[..., 0]))
            held |= (np.mod(direction - low, 360.0) < high - low) & (speed >= _MINIMUM_MOVING_SPEED_MPS)
        return held


@dataclass(frozen=True)
class ClearSpans:
    """Stretches of recordings outside all bands: their starts in the store, their lengths, and the indices of their
    recordings in the given list (ascending)."""

    starts: NDArray[np.int64]
    lengths: NDArray[np.int64]
    owners: NDArray[np.int64]


def clear_spans(
    motion: NDArray[np.float32], starts: NDArray[np.int64], lengths: NDArray[np.int64], held_out: HeldOut
) -> ClearSpans:
    """The clear spans of recordings that begin at `starts` in the store's motion [n, 3] and are `lengths` long."""
    found: list[tuple[NDArray[np.int64], NDArray[np.int64]]] = []
    for start, length in zip(starts, lengths, strict=True):
        held = held_out.holds(motion[start : start + length])
        edges = np.flatnonzero(np.diff(np.concatenate([[True], held, [True]]).astype(np.int8)))
        found.append((start + edges[::2], edges[1::2] - edges[::2]))
    owners = np.repeat(np.arange(len(found)), [len(begin) for begin, _ in found])
    nothing = np.zeros(0, dtype=np.int64)
    return ClearSpans(
        np.concatenate([begin for begin, _ in found] or [nothing]).astype(np.int64),
        np.concatenate([long for _, long in found] or [nothing]).astype(np.int64),
        owners.astype(np.int64),
    )


LEVEL_WINDOW_SAMPLES = 100
# The column of the store's wander that holds the phase of stick-slip.
SLIP = 2
# Where inside a segment its motion is stored for the level: every 10 ms, both ends included.
_KNOTS = np.linspace(0, SEGMENT_SAMPLES - 1, 11).round().astype(np.int64)
# The first of them, which span the level's window.
LEVEL_WINDOW_KNOTS = int(np.count_nonzero(_KNOTS <= LEVEL_WINDOW_SAMPLES))


@dataclass(frozen=True)
class Chain:
    """The motion before a batch's previous waveform, over which the network renders its own past.

    start [B, 1, 200]: the waveform before the first hop, m/s^2. motion [B, K, 3]: the condition of each hop.
    position_mm [B, K, 2] and wander [B, K, 6]: where each hop begins. hop_samples: samples that each hop appends.
    """

    start: Tensor
    motion: Tensor
    position_mm: Tensor
    wander: Tensor
    hop_samples: int


@dataclass(frozen=True)
class SegmentBatch:
    """waveforms in m/s^2: previous [B, 1, 200], segment [B, 1, 200]; label [B]; specimen [B], -1 where none is known;
    motion [B, 3]: the condition.

    position_mm [B, 2]: where the segment begins. wander [B, 6]: by how much the surface's waves are displaced from that
    place, and how fast (models/label_embedding.py, `surface_phases`). position_path_mm [B, 201, 2] and wander_path [B,
    201, 3]: place and displacement at every sample of the segment and at its end. motion_path [B, 11, 3]: the motion at
    evenly spaced samples of the segment, its ends included.
    level_motion [B, 3] and level_mean_square_mps2 [B, 1]: a 50 ms window for the level model.
    """

    previous: Tensor
    segment: Tensor
    label: Tensor
    specimen: Tensor
    motion: Tensor
    position_mm: Tensor
    wander: Tensor
    position_path_mm: Tensor
    wander_path: Tensor
    motion_path: Tensor
    level_motion: Tensor
    level_mean_square_mps2: Tensor
    chain: Chain | None = None


class SegmentBatches:
    """Draws batches: labels uniformly except for the emphasised ones, protocols by share, recordings uniformly,
    positions uniformly.

    Only windows that lie, with their chains, inside one recording of `split` and outside the held-out bands are drawn.
    Nothing leaks between splits, and held-out motion is never seen.
    """

    def __init__(self, store: SegmentStore, split: str, config: BatchConfig, seed: int) -> None:
        self._store = store
        self._config = config
        self._generator = np.random.default_rng(seed)
        long_enough = [
            recording
            for recording in store.recordings
            if recording.split == split and recording.length >= 2 * SEGMENT_SAMPLES + 1
        ]
        if not long_enough:
            raise ValueError(f"no recording of split '{split}' is longer than two segments")
        self._starts = np.array([recording.start for recording in long_enough], dtype=np.int64)
        self._lengths = np.array([recording.length for recording in long_enough], dtype=np.int64)
        self._labels = np.array([recording.label_index for recording in long_enough], dtype=np.int64)
        specimens = [-1 if recording.specimen is None else recording.specimen for recording in long_enough]
        self._specimens = np.array(specimens, dtype=np.int64)
        self._slips = bool(store.wander_turns[:, SLIP].any())
        machine = np.array([recording.protocol == "machine" for recording in long_enough])
        self._spans = clear_spans(store.motion, self._starts, self._lengths, HeldOut.of(config))
        self._groups = [
            tuple(np.flatnonzero((self._labels == label) & chosen) for chosen in (machine, ~machine))
            for label in range(len(store.labels))
        ]
        usable = self._room(2 * SEGMENT_SAMPLES)[1] > 0
        if not usable.any():
            raise ValueError(f"no recording of split '{split}' has two segments outside the held-out bands")
        self._present = np.array(
            [label for label, groups in enumerate(self._groups) if any(usable[group].any() for group in groups)]
        )
        self._shares = self._label_shares()

    def _label_shares(self) -> NDArray[np.float64]:
        emphasised = self._config.emphasised_labels
        for name in emphasised:
            if name not in self._store.labels:
                raise InputError(f"batch.emphasised_labels: no recording is of '{name}'")
        names = [self._store.labels[label] for label in self._present]
        weights = np.array([self._config.emphasis if name in emphasised else 1.0 for name in names])
        return weights / weights.sum()

    def _room(self, samples: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The number of places where a window of so many samples fits: in each clear span, and in each recording."""
        by_span = np.maximum(self._spans.lengths - samples, 0)
        by_recording = np.bincount(self._spans.owners, by_span, len(self._starts)).astype(np.int64)
        return by_span, by_recording

    def _draw_recordings(self, count: int, usable: NDArray[np.bool_] | None = None) -> NDArray[np.int64]:
        """usable: recordings with room for the window. A label without any is not drawn."""
        groups = self._groups
        present, shares = self._present, self._shares
        if usable is not None:
            groups = [tuple(group[usable[group]] for group in pair) for pair in groups]
            kept = np.array([any(map(len, groups[label])) for label in present])
            present, shares = present[kept], shares[kept] / shares[kept].sum()
        labels = self._generator.choice(present, size=count, p=shares)
        from_machine = self._generator.random(count) < self._config.machine_share
        position = self._generator.random(count)
        chosen = np.empty(count, dtype=np.int64)
        for row, label in enumerate(labels):
            machine, hand = groups[label]
            group = machine if (from_machine[row] and len(machine)) or not len(hand) else hand
            chosen[row] = group[int(position[row] * len(group))]
        return chosen

    def _draw_split_points(self, count: int, lead_in: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """(recordings, points where previous waveform and segment meet): from `lead_in` samples plus a segment
        before the point to a segment after it, everything lies in one recording and outside the held-out bands."""
        before = lead_in + SEGMENT_SAMPLES
        by_span, by_recording = self._room(before + SEGMENT_SAMPLES)
        recordings = self._draw_recordings(count, by_recording > 0)
        # All places of all spans in one array, those of a recording side by side.
        ends = np.cumsum(by_span)
        first = (np.cumsum(by_recording) - by_recording)[recordings]
        place = first + (self._generator.random(count) * by_recording[recordings]).astype(np.int64)
        span = np.searchsorted(ends, place, side="right")
        return recordings, self._spans.starts[span] + before + place - (ends - by_span)[span]

    def draw_chains(self, count: int) -> SegmentBatch:
        """A new batch whose previous waveforms can be replaced by what the network renders over several hops.

        The hop is that of a live update rate, 30 to 120 Hz, the same for the whole batch; chains begin in silence with
        `chain_silence_probability`, as at touch-down.
        """
        config, generator = self._config, self._generator
        hop = int(generator.integers(config.hop_samples[0], config.hop_samples[1] + 1))
        longest = (self._longest_common_span() - 2 * SEGMENT_SAMPLES - 1) // hop
        hops = min(int(generator.integers(config.chain_hops[0], config.chain_hops[1] + 1)), longest)
        lead_in = hops * hop
        recordings, split_point = self._draw_split_points(count, lead_in)
        batch = self._pairs(recordings, split_point, np.full(count, hop))
        windows = split_point[:, None] + np.arange(-lead_in - SEGMENT_SAMPLES, 0)[None, :]
        start = self._store.waveform[windows[:, :SEGMENT_SAMPLES]] * np.float32(self._store.peak_mps2)
        start[generator.random(count) < config.chain_silence_probability] = 0.0
        motion = self._store.motion[windows[:, SEGMENT_SAMPLES:]].reshape(count, hops, hop, 3).mean(axis=2)
        begins = windows[:, SEGMENT_SAMPLES::hop][:, :hops]
        chain = Chain(
            start=torch.from_numpy(start).unsqueeze(1),
            motion=torch.from_numpy(motion.astype(np.float32)),
            position_mm=torch.from_numpy(self._store.position_mm[begins]),
            wander=torch.from_numpy(self._wander(begins, np.full(begins.shape, hop))),
            hop_samples=hop,
        )
        return dataclasses.replace(batch, chain=chain)

    def _wander(self, begins: NDArray[np.int64], hops: NDArray[np.int64]) -> NDArray[np.float32]:
        """[..., 6] at the samples `begins`: the surface's wander in turns, and its mean rate over the hop in Hz."""
        turns = self._store.wander_turns
        change = turns[begins + hops].astype(np.float64) - turns[begins]
        # A hop may pass hundreds of slips; their phase is wrapped, so that only sums of single steps are unambiguous.
        slips = turns[..., SLIP]
        if self._slips:
            longest = int(hops.max())
            within = np.arange(longest) < hops[..., None]
            steps = begins[..., None] + np.where(within, np.arange(longest), 0)
            moved = slips[steps + 1] - slips[steps]
            change[..., SLIP] = ((moved - np.rint(moved)) * within).sum(axis=-1)
        rates = change * (SAMPLE_RATE_HZ / hops[..., None])
        return np.concatenate([turns[begins], rates], axis=-1).astype(np.float32)

    def _longest_common_span(self) -> int:
        """The number of consecutive samples that every label has in at least one span."""
        labels = self._labels[self._spans.owners]
        return int(min(self._spans.lengths[labels == label].max() for label in self._present))

    def draw(self, count: int) -> SegmentBatch:
        """A new batch of `count` pairs."""
        config, generator = self._config, self._generator
        recordings, split_point = self._draw_split_points(count, 0)
        hop = generator.integers(config.hop_samples[0], config.hop_samples[1] + 1, size=count)
        return self._pairs(recordings, split_point, hop)

    def _pairs(
        self, recordings: NDArray[np.int64], split_point: NDArray[np.int64], hop: NDArray[np.int64]
    ) -> SegmentBatch:
        config, generator, count = self._config, self._generator, len(recordings)
        offsets = np.arange(-SEGMENT_SAMPLES, SEGMENT_SAMPLES)
        windows = split_point[:, None] + offsets[None, :]
        waves = self._store.waveform[windows] * np.float32(self._store.peak_mps2)
        motions = self._store.motion[windows[:, SEGMENT_SAMPLES:]]

        inside = np.arange(SEGMENT_SAMPLES)[None, :] < hop[:, None]
        motion = (motions * inside[:, :, None]).sum(axis=1) / hop[:, None]

        path = split_point[:, None] + np.arange(SEGMENT_SAMPLES + 1)[None, :]
        previous = waves[:, :SEGMENT_SAMPLES].copy()
        switched = np.flatnonzero(generator.random(count) < config.switch_probability)
        if len(switched):
            previous[switched] = previous[generator.permutation(count)[: len(switched)]]
        previous[generator.random(count) < config.silence_probability] = 0.0

        level_motion = motions[:, :LEVEL_WINDOW_SAMPLES].mean(axis=1)
        level_wave = waves[:, SEGMENT_SAMPLES : SEGMENT_SAMPLES + LEVEL_WINDOW_SAMPLES]
        return SegmentBatch(
            previous=torch.from_numpy(previous).unsqueeze(1),
            segment=torch.from_numpy(waves[:, SEGMENT_SAMPLES:].copy()).unsqueeze(1),
            label=torch.from_numpy(self._labels[recordings]),
            specimen=torch.from_numpy(self._specimens[recordings]),
            motion=torch.from_numpy(motion.astype(np.float32)),
            position_mm=torch.from_numpy(self._store.position_mm[split_point]),
            wander=torch.from_numpy(self._wander(split_point, hop)),
            position_path_mm=torch.from_numpy(self._store.position_mm[path]),
            wander_path=torch.from_numpy(self._store.wander_turns[path]),
            motion_path=torch.from_numpy(motions[:, _KNOTS].astype(np.float32)),
            level_motion=torch.from_numpy(level_motion.astype(np.float32)),
            level_mean_square_mps2=torch.from_numpy(
                np.square(level_wave).mean(axis=1, keepdims=True).astype(np.float32)
            ),
        )

    def state(self) -> dict[str, object]:
        """The generator's state, for a checkpoint."""
        return dict(self._generator.bit_generator.state)

    def restore(self, state: dict[str, object]) -> None:
        self._generator.bit_generator.state = state
