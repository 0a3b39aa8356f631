"""The counts of found, missed and wrong ribs, and the page that states them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from haptoflow_benchmark.cli import main
from haptoflow_benchmark import wave_vector_study
from haptoflow_benchmark.wave_vector_study import measured, study_surfaces

ROOT = Path(__file__).parents[2]


def test_found_missed_and_wrong_vectors_are_counted_separately(monkeypatch: pytest.MonkeyPatch) -> None:
    surfaces = list(study_surfaces())
    corduroy = next(each for each in surfaces if each.name == "corduroy")
    mesh = next(each for each in surfaces if each.name == "metal mesh")
    glass = next(each for each in surfaces if each.name == "glass")
    answers = iter(
        [
            ((-0.404, 0.0),), ((0.4, 0.0), (0.2, 0.7)),
            ((0.833, 0.0),), ((0.833, 0.02), (0.0, 0.87)),
            (), ((0.3, 0.3),),
        ]  # fmt: skip
    )
    monkeypatch.setattr(wave_vector_study, "make_rides", lambda *_, **__: ())
    monkeypatch.setattr(wave_vector_study, "estimate_wave_vectors", lambda _: next(answers))
    totals = measured([corduroy, mesh, glass])["totals"]
    assert totals["10"] == {
        "ruled_surfaces": 2, "families": 3, "within_2_percent": 2, "within_5_percent": 2,
        "wrong_on_ruled": 0, "unruled_surfaces": 1, "wrong_on_unruled": 0,
    }  # fmt: skip
    assert totals["30"] == {
        "ruled_surfaces": 2, "families": 3, "within_2_percent": 1, "within_5_percent": 3,
        "wrong_on_ruled": 1, "unruled_surfaces": 1, "wrong_on_unruled": 1,
    }  # fmt: skip


def test_the_command_writes_what_it_counts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["measure-wave-vectors", "--every", "60", "--results", str(tmp_path / "found.json")]) == 0
    results = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert len(results["surfaces"]) == 2
    assert "families of ribs within 2 %" in capsys.readouterr().out


def test_the_page_states_the_counts_of_the_stored_results() -> None:
    totals = json.loads((ROOT / "Training" / "results" / "wave-vectors.json").read_text(encoding="utf-8"))["totals"]
    page = (ROOT / "Documentation~" / "own-materials.md").read_text(encoding="utf-8")
    for seconds, total in totals.items():
        row = (
            f"| {seconds} s | {total['families']} | {total['within_2_percent']} | {total['within_5_percent']} | "
            f"{total['wrong_on_ruled']} | {total['wrong_on_unruled']} |"
        )
        assert row in page
