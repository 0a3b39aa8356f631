"""Turns one recording into one axis of vibration at 2 kHz, with the motion of every sample; adds silence before and
after it, so that a network learns what happens without vibration."""

from __future__ import annotations

import dataclasses
import hashlib
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing import signals
from haptoflow_training.preprocessing.dft321 import dft321
from haptoflow_training.preprocessing.plausibility import implausible
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.recordings.native_recording import (
    NO_NOISE, MaterialRecording, SensorNoise, remove_sensor_noise
)
from haptoflow_training.recordings.recording import Recording, STANDARD_GRAVITY_MPS2

# A cubic spline through the samples needs this many.
_MINIMUM_SAMPLES = 4


def parts_between_gaps(recording: Recording, longest_gap_seconds: float) -> list[Recording]:
    """The stretches between gaps longer than `longest_gap_seconds`, in order. Stretches with too few samples to
    interpolate are left out; a recording without a gap is returned unchanged."""
    time = np.asarray(recording.acceleration_time_seconds)
    gaps = np.flatnonzero(np.diff(time) > longest_gap_seconds) + 1
    if len(gaps) == 0:
        return [recording]
    parts = (_cut(recording, first, last) for first, last in zip([0, *gaps], [*gaps, len(time)], strict=True))
    return [part for part in parts if part is not None]


def _cut(recording: Recording, first: int, last: int) -> Recording | None:
    if last - first < _MINIMUM_SAMPLES:
        return None
    time = recording.acceleration_time_seconds[first:last]
    force = _around(recording.force_time_seconds, float(time[0]), float(time[-1]))
    position = _around(recording.position_time_seconds, float(time[0]), float(time[-1]))
    if min(force.stop - force.start, position.stop - position.start) < _MINIMUM_SAMPLES:
        return None
    return dataclasses.replace(
        recording,
        acceleration_time_seconds=time,
        acceleration_g=recording.acceleration_g[first:last],
        force_time_seconds=recording.force_time_seconds[force],
        force_newtons=recording.force_newtons[force],
        position_time_seconds=recording.position_time_seconds[position],
        position_mm=recording.position_mm[position],
        velocity_mps=None if recording.velocity_mps is None else recording.velocity_mps[position],
    )


def _around(time: NDArray[np.float64], start: float, stop: float) -> slice:
    """The samples of another sensor's clock from the last one before `start` to the first one after `stop`."""
    first = max(0, int(np.searchsorted(time, start, side="right")) - 1)
    last = min(len(time), int(np.searchsorted(time, stop, side="left")) + 1)
    return slice(first, last)


_CONTEXT_SECONDS = 0.2
# Limit for recordings shorter than 1.5 s, so that trimming does not remove most of them.
_MAXIMUM_TRIM_SHARE = 0.2


@dataclass(frozen=True)
class PreparedRecording:
    """waveform_mps2: [n] float32, m/s^2. motion: [n, 3] float32: vx, vy in m/s, force in N. position_mm: [n, 2] float32:
    where the tip is on the surface. wander_turns: [n, 3] float64, as of Wander (recording.py), zero for files. All
    finite, n > 0. noise: what was removed from the waveform.
    """

    waveform_mps2: NDArray[np.float32]
    motion: NDArray[np.float32]
    position_mm: NDArray[np.float32]
    wander_turns: NDArray[np.float64]
    noise: SensorNoise = NO_NOISE

    def part(self, samples: slice) -> PreparedRecording:
        """Some of its samples."""
        return PreparedRecording(
            self.waveform_mps2[samples],
            self.motion[samples],
            self.position_mm[samples],
            self.wander_turns[samples],
            self.noise,
        )


def preprocess_recording(recording: Recording) -> PreparedRecording:
    """Preprocess a recording without gaps. InputError names the recording and the sensor if it cannot be prepared."""
    _require_usable(recording)
    _require_plausible(recording)
    _require_no_gap(recording)
    (prepared,) = _without_noise(recording, [_prepared(recording)])
    return prepared


def preprocess_parts(recording: Recording) -> list[PreparedRecording]:
    """As `preprocess_recording`, for each stretch between gaps of the accelerometer, so that a gap costs only the
    samples near it. Stretches that are too short are left out; InputError if none is long enough."""
    _require_usable(recording)
    if recording.is_generated:
        return [_generated(recording)]
    _require_plausible(recording)
    prepared: list[_Untrimmed] = []
    problems: list[InputError] = []
    for part in parts_between_gaps(recording, SETTINGS.longest_gap_seconds):
        try:
            prepared.append(_prepared(part))
        except InputError as problem:
            problems.append(problem)
    if not prepared:
        # If there are gaps, they are the reason why every part is too short; report them.
        _require_no_gap(recording)
        raise problems[0]
    return _without_noise(recording, prepared)


