"""Several specimens of a label: different random surfaces, the same label; one is held out of training."""

from __future__ import annotations

import dataclasses
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from dataset_samples import small_recording
from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_recording
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.recordings.landing import RibWander, StickSlip, landing_of, landing_of_spring
from haptoflow_training.recordings.synthetic import (
    FURTHER_SPECIMENS, HELD_OUT_SPECIMEN, TRAINING_SPECIMENS, Material, hand_conditions, load_materials,
    machine_conditions, record_condition, training_specimen
)
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.recordings.synthetic.features import impact_acceleration, rib_wander_turns, ruling_height
from haptoflow_training.recordings.synthetic.materials import (
    DEFAULT_MATERIALS_PATH, Calibrated, Ruling, select_materials, write_calibrated
)
from haptoflow_training.recordings.synthetic.measurement import band_level
from haptoflow_training.recordings.synthetic.surface import (
    OCTAVE_WAVELENGTHS_MM, RandomField, TipPath, character_of, random_height, surface_gain
)
from haptoflow_training.training.config import DataConfig, load_config
from haptoflow_training.training.recordings_source import synthetic_label_infos
from places import ROOT

MATERIALS = {material.label: material for material in load_materials()}
CONFIGURATIONS = ROOT / "Training" / "configs"


def _path(speed_mmps: float = 200.0, seconds: float = 2.0, degrees: float = 20.0) -> TipPath:
    angle = np.radians(degrees)
    velocity = np.tile(speed_mmps * np.array([np.cos(angle), np.sin(angle)]), (int(seconds * SIMULATION_RATE_HZ), 1))
    return TipPath(np.cumsum(velocity, axis=0) / SIMULATION_RATE_HZ, velocity)


def _ribs(material: Material, ruling: Ruling, number: int, *, specimen: int) -> NDArray[np.float64]:
    wander = rib_wander_turns(material, ruling, number, _path(), specimen=specimen)
    return ruling_height(material, ruling, number, _path(), wander)


def test_another_specimen_has_another_random_surface_and_other_asperities() -> None:
    heights = [random_height(MATERIALS["stone"], _path(), specimen=each)[0] for each in (0, 1, HELD_OUT_SPECIMEN)]
    assert np.abs(np.corrcoef(np.diff(heights, axis=1))[np.triu_indices(3, 1)]).max() < 0.15
    impulses = [impact_acceleration(MATERIALS["stone"], _path(), SIMULATION_RATE_HZ, specimen=each) for each in (0, 4)]
    struck = [each != np.median(each) for each in impulses]
    assert np.mean(struck[0][struck[1]]) < 0.1


def test_specimens_have_their_ribs_at_the_same_places_but_for_the_jitter() -> None:
    for label in ("corduroy", "metal mesh", "jute"):
        material = MATERIALS[label]
        for number, ruling in enumerate(material.rulings):
            machined = replace(ruling, jitter=0.0)
            one, other = (_ribs(material, machined, number, specimen=each) for each in (0, 4))
            assert np.array_equal(one, other)
            one, other = (_ribs(material, ruling, number, specimen=each) for each in (0, 4))
            assert not np.array_equal(one, other)


def test_every_specimen_has_guided_and_free_strokes_slow_and_fast_ones_and_every_condition_of_a_pass() -> None:
    identities = hand_conditions(MATERIALS["wood"], seed=1, recordings=60)
    for share in (0.25, 0.5, 0.85):
        for guided in (True, False):
            met = {
                training_specimen(each)
                for each in identities
                if (int((each.repeat + 1) * share) > int(each.repeat * share)) == guided
            }
            assert met == set(TRAINING_SPECIMENS)
    for specimen in TRAINING_SPECIMENS:
        speeds = [each.speed_mmps for each in identities if training_specimen(each) == specimen]
        assert min(speeds) < 12 and max(speeds) > 400
    passes = machine_conditions(MATERIALS["wood"])
    data = load_config(CONFIGURATIONS / "default" / "standard.toml").data
    used = machine_conditions(
        MATERIALS["wood"],
        directions=data.machine_directions,
        speeds_mmps=data.machine_speeds_mmps,
        forces_millinewtons=data.machine_forces_millinewtons,
        repeats=data.machine_repeats,
    )
    for specimen in TRAINING_SPECIMENS:
        own = [each for each in passes if training_specimen(each) == specimen]
        assert len({each.direction_degrees for each in own}) == 8
        assert {each.speed_mmps for each in own} == {20, 30, 40, 50, 60}
        of_default = [each for each in used if training_specimen(each) == specimen]
        assert len({each.direction_degrees for each in of_default}) >= 5
        assert {each.speed_mmps for each in of_default} == {10, 20, 60}
        assert {each.force_millinewtons for each in of_default} == {500, 1000}
    for one, other in zip(passes[::2], passes[1::2], strict=True):
        assert one.repeat != other.repeat and training_specimen(one) != training_specimen(other)


