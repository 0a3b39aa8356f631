"""Own recordings in every form read as the same stroke; errors are named with a remedy."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from own_samples import RATE_HZ, Stroke, csv_one_axis, csv_three_axes, stroke, wav_with_motion, with_sidecar
from scipy.io import wavfile

from haptoflow_training.commands.add_material import material_files, read_material_recordings
from haptoflow_training.errors import InputError
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.open_recordings import RecordingFile
from haptoflow_training.recordings.own_files import open_own_dataset

MADE = stroke(4.0)


def read(path: Path) -> tuple[RecordingFile, MaterialRecording]:
    (file,) = material_files([path])
    (recording,) = read_material_recordings([file])
    return file, recording


def assert_is_the_stroke(recording: MaterialRecording, made: Stroke, moving: bool = True) -> None:
    """Assert the stroke at 2 kHz, without the 0.3 s trimmed at each end."""
    count = len(recording.vibration_mps2)
    assert count == pytest.approx(2000 * (made.time_seconds[-1] - 0.6), abs=25)
    at = made.time_seconds[0] + 0.3 + np.arange(count) / 2000.0
    truth = np.interp(at, made.time_seconds, made.acceleration_mps2)
    found = recording.vibration_mps2
    assert np.sqrt(np.mean(found**2)) == pytest.approx(np.sqrt(np.mean(truth**2)), rel=0.03)
    assert np.corrcoef(found, truth)[0, 1] > 0.98
    if moving:
        for axis in range(2):
            velocity = np.interp(at, made.time_seconds, made.velocity_mps[:, axis])
            assert np.abs(recording.motion[:, axis] - velocity).max() < 0.004
        force = np.interp(at, made.time_seconds, made.force_newtons)
        assert np.abs(recording.motion[:, 2] - force).max() < 0.02


@pytest.mark.parametrize("form", [csv_one_axis, csv_three_axes, wav_with_motion])
def test_every_form_reads_as_the_same_stroke(tmp_path: Path, form: object) -> None:
    path = form(tmp_path, "slow", "denim", MADE, licence="CC0 1.0", source="a jacket")  # type: ignore[operator]
    file, recording = read(path)
    assert_is_the_stroke(recording, MADE)
    assert (file.identity.name, file.label) == (path.name, "denim")
    assert (file.licence, file.source) == ("CC0 1.0", "a jacket")


def test_constants_are_read_from_the_sidecar_or_the_folder_s_recordings_json(tmp_path: Path) -> None:
    path = tmp_path / "plain.wav"
    wavfile.write(path, RATE_HZ, (MADE.acceleration_mps2 / 50.0).astype(np.float32))
    (tmp_path / "recordings.json").write_text(json.dumps({"full_scale_mps2": 50, "speed_mps": 0.08, "force_newtons": 2}))
    file, recording = read(path)
    assert_is_the_stroke(recording, MADE, moving=False)
    np.testing.assert_allclose(recording.motion, np.tile([0.08, 0.0, 2.0], (len(recording.motion), 1)), atol=1e-6)
    assert (file.label, file.licence, file.source) == ("", "unknown", "unknown")
    with_sidecar(path, {"velocity_mps": [0.0, -0.1], "label": "felt"})
    file, recording = read(path)
    np.testing.assert_allclose(recording.motion[:, 1], -0.1, atol=1e-6)
    assert file.label == "felt" and recording.motion[0, 2] == pytest.approx(2.0)


@pytest.mark.parametrize(("rate_hz", "kind"), [(1000, np.int32), (44100, np.float32)])
def test_a_wav_of_any_rate_and_kind_keeps_its_level_and_what_lies_above_the_band_does_not_fold_back(
    tmp_path: Path, rate_hz: int, kind: type
) -> None:
    time = np.arange(3 * rate_hz) / rate_hz
    wave = 3.0 * np.sin(2 * np.pi * 150.0 * time)
    if rate_hz > 20000:
        wave += 3.0 * np.sin(2 * np.pi * 7900.0 * time)
    scale = np.iinfo(kind).max if np.issubdtype(kind, np.integer) else 1.0
    path = tmp_path / "tone.wav"
    wavfile.write(path, rate_hz, (wave / 20.0 * scale).astype(kind))
    with_sidecar(path, {"full_scale_mps2": 20, "speed_mps": 0.1, "force_newtons": 1})
    found = read(path)[1].vibration_mps2[200:-200]
    assert np.sqrt(np.mean(found**2)) == pytest.approx(3.0 / np.sqrt(2.0), rel=0.02)
    spectrum = np.abs(np.fft.rfft(found * np.hanning(len(found))))
    frequency = np.fft.rfftfreq(len(found), 0.0005)
    assert spectrum[np.abs(frequency - 150.0) > 20.0].max() < 0.005 * spectrum.max()


@pytest.mark.parametrize(
    ("text", "sidecar", "words"),
    [
        ("", {}, r"a\.csv: is empty"),
        ("time_s,acceleration_mps2\n0,1\n0.001,1\n0.002,1.5\n0.003,1\n", {}, r"no motion.*velocity_x_mps.*key speed_mps"),
        ("time_s,acceleration_mps2\n0,1\n", {"lable": "denim"}, r"a\.json: unknown key 'lable'; expected keys of label"),
    ],
)
def test_a_table_that_cannot_be_used_is_named_with_what_was_found_and_expected(
    tmp_path: Path, text: str, sidecar: dict[str, object], words: str
) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with_sidecar(path, sidecar)
    with pytest.raises(InputError, match=words) as raised:
        read(path)
    assert "\n" not in str(raised.value)


def test_a_missing_file_and_an_empty_folder_are_named(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match=r"empty: no recording in it; expected files that end with \.csv"):
        material_files([tmp_path / "empty"])
    with pytest.raises(InputError, match="does not exist"):
        material_files([tmp_path / "gone"])


def test_motion_files_in_a_folder_are_not_recordings(tmp_path: Path) -> None:
    wav_with_motion(tmp_path / "felt", "slow", "felt", MADE, licence="CC0 1.0", source="a hat")
    csv_one_axis(tmp_path / "denim", "slow", "denim", MADE)
    csv_one_axis(tmp_path, "nameless", "", MADE)
    dataset = open_own_dataset(tmp_path)
    assert {(file.identity.name, file.label) for file in dataset} == {
        ("denim/slow.csv", "denim"), ("felt/slow.wav", "felt"),
    }  # fmt: skip
    assert re.search(r"1 recordings are left out: no sidecar has a key 'label' for nameless\.csv", dataset.left_out)
    assert dataset.provenance["source"] == "unknown, a hat"
    assert [path.name for path in dataset.recordings[1].paths] == ["slow.wav", "slow.json", "slow.motion.csv"]


def test_endings_in_any_case_are_read_and_none_is_overlooked(tmp_path: Path) -> None:
    made = stroke(3.0)
    for name, ending in (("one", ".CSV"), ("two", ".Csv")):
        path = csv_one_axis(tmp_path, name, "denim", made)
        path.rename(path.with_suffix(ending))
    path = wav_with_motion(tmp_path, "three", "felt", made)
    path.rename(path.with_suffix(".WAV"))
    (tmp_path / "three.motion.csv").rename(tmp_path / "three.Motion.CSV")
    for name, ending in (("one", ".JSON"), ("three", ".Json")):
        (tmp_path / f"{name}.json").rename(tmp_path / f"{name}{ending}")
    (tmp_path / "Recordings.JSON").write_text('{"licence": "CC0"}', encoding="utf-8")
    dataset = open_own_dataset(tmp_path)
    assert {entry.path.name: entry.label for entry in dataset} == {
        "one.CSV": "denim", "two.Csv": "denim", "three.WAV": "felt"
    }  # fmt: skip
    assert dataset.provenance["licence"] == "CC0" and not dataset.problems
    for entry in dataset:
        assert entry.load().acceleration_g.size > 0
    three = next(entry for entry in dataset if entry.label == "felt")
    assert {path.name for path in three.paths} == {"three.WAV", "three.Json", "Recordings.JSON", "three.Motion.CSV"}
    assert len(list(open_own_dataset(tmp_path / "one.CSV"))) == 1