def _generated(recording: Recording) -> PreparedRecording:
    assert recording.velocity_mps is not None
    return PreparedRecording(
        (recording.acceleration_g[:, 0] * STANDARD_GRAVITY_MPS2).astype(np.float32),
        np.column_stack([recording.velocity_mps, recording.force_newtons]).astype(np.float32),
        recording.position_mm.astype(np.float32),
        signals.wander_turns_on_grid(None, recording.position_time_seconds),
    )


# A stretch with a little of what is trimmed at both ends, and the samples that are kept.
_Untrimmed = tuple[PreparedRecording, slice]


def _without_noise(recording: Recording, stretches: list[_Untrimmed]) -> list[PreparedRecording]:
    """The noise is that of the sensor, so that all stretches of a recording show it together."""
    if not recording.has_sensor_noise:
        return [whole.part(kept) for whole, kept in stretches]
    try:
        waves, noise = remove_sensor_noise(
            [MaterialRecording(whole.waveform_mps2, whole.motion) for whole, _ in stretches]
        )
    except InputError as error:
        raise InputError(f"recording {recording.identity.name}: {error}") from error
    return [
        dataclasses.replace(whole, waveform_mps2=wave, noise=noise).part(kept)
        for (whole, kept), wave in zip(stretches, waves, strict=True)
    ]


def _prepared(recording: Recording) -> _Untrimmed:
    start, stop = _common_span(recording)
    # The filters run over a little of what is trimmed, so that they do not ring at the cut.
    trim = min(SETTINGS.trim_seconds, _MAXIMUM_TRIM_SHARE * (stop - start))
    context = min(_CONTEXT_SECONDS, trim)
    step = 1.0 / SETTINGS.sample_rate_hz
    kept = int((stop - start - 2 * trim) / step)
    lead = round(context / step)
    if kept < SETTINGS.segment_samples:
        raise InputError(
            f"recording {recording.identity.name}: {max(kept, 0) * step:.2f} s are left after trimming "
            f"{trim:.2g} s from both ends; "
            f"expected {SETTINGS.segment_samples * step:.2f} s at least"
        )
    origin = start + trim - lead * step
    grid = origin + step * np.arange(lead + kept + lead)
    grid = grid[grid <= stop]
    waveform = _waveform(recording, origin, len(grid))
    if recording.velocity_mps is None:
        velocity = signals.velocity_mps(
            recording.position_time_seconds, recording.position_mm, grid, SETTINGS.velocity_window_seconds
        )
    else:
        velocity = signals.smooth_velocity_mps(
            recording.position_time_seconds, recording.velocity_mps, grid, SETTINGS.velocity_window_seconds
        )
    position = signals.position_mm_on_grid(recording.position_time_seconds, recording.position_mm, grid)
    force = signals.force_newtons(
        recording.force_time_seconds, recording.force_newtons, grid, SETTINGS.force_low_pass_hz
    )
    whole = PreparedRecording(
        waveform.astype(np.float32),
        np.column_stack([velocity, force]).astype(np.float32),
        position.astype(np.float32),
        signals.wander_turns_on_grid(recording.wander, grid),
    )
    return whole, slice(lead, lead + kept)


def _waveform(recording: Recording, origin_seconds: float, count: int) -> NDArray[np.float64]:
    factor = SETTINGS.high_rate_hz // SETTINGS.sample_rate_hz
    high_grid = origin_seconds + np.arange(count * factor) / SETTINGS.high_rate_hz
    time = recording.acceleration_time_seconds
    margin = 16
    first = max(0, int(np.searchsorted(time, high_grid[0])) - margin)
    last = int(np.searchsorted(time, high_grid[-1])) + margin
    axes = np.asarray(recording.acceleration_g[first:last], dtype=np.float64)
    axes = (axes - axes.mean(axis=0)) * STANDARD_GRAVITY_MPS2
    clamped = np.minimum(high_grid, time[-1])
    # The time stamps are irregular, at more than six times the band: a cubic spline through them is band-limited
    # enough.
    uniform = CubicSpline(time[first:last], axes, axis=0)(clamped)
    uniform = signals.zero_phase_high_pass(uniform, SETTINGS.high_pass_hz, SETTINGS.high_rate_hz)
    one_axis = uniform.shape[1] == 1
    combined = uniform[:, 0] if one_axis else dft321(uniform, SETTINGS.high_rate_hz, SETTINGS.dft321_frame_seconds)
    combined = signals.zero_phase_low_pass(combined, SETTINGS.low_pass_hz, SETTINGS.high_rate_hz)
    return signals.decimate(combined, SETTINGS.high_rate_hz, SETTINGS.sample_rate_hz)


def _common_span(recording: Recording) -> tuple[float, float]:
    clocks = (
        recording.acceleration_time_seconds,
        recording.force_time_seconds,
        recording.position_time_seconds,
    )
    start = max(float(clock[0]) for clock in clocks)
    stop = min(float(clock[-1]) for clock in clocks)
    acceleration = recording.duration_seconds
    if stop - start < 0.5 * acceleration:
        raise InputError(
            f"recording {recording.identity.name}: acceleration lasts {acceleration:.2f} s "
            f"but force and position share only {max(stop - start, 0.0):.2f} s of it; "
            "expected three sensors of the same pass"
        )
    return start, stop


