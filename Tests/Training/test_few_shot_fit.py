"""A material fitted to seconds: level, tone, frame, seeds and embedding match the recording."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from haptoflow_benchmark.few_shot.few_shot_rivals import fit_autoregressive
from haptoflow_benchmark.metrics.waveform_metrics import power_spectrum
from haptoflow_training.errors import InputError
from haptoflow_training.export.material_sound import LevelTable, ToneTable
from haptoflow_training.export.model_file import ModelFile, read_model_file
from haptoflow_training.fewshot.embedding_fit import FitOptions
from haptoflow_training.fewshot.exponents import frequency_exponent
from haptoflow_training.fewshot.label_prior import LabelPrior
from haptoflow_training.fewshot.level_law import LevelLaw, fit_level
from haptoflow_training.fewshot.material_fit import fit_material, steps_of
from haptoflow_training.fewshot.seeds import choose_seeds
from haptoflow_training.fewshot.stroke_recording import Frame, StrokeRecording, windows_of
from haptoflow_training.fewshot.tone_fit import band_powers, fit_tone, speed_knots
from haptoflow_training.fewshot.voice import Voice, apply_tone, render
from haptoflow_training.models.file_model import FileModel
from haptoflow_training.recordings.material_recording import MaterialRecording

ROOT = Path(__file__).parents[2]
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
FLAT = LevelLaw(LevelTable((0.1,), (0.0,), 1.0, 0.0), 0.0)


@pytest.fixture(scope="module")
def model() -> FileModel:
    return FileModel(read_model_file(DEFAULT))


@pytest.fixture(scope="module")
def prior(model: FileModel) -> LabelPrior:
    return LabelPrior.of(model.file)


def motion_of(speed_mps: np.ndarray, force_newtons: float | np.ndarray = 1.0) -> np.ndarray:
    force = np.broadcast_to(force_newtons, speed_mps.shape)
    return np.stack([speed_mps, np.zeros_like(speed_mps), force], axis=1).astype(np.float32)


def stroke(wave: np.ndarray, motion: np.ndarray) -> StrokeRecording:
    position = np.cumsum(motion[:, :2], axis=0) / 2.0
    return StrokeRecording(wave.astype(np.float32), motion, position.astype(np.float32))


def swept(seconds: float, low: float = 0.02, high: float = 0.2, period: float = 2.5) -> np.ndarray:
    time = np.arange(int(2000 * seconds)) / 2000.0
    return np.exp(np.interp(np.sin(2.0 * np.pi * time / period), [-1.0, 1.0], np.log([low, high])))


def levels_db(law: LevelLaw, speeds: list[float], force: float = 1.0) -> np.ndarray:
    return 20.0 / math.log(10.0) * law.table.log_level(speeds, force, law.speed_exponent)


def test_the_level_follows_a_step_that_breaks_any_power_law(prior: LabelPrior) -> None:
    speed = swept(30.0, 0.03, 0.15, period=10.0)
    wanted = lambda v: 20.0 * np.log10(v / 0.05) + 14.0 * np.clip((v - 0.06) / 0.02, 0.0, 1.0)  # noqa: E731
    wave = np.random.default_rng(1).standard_normal(len(speed)) * 10.0 ** (wanted(speed) / 20.0)
    law = fit_level(windows_of([stroke(wave, motion_of(speed))], 200, 100), prior)
    speeds = [0.035, 0.05, 0.09, 0.11, 0.14]
    assert levels_db(law, speeds) == pytest.approx([float(wanted(v)) for v in speeds], abs=2.0)


def test_beyond_the_recorded_speeds_the_level_continues_with_the_recorded_exponent(prior: LabelPrior) -> None:
    speed = swept(20.0, 0.03, 0.15)
    wave = np.random.default_rng(2).standard_normal(len(speed)) * (speed / 0.1) ** 0.6
    law = fit_level(windows_of([stroke(wave, motion_of(speed))], 200, 100), prior)
    assert law.speed_exponent == pytest.approx(0.6, abs=0.15)
    assert levels_db(law, [0.6])[0] == pytest.approx(20.0 * 0.6 * math.log10(6.0), abs=2.0)


def test_a_recording_at_one_force_takes_the_labels_force_exponent_and_one_at_many_its_own(prior: LabelPrior) -> None:
    speed, rng = swept(20.0), np.random.default_rng(3)
    force = np.exp(0.8 * np.sin(np.arange(len(speed)) / 3100.0))
    noise = rng.standard_normal(len(speed)) * speed / 0.1
    constant = fit_level(windows_of([stroke(noise, motion_of(speed))], 200, 100), prior)
    assert constant.force_exponent == pytest.approx(prior.force_exponent[0], abs=0.05)
    pressed = fit_level(windows_of([stroke(noise * force**0.9, motion_of(speed, force))], 200, 100), prior)
    assert pressed.force_exponent == pytest.approx(0.9, abs=0.1)


def test_impacts_count_by_their_power(prior: LabelPrior) -> None:
    speed, rng = swept(20.0), np.random.default_rng(4)
    wave = rng.standard_normal(len(speed)) * np.where(rng.random(len(speed)) < 0.01, 10.0, 0.5)
    law = fit_level(windows_of([stroke(wave, motion_of(speed))], 200, 100), prior)
    assert levels_db(law, [0.06])[0] == pytest.approx(20.0 * math.log10(float(np.sqrt(np.mean(wave**2)))), abs=1.5)


def test_a_recording_at_rest_has_no_level(prior: LabelPrior) -> None:
    still = stroke(np.ones(4000), motion_of(np.full(4000, 1e-4)))
    with pytest.raises(InputError, match="moves faster than"):
        fit_level(windows_of([still], 200, 100), prior)


def toned_bands(wave: np.ndarray, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    windows = windows_of([stroke(wave, motion)], 512, 256)
    return *band_powers(windows.waves), windows.speed_mps


def test_an_applied_tone_is_recovered_at_every_speed() -> None:
    speed, rng = swept(40.0, period=8.0), np.random.default_rng(5)
    gains = (8.0, 2.0, -6.0, 0.0, 4.0), (-6.0, 4.0, 0.0, 6.0, -4.0)
    true = ToneTable((0.03, 0.15), (20.0, 80.0, 200.0, 500.0, 900.0), gains)
    motion = motion_of(speed)
    noise = rng.standard_normal(len(speed)).astype(np.float32)
    recorded, centres, counts, heard = toned_bands(apply_tone(noise, speed, true), motion)
    made = np.mean([toned_bands(rng.standard_normal(len(speed)), motion)[0] for _ in range(3)], axis=0)
    found = fit_tone(recorded, made, centres, counts, heard, speed_knots(heard, 40.0))
    for at in (0.03, 0.07, 0.14):
        frequencies = [40.0, 80.0, 150.0, 300.0, 700.0]
        assert found.gain_db(at, frequencies) == pytest.approx(true.gain_db(at, frequencies), abs=2.0)


def test_without_a_difference_the_fitted_tone_is_nearly_flat_even_from_three_seconds() -> None:
    speed, rng = swept(3.0), np.random.default_rng(6)
    motion = motion_of(speed)
    recorded, centres, counts, heard = toned_bands(rng.standard_normal(len(speed)), motion)
    made = np.mean([toned_bands(rng.standard_normal(len(speed)), motion)[0] for _ in range(3)], axis=0)
    found = fit_tone(recorded, made, centres, counts, heard, speed_knots(heard, 3.0))
    assert np.sqrt(np.mean(np.square(found.gains_db))) < 1.0


def test_a_ruled_material_lies_across_its_clearest_ribs() -> None:
    frame = Frame.of([(-0.3, 0.4), (0.5, 0.0)])
    assert frame.wave_numbers[:2] == pytest.approx([0.5, 0.0], abs=1e-6)
    assert frame.wave_numbers[3] >= 0.0
    velocity = np.array([[0.3, -0.1]])
    before = abs(np.array([-0.3, 0.4]) @ velocity[0])
    assert abs(frame.wave_numbers[:2] @ frame.turned(velocity)[0]) == pytest.approx(before, rel=1e-5)
    assert Frame.of([]).turned(velocity) == pytest.approx(velocity)
    assert not Frame.of([]).is_ruled


def test_seeds_filtered_by_the_tone_equal_the_recording() -> None:
    speed, rng = swept(8.0, period=4.0), np.random.default_rng(7)
    wave = lfilter([1.0], [1.0, -0.8], rng.standard_normal(len(speed)))
    recording = stroke(wave, motion_of(speed))
    tone = ToneTable((0.03, 0.15), (20.0, 200.0, 900.0), ((6.0, -3.0, 2.0), (-4.0, 3.0, 0.0)))
    seeds = choose_seeds([recording], tone, [np.zeros((len(wave), 2))], ruled=False)
    assert 3 <= len(seeds) <= 8
    for seed in seeds:
        assert np.sqrt(np.mean(np.square(seed.samples))) == pytest.approx(1.0, abs=1e-3)
        heard = apply_tone(seed.samples, np.full(400, np.hypot(*seed.velocity_mps)), tone)[64:]
        windows = np.lib.stride_tricks.sliding_window_view(recording.wave_mps2, len(heard))
        match = windows @ heard / (np.linalg.norm(windows, axis=1) * np.linalg.norm(heard))
        assert match.max() > 0.97


def test_a_constant_spectrum_gives_a_frequency_exponent_near_zero() -> None:
    speed, rng = swept(10.0), np.random.default_rng(8)
    windows = windows_of([stroke(rng.standard_normal(len(speed)), motion_of(speed))], 400, 200)
    assert frequency_exponent(windows) < 0.12


def test_a_label_rendered_by_the_model_is_recognised_and_fitted(model: FileModel) -> None:
    """The model's own rendering of paper, at another level and through a tone, is fitted as paper at that level."""
    names = [label["name"] for label in model.labels]
    speed = np.concatenate([swept(5.0, 0.02, 0.1), swept(5.0, 0.05, 0.2)])
    motion = motion_of(speed)
    level = LevelLaw(LevelTable((0.02, 0.2), (-1.0, 1.5), 1.0, 0.3), 1.0)
    tone = ToneTable((0.06,), (20.0, 100.0, 300.0, 900.0), ((-4.0, 0.0, 6.0, -2.0),))
    true = Voice(model.label_embeddings[names.index("paper")].numpy(), level, tone)
    made = render(model.tier(), [true], motion[None], 9).waves[0]
    recording = MaterialRecording("r", "p", made, motion[:, :2].copy(), motion[:, 2].copy(), "MIT", "test")
    options, counted = FitOptions(steps=30), []
    fitted = fit_material(model, [recording], options=options, advance=lambda: counted.append(1))
    assert len(counted) == steps_of(model, options)
    assert fitted.seconds == pytest.approx(10.0)
    wanted, found = (
        render(model.tier(), [voice], motion_of(np.full(8000, 0.08))[None], 10).waves[0, 400:]
        for voice in (true, fitted.voice)
    )
    assert 20.0 * abs(math.log10(np.sqrt(np.mean(found**2) / np.mean(wanted**2)))) < 1.0
    ratio = 10.0 * np.log10(power_spectrum(found, 256)[3:58] / power_spectrum(wanted, 256)[3:58])
    assert np.sqrt(np.mean(ratio**2)) < 1.8
    assert set(fitted.distances_db) == {"draft", "standard"}


