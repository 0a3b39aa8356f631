"""The golden recordings as Python gets them from the native reader."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from haptoflow_training import native_library as library_module
from haptoflow_training.errors import InputError
from haptoflow_training.recordings.native_recording import read_native
from haptoflow_training.recordings.own_files import described_file

FOLDER = Path(__file__).parents[1] / "Golden" / "recordings"
ANSWERS: list[dict[str, Any]] = json.loads((FOLDER / "expected.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("answer", ANSWERS, ids=lambda answer: str(answer["file"]))
def test_a_recording_has_its_one_right_answer(answer: dict[str, Any]) -> None:
    path = FOLDER / "files" / answer["file"]
    if "refused" in answer:
        with pytest.raises(InputError) as raised:
            read_native(path)
        assert answer["refused"].replace("FILE", str(path), 1) in str(raised.value)
        return
    recording = read_native(path)
    assert recording.even is not None
    assert recording.even.rate_hz == pytest.approx(answer["rate_hz"], rel=answer.get("rate_tolerance", 1e-6))
    assert recording.acceleration is not None
    values = recording.acceleration.values
    assert values.shape[1] == answer["axes"]
    assert np.all(np.diff(recording.acceleration.time_seconds) > 0.0)
    rms = np.sqrt(np.mean(np.sum((values - values.mean(axis=0)) ** 2, axis=1)))
    tolerance = max(answer.get("tolerance", 1e-4), 1e-3) * answer["rms_mps2"]
    assert rms == pytest.approx(answer["rms_mps2"], abs=tolerance)
    np.testing.assert_allclose(values.mean(axis=0), answer["mean_mps2"], atol=tolerance)
    if answer["speed_mps"] is None:
        assert recording.motion is None and recording.velocity_mps is None
    elif recording.motion is not None and not recording.has_positions:
        speeds = np.linalg.norm(recording.motion.values, axis=1)
        assert speeds.mean() == pytest.approx(answer["speed_mps"], rel=0.05)
    elif recording.velocity_mps is not None:
        assert np.hypot(*recording.velocity_mps) == pytest.approx(answer["speed_mps"])
    assert (recording.label, recording.licence, recording.source) == (
        answer["label"], answer["licence"], answer["source"],
    )  # fmt: skip
    for note in answer["notes"]:
        assert note in "\n".join(recording.notes)
    assert bool(recording.notes) == bool(answer["notes"])


@pytest.mark.parametrize("name", ["plain.csv", "position_mm.csv", "pause.csv", "wave_axes.wav", "constant.csv"])
def test_training_gets_what_was_measured_at_its_own_times(name: str) -> None:
    answer = next(each for each in ANSWERS if each["file"] == name)
    recording = described_file(FOLDER / "files" / name, name).load()
    assert recording.acceleration_g.shape[1] == answer["axes"]
    assert np.isfinite(recording.acceleration_g).all()
    span = recording.position_time_seconds[-1] - recording.position_time_seconds[0]
    way_mm = np.linalg.norm(np.diff(recording.position_mm, axis=0), axis=1).sum()
    if name != "pause.csv":
        assert way_mm / span / 1000.0 == pytest.approx(answer["speed_mps"], rel=0.05)
    assert recording.force_newtons.mean() == pytest.approx(answer["force_newtons"], rel=0.05)


def test_a_missing_library_is_named_with_the_command_that_builds_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(library_module.LIBRARY_VARIABLE, str(tmp_path / "gone.so"))
    library_module.native_library.cache_clear()
    try:
        with pytest.raises(InputError, match=r"gone\.so does not exist: run `npm run build`, or set HAPTOFLOW_LIBRARY"):
            read_native(FOLDER / "files" / "plain.csv")
    finally:
        library_module.native_library.cache_clear()