SMOOTH = ("glass", "metal", "plastic", "paper")


def _level_and_slope(material: Material, specimen: int) -> tuple[float, float]:
    """Level in dB and slope of the spectrum in dB per octave, 50 to 400 Hz."""
    rate, size = SETTINGS.sample_rate_hz, 400
    powers = []
    for seed in range(4):
        recording = record_condition(
            material, velocity_mps=(0.2, 0.06), force_newtons=1.0, duration_seconds=4.0, seed=seed, specimen=specimen,
            accelerometer_noise=False,
        )  # fmt: skip
        wave = preprocess_recording(recording).waveform_mps2.astype(np.float64)
        frames = wave[: len(wave) // size * size].reshape(-1, size) * np.hanning(size)
        powers.append((np.abs(np.fft.rfft(frames, axis=1)) ** 2).mean(axis=0))
    power, frequency = np.mean(powers, axis=0), np.fft.rfftfreq(size, 1.0 / rate)
    octaves = np.log2(np.array([50.0, 100.0, 200.0, 400.0]))
    bands = [power[(frequency >= 2**at / 1.2) & (frequency <= 2**at * 1.2)].mean() for at in octaves]
    slope = np.polyfit(octaves, 10.0 * np.log10(bands), 1)[0]
    return 20.0 * np.log10(band_level(frequency, power)), float(slope)


@pytest.mark.parametrize("label", list(MATERIALS))
def test_training_specimens_are_on_average_the_label_and_spread_as_its_material_states(label: str) -> None:
    material = MATERIALS[label]
    found = [character_of(material, specimen) for specimen in TRAINING_SPECIMENS]
    levels = [each.level_db for each in found]
    tilts = [each.tilt_db_per_octave for each in found]
    for values, stated in ((levels, material.specimen_spread_db), (tilts, material.specimen_tilt_db_per_octave)):
        assert np.mean(values) == pytest.approx(0.0, abs=1e-12)
        assert np.std(values, ddof=1) == pytest.approx(stated, rel=0.05)
        assert len(set(values)) == len(TRAINING_SPECIMENS)
    assert list(np.argsort(levels)) != list(np.argsort(tilts))
    smooth = label in SMOOTH
    assert material.specimen_spread_db == (0.75 if smooth else 1.5)


def test_the_held_out_specimen_is_typical_and_further_ones_stay_within_two_deviations() -> None:
    levels = []
    for material in MATERIALS.values():
        typical = character_of(material, HELD_OUT_SPECIMEN)
        assert typical.level_db == typical.tilt_db_per_octave == 0.0
        for specimen in FURTHER_SPECIMENS:
            one = character_of(material, specimen)
            assert one == character_of(material, specimen)
            assert abs(one.level_db) <= 2.0 * material.specimen_spread_db
            assert abs(one.tilt_db_per_octave) <= 2.0 * material.specimen_tilt_db_per_octave
            levels.append(one.level_db / material.specimen_spread_db)
    assert np.mean(levels) == pytest.approx(0.0, abs=0.3) and np.std(levels) == pytest.approx(1.0, abs=0.25)


def test_a_recording_has_the_level_and_the_tilt_of_its_specimen() -> None:
    # Places are left out: a few metres of a stroke do not average them away.
    wood = replace(MATERIALS["wood"], place_spread_db=0.0)
    loud, soft = (pick(TRAINING_SPECIMENS, key=lambda one: character_of(wood, one).level_db) for pick in (max, min))
    for specimen in (loud, soft, HELD_OUT_SPECIMEN):
        level, slope = _level_and_slope(wood, specimen)
        plain_level, plain_slope = _level_and_slope(wood.without_spread, specimen)
        stated = character_of(wood, specimen)
        assert slope - plain_slope == pytest.approx(stated.tilt_db_per_octave, abs=0.05)
        # The tilt turns about 100 Hz and wood's centroid is half an octave above.
        assert level - plain_level == pytest.approx(stated.level_db, abs=0.6)
        if specimen == HELD_OUT_SPECIMEN:
            assert level == plain_level and slope == plain_slope


def _places(count: int) -> NDArray[np.float64]:
    x, y = np.meshgrid(np.linspace(-3000.0, 3000.0, count), np.linspace(-3000.0, 3000.0, count))
    return np.stack([x.ravel(), y.ravel()], axis=1)


def test_without_spread_every_specimen_and_place_is_typical() -> None:
    plain = MATERIALS["concrete"].without_spread
    for specimen in (*TRAINING_SPECIMENS, HELD_OUT_SPECIMEN, *FURTHER_SPECIMENS):
        assert np.all(surface_gain(plain, _places(10), specimen) == 1.0)
        assert character_of(plain, specimen).tilt_db_per_octave == 0.0


@pytest.mark.parametrize("material", load_materials(), ids=lambda material: material.label)
def test_every_touch_down_vibration_is_within_the_model_format_s_limits(material: Material) -> None:
    landing = landing_of(material)
    assert 1 <= len(landing.modes) <= 2 and 0.0 <= landing.restitution <= 0.9
    for mode in landing.modes:
        assert 1.0 <= mode.frequency_hz <= 1000.0
        assert 10.0 <= mode.decay_per_second <= 10000.0
        assert 0.0 < mode.gain_per_second <= 10000.0


def test_a_label_of_which_only_the_stiffness_is_known_lands_as_the_recorder_s_materials_of_that_stiffness() -> None:
    plain = dataclasses.replace(MATERIALS["wood"], stiffness_newtons_per_metre=900.0, contact_damping=0.4, tool_modes=())
    assert landing_of_spring(900.0) == landing_of(plain)


def test_targets_lie_between_the_5th_and_95th_published_percentile():
    for material in load_materials():
        targets = material.targets
        assert 0.25 <= targets.k <= 3.99, material.label
        assert 0.25 <= targets.p <= 1.58, material.label
        assert -0.14 <= targets.q <= 0.78, material.label
        assert 64.0 <= targets.centroid_hz <= 195.0, material.label
        assert -14.2 <= targets.slope_db_per_octave <= -2.4, material.label


def test_an_unknown_key_is_named(tmp_path):
    text = DEFAULT_MATERIALS_PATH.read_text().replace("anisotropy = 1.5", "anisotropi = 1.5")
    path = tmp_path / "materials.toml"
    path.write_text(text)
    with pytest.raises(InputError, match="wood.*anisotropi"):
        load_materials(path)


def test_a_third_family_of_ribs_and_a_spread_beyond_belief_are_refused(tmp_path):
    path = tmp_path / "materials.toml"
    text = DEFAULT_MATERIALS_PATH.read_text()
    rib = "{ direction_degrees = 0.0, wavelength_mm = 2.5, relative_height = 3.0, jitter = 0.02 }"
    path.write_text(text.replace(f"rulings = [{rib}]", f"rulings = [{rib}, {rib}, {rib}]"))
    with pytest.raises(InputError, match="corduroy: 3 rulings; expected 2 at most"):
        load_materials(path)
    path.write_text(text.replace("specimen_spread_db = 0.75", "specimen_spread_db = 75", 1))
    with pytest.raises(InputError, match="glass: specimen_spread_db = 75; expected a number between 0.0 and 6.0"):
        load_materials(path)


def test_a_missing_file_and_an_unknown_label_are_named(tmp_path):
    with pytest.raises(InputError, match="nowhere.toml"):
        load_materials(tmp_path / "nowhere.toml")
    with pytest.raises(InputError, match="marzipan"):
        select_materials(load_materials(), ["wood", "marzipan"])


def test_writing_calibrated_values_changes_nothing_else(tmp_path):
    path = tmp_path / "materials.toml"
    shutil.copy(DEFAULT_MATERIALS_PATH, path)
    write_calibrated(path, {"metal": Calibrated(1.0, 2.0, 0.5, 123.0, -1.0)})
    before, after = load_materials(), load_materials(path)
    for old, new in zip(before, after):
        if old.label == "metal":
            assert new == old.with_calibrated(
                height_micrometres=1.0,
                height_exponent=2.0,
                force_exponent=0.5,
                contact_resonance_hz=123.0,
                absorption_db_per_octave=-1.0,
            )
        else:
            assert new == old


STROKE_MM = 30_000.0
# An octave is silent above a certain rate, so half a minute meets at most this many wavelengths.
MAXIMUM_WAVES = 30 * 2000


def _line(count: int, step_mm: float, degrees: float) -> np.ndarray:
    angle = np.radians(degrees)
    return np.arange(count)[:, None] * step_mm * np.array([np.cos(angle), np.sin(angle)]) + np.array([12.0, -7.0])


def _autocorrelation(values: np.ndarray) -> np.ndarray:
    """Normalised, at lags from 0 to half the length; each lag divided by what overlaps."""
    count = len(values)
    power = np.abs(np.fft.rfft(np.concatenate([values - values.mean(), np.zeros(count)]))) ** 2
    raw = np.fft.irfft(power)[: count // 2] / (count - np.arange(count // 2))
    return raw / raw[0]


@pytest.mark.parametrize("octave", range(len(OCTAVE_WAVELENGTHS_MM)))
@pytest.mark.parametrize("degrees", [0.0, 17.0])
def test_no_octave_repeats_along_thirty_metres_or_half_a_minute_of_straight_stroke(octave: int, degrees: float) -> None:
    wavelength = OCTAVE_WAVELENGTHS_MM[octave]
    step = wavelength / 4.0
    count = 4 * min(int(STROKE_MM / wavelength), MAXIMUM_WAVES)
    seen = _autocorrelation(RandomField(1003, 0, octave, wavelength).at(_line(count, step, degrees)))
    # Six standard deviations of a correlation over as many independent wavelengths as the stroke has.
    chance = 6.0 / np.sqrt(0.5 * count * step / wavelength)
    beyond_the_main_lobe = np.abs(seen[4 * 6 :])
    assert beyond_the_main_lobe.max() < chance, np.argmax(beyond_the_main_lobe) * step


def test_asperities_neither_repeat_nor_keep_a_beat_along_thirty_metres_of_straight_stroke() -> None:
    rate = 8000.0
    velocity = np.tile([1000.0, 0.0], (int(30 * rate), 1))
    path = TipPath(np.cumsum(velocity, axis=0) / rate, velocity)
    for label in ("stone", "concrete", "brick", "sandpaper"):
        impulses = impact_acceleration(MATERIALS[label], path, rate, specimen=2)
        struck = impulses != np.median(impulses)
        assert 0.7 < np.sum(struck) * MATERIALS[label].impact_spacing_mm / (
            STROKE_MM * MATERIALS[label].impact_density
        ) < 1.1
        # Both strength and time: a repeated table shows in the first, a regular grid in the second.
        assert np.abs(_autocorrelation(impulses)[1:]).max() < 0.06, label
        assert np.abs(_autocorrelation(struck.astype(float))[8:]).max() < 0.06, label


def test_a_field_has_unit_power_and_the_same_spectrum_in_every_direction_and_place() -> None:
    field = RandomField(1000, 3, 2, 1.0)
    spectra = []
    for degrees in (0.0, 30.0, 45.0, 90.0, 137.0):
        values = field.at(_line(240_000, 0.125, degrees))
        assert np.sqrt(np.mean(values**2)) == pytest.approx(1.0, abs=0.01)
        assert np.mean(values**4) == pytest.approx(3.0, abs=0.1)
        halves = values.reshape(2, -1).std(axis=1)
        assert halves[0] / halves[1] == pytest.approx(1.0, abs=0.03)
        power = (np.abs(np.fft.rfft(values.reshape(-1, 800), axis=1)) ** 2).mean(axis=0)
        spectra.append(power[5:141].reshape(-1, 8).mean(axis=1))
    mean = np.mean(spectra, axis=0)
    heard = mean > 0.01 * mean.max()
    assert np.abs(np.array(spectra)[:, heard] / mean[heard] - 1.0).max() < 0.12


def _prepared(material: Material, velocity: tuple[float, float], seed: int, seconds: float = 6.0) -> PreparedRecording:
    recording = record_condition(
        material, velocity_mps=velocity, force_newtons=1.0, duration_seconds=seconds, seed=seed,
        accelerometer_noise=False,
    )  # fmt: skip
    return preprocess_recording(recording)


def _true_phases_line(prepared: PreparedRecording, turns: NDArray[np.float64]) -> float:
    """The share of the vibration's amplitude that keeps its phase relative to `turns`, 0 to 0.7."""
    wave = prepared.waveform_mps2.astype(np.float64)
    return float(abs(np.mean(wave * np.exp(-2j * np.pi * turns))) / np.std(wave))


@pytest.mark.parametrize(("family", "velocity"), [(0, (0.15, 0.0)), (1, (0.0, 0.15)), (0, (-0.9, 0.0))])
def test_the_phase_of_jute_s_threads_is_that_of_the_place_and_their_wander(
    family: int, velocity: tuple[float, float]
) -> None:
    jute = MATERIALS["jute"]
    for seed in range(2):
        prepared = _prepared(jute, velocity, seed)
        along = prepared.position_mm.astype(np.float64) @ np.array(jute.wave_vectors_per_mm[family])
        wander = prepared.wander_turns[:, family]
        assert np.std(wander) == pytest.approx(jute.rulings[family].jitter, rel=0.25)
        straight, with_wander, against = (_true_phases_line(prepared, along + factor * wander) for factor in (0.0, 1.0, -1.0))
        assert with_wander > 1.2 * straight and with_wander > 2.0 * against
        # As strong as the line of threads that do not wander.
        even = replace(jute, rulings=tuple(replace(ruling, jitter=0.0) for ruling in jute.rulings))
        assert with_wander == pytest.approx(_true_phases_line(_prepared(even, velocity, seed), along), rel=0.1)


@pytest.mark.parametrize("speed", [0.04, 0.08])
def test_rubber_s_slips_come_at_the_stated_phase_and_not_at_any_other_rate(speed: float) -> None:
    prepared = _prepared(MATERIALS["rubber"], (speed, 0.0), seed=3)
    turns = prepared.wander_turns[:, 2]
    assert np.all(np.diff(turns) > 0.0)
    at_phase = _true_phases_line(prepared, turns)
    assert at_phase > 0.1
    for factor in (0.5, 0.9, 1.1):
        assert at_phase > 3.0 * _true_phases_line(prepared, factor * turns)
    assert at_phase > 3.0 * _true_phases_line(prepared, np.linspace(turns[0], turns[-1], len(turns)))
    length_mm = 1e3 * speed * len(turns) / SETTINGS.sample_rate_hz / (turns[-1] - turns[0])
    assert length_mm == pytest.approx(MATERIALS["rubber"].stick_slip_length_mm, rel=0.1)


def test_a_store_keeps_wander_specimen_and_the_fraction_of_the_slip_s_phase(tmp_path: Path) -> None:
    recordings = [
        record_condition(
            MATERIALS[label], velocity_mps=(0.12, 0.05), force_newtons=1.0, duration_seconds=3.0, seed=seed,
            specimen=specimen,
        )
        for label, seed, specimen in (("rubber", 1, 3), ("jute", 2, 9), ("rubber", 4, 0))
    ]  # fmt: skip
    store = prepare_store([*recordings, small_recording()], ["rubber", "jute", "wood"], tmp_path / "store")
    assert [one.specimen for one in store.recordings] == [3, 9, 0, None]
    assert store.wander_turns.shape == (len(store.waveform), 3) and store.wander_turns.dtype == np.float32
    for recording, stored in zip(recordings, store.recordings, strict=False):
        turns = preprocess_recording(recording).wander_turns
        found = store.wander_turns[stored.recorded_samples]
        np.testing.assert_allclose(found[:, :2], turns[:, :2], atol=1e-6)
        apart = found[:, 2] - turns[:, 2]
        assert np.abs(apart - np.round(apart)).max() < 1e-6
        before = store.wander_turns[stored.start : stored.recorded_samples.start]
        assert np.all(before == found[0])
    assert store.wander_turns[:, 2].min() >= 0.0 and store.wander_turns[:, 2].max() < 1.0
    assert not np.any(store.wander_turns[store.recordings[-1].samples])


def test_labels_that_slip_or_wander_say_so_and_no_others() -> None:
    infos = {info.name: info for info in synthetic_label_infos(DataConfig())}
    assert infos["rubber"].stick_slip == StickSlip(0.0011, 0.25, 0.004)
    assert {name for name, info in infos.items() if info.stick_slip is not None} == {"rubber", "leather"}
    first, second = infos["jute"].rib_wander
    assert first == RibWander(0.12, pytest.approx(0.014)) and second == RibWander(0.12, pytest.approx(0.0119))
    assert {name for name, info in infos.items() if info.rib_wander} == {"jute", "corduroy", "metal mesh"}
    for info in infos.values():
        assert len(info.rib_wander) in (0, len(info.known_wave_vectors))
