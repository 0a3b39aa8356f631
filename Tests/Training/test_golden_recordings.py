"""Recordings as Python gets them from the native reader, whose own tests say what each file must give."""

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


@pytest.mark.parametrize("name", ["plain.csv", "position_mm.csv", "pause.csv", "wave_axes.wav", "constant.csv"])
def test_training_gets_what_was_measured_at_its_own_times(name: str) -> None:
    answer = next(each for each in ANSWERS if each["file"] == name)
    read = read_native(FOLDER / "files" / name)
    assert read.acceleration is not None
    assert (read.label, read.licence, read.source) == (answer["label"], answer["licence"], answer["source"])
    assert all(note in "\n".join(read.notes) for note in answer["notes"])
    recording = described_file(FOLDER / "files" / name, name).load()
    assert recording.acceleration_g.shape[1] == answer["axes"]
    assert np.isfinite(recording.acceleration_g).all()
    span = recording.position_time_seconds[-1] - recording.position_time_seconds[0]
    way_mm = np.linalg.norm(np.diff(recording.position_mm, axis=0), axis=1).sum()
    if name != "pause.csv":
        assert way_mm / span / 1000.0 == pytest.approx(answer["speed_mps"], rel=0.05)
    assert recording.force_newtons.mean() == pytest.approx(answer["force_newtons"], rel=0.05)


def test_a_refusal_is_the_library_s_own_sentence() -> None:
    path = FOLDER / "files" / "runs_back.csv"
    with pytest.raises(InputError, match=r"runs_back\.csv:102: column time_s: runs back to 0\.098 s; expected") as raised:
        read_native(path)
    assert str(raised.value).startswith(str(path))


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