def test_the_same_seed_gives_the_same_material_and_another_a_different_one(model: FileModel) -> None:
    speed = swept(4.0)
    wave = np.random.default_rng(11).standard_normal(len(speed)).astype(np.float32)
    motion = motion_of(speed)
    recording = MaterialRecording("r", "", wave, motion[:, :2].copy(), motion[:, 2].copy(), "", "")
    fits = [
        fit_material(model, [recording], seed=seed, options=FitOptions(steps=6), compare_tiers=False).voice
        for seed in (1, 1, 2)
    ]
    assert np.array_equal(fits[0].embedding, fits[1].embedding)
    assert fits[0].tone == fits[1].tone
    assert fits[0].level == fits[1].level
    assert not np.array_equal(fits[0].embedding, fits[2].embedding)


def test_a_model_of_one_label_and_another_solver_is_fitted_to_as_well() -> None:
    tiny = read_model_file(ROOT / "Tests" / "Golden" / "model" / "tiny.haptoflow")
    header = {**tiny.header, "labels": tiny.header["labels"][:1], "tiers": [tiny.header["tiers"][1]]}
    alone = FileModel(ModelFile(header, tiny.tensors, tiny.graphs))
    speed = swept(3.0)
    motion = motion_of(speed)
    wave = np.random.default_rng(14).standard_normal(len(speed)).astype(np.float32)
    recording = MaterialRecording("r", "", wave, motion[:, :2].copy(), motion[:, 2].copy(), "", "")
    fitted = fit_material(alone, [recording], options=FitOptions(steps=3))
    assert np.isfinite(fitted.voice.embedding).all()
    assert fitted.fit.nearest == 0