def _require_plausible(recording: Recording) -> None:
    for problem in implausible(recording):
        raise InputError(f"recording {recording.identity.name}: {problem}")


def _require_no_gap(recording: Recording) -> None:
    time = recording.acceleration_time_seconds
    steps = np.diff(time)
    if float(steps.max()) > SETTINGS.longest_gap_seconds:
        raise InputError(
            f"recording {recording.identity.name}: acceleration misses {steps.max():.3f} s after "
            f"{time[int(steps.argmax())]:.3f} s; expected no gap above {SETTINGS.longest_gap_seconds} s"
        )


def _require_usable(recording: Recording) -> None:
    name = recording.identity.name
    axes = (1,) if np.shape(recording.acceleration_g)[1:] == (1,) else (3,)
    sensors = (
        ("acceleration", recording.acceleration_time_seconds, recording.acceleration_g, axes),
        ("force", recording.force_time_seconds, recording.force_newtons, ()),
        ("position", recording.position_time_seconds, recording.position_mm, (2,)),
    )
    for sensor, time, values, tail in sensors:
        if np.shape(values) != (len(time), *tail):
            raise InputError(
                f"recording {name}: {sensor} has shape {np.shape(values)}; expected {(len(time), *tail)}"
            )
        if len(time) < 4:
            raise InputError(f"recording {name}: {sensor} has {len(time)} samples; expected 4 at least")
        if not (np.all(np.isfinite(time)) and np.all(np.isfinite(values))):
            raise InputError(
                f"recording {name}: {sensor} holds values that are not finite; expected numbers only"
            )
        steps = np.diff(time)
        if not np.all(steps > 0):
            raise InputError(
                f"recording {name}: {sensor} time stops rising after sample {int(np.argmin(steps > 0))}; "
                "expected every time stamp to be later than the one before"
            )


# Three states without vibration: `rest` touches without moving, at the recording's force; `contact` touches down or lifts
# off without moving, its force rising from or falling to zero; `air` has neither velocity nor force.
PaddingState = Literal["rest", "contact", "air"]
PADDING_STATES: tuple[PaddingState, ...] = ("rest", "contact", "air")
# Largest share of a recording's length at each end, so that silence does not outweigh the recording.
_MAXIMUM_SHARE = 1.0 / 3.0


def pad_recording(prepared: PreparedRecording, name: str, seed: int) -> tuple[PreparedRecording, int, int]:
    """The recording with silence at its ends, and the samples of silence before and after it.

    Each end is padded with `padding_probability`; the draw depends on `seed` and `name` only, and the padding at an end
    is at most a third of the recording's length.
    """
    digest = hashlib.blake2b(f"padding/{seed}/{name}".encode(), digest_size=8).digest()
    generator = np.random.default_rng(int.from_bytes(digest, "little"))
    longest = int(_MAXIMUM_SHARE * len(prepared.waveform_mps2))
    before = _draw(generator, longest)
    after = _draw(generator, longest)
    if before is not None:
        prepared = _pad_front(prepared, *before)
    if after is not None:
        backward = slice(None, None, -1)
        prepared = _pad_front(prepared.part(backward), *after).part(backward)
    return prepared, before[1] if before else 0, after[1] if after else 0


def _draw(generator: np.random.Generator, longest: int) -> tuple[PaddingState, int] | None:
    wanted = generator.random() < SETTINGS.padding_probability
    state = PADDING_STATES[int(generator.integers(len(PADDING_STATES)))]
    segments = int(generator.integers(1, SETTINGS.padding_segments_max + 1))
    return (state, min(segments * SETTINGS.segment_samples, longest)) if wanted else None


def _pad_front(prepared: PreparedRecording, state: PaddingState, samples: int) -> PreparedRecording:
    fade = min(round(SETTINGS.padding_fade_seconds * SETTINGS.sample_rate_hz), len(prepared.waveform_mps2))
    gain = (0.5 - 0.5 * np.cos(np.pi * (np.arange(fade) + 0.5) / max(fade, 1))).astype(np.float32)
    waveform = prepared.waveform_mps2.copy()
    waveform[:fade] *= gain
    motion = prepared.motion.copy()
    motion[:fade, :2] *= gain[:, None]
    force = float(motion[0, 2])
    silence = np.zeros((samples, 3), dtype=np.float32)
    if state == "rest":
        silence[:, 2] = force
    elif state == "contact":
        silence[:, 2] = force * np.linspace(0.0, 1.0, samples, dtype=np.float32)
    else:
        motion[:fade, 2] *= gain
    return PreparedRecording(
        np.concatenate([np.zeros(samples, dtype=np.float32), waveform]),
        np.concatenate([silence, motion]),
        np.pad(prepared.position_mm, ((samples, 0), (0, 0)), mode="edge"),
        np.pad(prepared.wander_turns, ((samples, 0), (0, 0)), mode="edge"),
    )