def test_the_autoregressive_rival_recovers_an_autoregressive_spectrum() -> None:
    rng = np.random.default_rng(12)
    speed = swept(10.0)
    wave = lfilter([1.0], [1.0, -1.6, 0.9], rng.standard_normal(len(speed)))
    wave /= np.sqrt(np.mean(wave**2))
    rival = fit_autoregressive([stroke(wave, motion_of(speed))], FLAT, 3)
    assert len(rival.filters) == 3
    made = rival.render(motion_of(np.full(20000, 0.06)), 1)
    assert np.sqrt(np.mean(made**2)) == pytest.approx(1.0, abs=0.15)
    ratio = 10.0 * np.log10(power_spectrum(made, 256)[3:100] / power_spectrum(wave, 256)[3:100])
    assert np.sqrt(np.mean(ratio**2)) < 1.0


def test_training_a_copied_tier_leaves_the_model_s_own_tier_unchanged(model: FileModel) -> None:
    speed = swept(3.0)
    motion = motion_of(speed)
    wave = np.random.default_rng(13).standard_normal(len(speed)).astype(np.float32)
    recording = MaterialRecording("r", "", wave, motion[:, :2].copy(), motion[:, 2].copy(), "", "")
    voice = Voice(model.label_embeddings[0].numpy(), FLAT)
    straight = motion_of(np.full(1000, 0.08))[None]
    before = render(model.tier(), [voice], straight, 1).waves
    moving = model.trainable_tier()
    started = {name: weight.detach().clone() for name, weight in moving.field.weights.items()}
    fit_material(
        model, [recording], options=FitOptions(steps=2), tier=moving, weights_learning_rate=1e-3, compare_tiers=False
    )
    assert any(not np.array_equal(started[name], weight.detach()) for name, weight in moving.field.weights.items())
    assert np.array_equal(render(model.tier(), [voice], straight, 1).waves, before)
