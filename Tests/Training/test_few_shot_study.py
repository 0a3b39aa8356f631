"""The few-shot study: unseen materials, correct figures, resumption after an interruption."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import freqz, lfilter, welch

from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.cli import main
from haptoflow_paper.studies.few_shot_cases import (
    SECONDS, FewShotCase, conditions, filtered_surfaces, make_case, study_materials
)
from haptoflow_paper.studies.few_shot_report import (
    OTHER_DRAW, ROWS, assembled, condition_figures, curve_table, page_words, table, write_chart, write_results
)
from haptoflow_paper.studies.few_shot_rivals import fit_autoregressive
from haptoflow_paper.studies.few_shot_study import StudyPlan, cells_of, with_trained
from haptoflow_training.export.level_table import LevelTable
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import with_measured_words
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.synthetic import load_materials
from places import DEFAULT, ENGINE, ROOT

RESULTS = ROOT / "Training" / "haptoflow_paper" / "results" / "few-shot.json"
TABLES = RESULTS.with_suffix(".md")


@pytest.fixture(scope="module")
def case() -> FewShotCase:
    return make_case(study_materials(3, 2026)[2], 2026, 10.0)


def test_unseen_materials_lie_between_labels_and_equal_none() -> None:
    known = load_materials()
    unseen = study_materials(12, 2026)
    assert len({material.label for material in unseen}) == 12
    for material in unseen:
        assert all(material.calibrated != other.calibrated for other in known)
        assert all(material.tool_modes != other.tool_modes for other in known)
        assert all(material.surface_seed != other.surface_seed for other in known)
    assert sum(bool(material.rulings) for material in unseen) >= 3
    assert sum(material.impact_strength > 0.0 for material in unseen) >= 2
    assert sum(material.stick_slip_strength > 0.0 for material in unseen) >= 2
    assert unseen == study_materials(12, 2026)
    assert unseen[0] != study_materials(12, 2027)[0]


def test_the_recording_itself_has_no_error_and_twice_its_amplitude_has_six_decibels(case: FewShotCase) -> None:
    condition = case.conditions[3]
    same = condition_figures(condition, condition.recorded)
    assert same["level_error_db"] == pytest.approx(0.0, abs=1e-6)
    assert same["gfc"] == pytest.approx(1.0)
    assert same["lsd_db"] == pytest.approx(0.0, abs=1e-6)
    assert same["rib_fundamental_error_percent"] == 0.0
    twice = condition_figures(condition, 2.0 * condition.recorded)
    assert twice["level_error_db"] == pytest.approx(6.02, abs=0.01)
    assert twice["lsd_db"] == pytest.approx(6.02, abs=0.1)


def cell(level: float, gfc: float = 0.99, lsd: float = 1.0) -> dict[str, float]:
    return {
        "level_error_db": level, "gfc": gfc, "lsd_db": lsd, "kurtosis_log_ratio": -0.2, "crest_log_ratio": 0.1,
        "modulation_error_db": 1.0,
    }  # fmt: skip


def stored(material: str, ruled: bool) -> dict[str, object]:
    rows = {f"{row} {seconds:g}": [cell(1.0), cell(2.0)] for row in ROWS for seconds in SECONDS}
    rows |= {"draft 10": [cell(1.5)], OTHER_DRAW: [cell(0.1)]}
    return {
        "material": material, "filtered": False, "ruled": ruled, "impacts": False, "rows": rows,
        "core_seconds": {"learn 10": 8.0}, "notes": {"families": 1, "ribs_found": 1, "ribs_wrong": 0},
    }  # fmt: skip


def test_an_interrupted_study_resumes_from_stored_cells(tmp_path: Path) -> None:
    plan = StudyPlan(DEFAULT, ENGINE, tmp_path, 1)
    material = study_materials(1, 1)[0]
    (tmp_path / f"{material.label}.json").write_text(json.dumps(stored(material.label, False)), encoding="utf-8")
    counted: list[int] = []
    found = cells_of(plan, read_model_file(DEFAULT), material, lambda: counted.append(1))
    assert found == stored(material.label, False)
    assert counted == [1]


def test_the_report_has_every_row_tables_and_a_chart(tmp_path: Path) -> None:
    cells = [stored("a", False), stored("b", True)]
    results = assembled(cells, {"model_sha256": "0" * 64, "seconds": list(SECONDS)})
    assert set(results["results"]) == {"all", "with ribs", "without ribs"}
    made = table(results, 10.0)
    for words in (*ROWS.values(), "tier `draft`", "another draw"):
        assert words in made
    assert made.count("\n") == 1 + len(ROWS) + 2
    curve = curve_table(results, "lsd_median_db")
    assert "| 5 s | 10 s | 20 s | 60 s |" in curve
    write_results(tmp_path / "few-shot.json", results)
    assert json.loads((tmp_path / "few-shot.json").read_text(encoding="utf-8")) == results
    write_chart(tmp_path / "few-shot.png", results)
    assert (tmp_path / "few-shot.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


@pytest.mark.long(
    because="the few-shot study is run whole for one material; the tests of its report and of its cases run its parts"
)
def test_a_whole_study_of_one_material_measures_every_row(tmp_path: Path) -> None:
    plan = StudyPlan(DEFAULT, ENGINE, tmp_path, 3, seconds=(5.0, 10.0), seconds_limit=1.0)
    (material,) = study_materials(1, 3)
    alone = cells_of(plan, read_model_file(DEFAULT), material, lambda: None)
    (made,) = with_trained(plan, [material], [alone], lambda: None)
    wanted = {f"{row} {seconds:g}" for row in ROWS for seconds in (5.0, 10.0)}
    assert set(made["rows"]) == wanted | {"sketch 10", "draft 10", OTHER_DRAW}
    assert all(len(cells) == 6 for cells in made["rows"].values())
    assert all(np.isfinite(value) for cells in made["rows"].values() for each in cells for value in each.values())
    assert (tmp_path / "unseen-01-10.haptomaterial").exists()
    assert made["notes"]["ribs"] == {"5": [0, 0], "10": [0, 0]}


def test_a_surface_in_the_published_form_has_the_level_and_the_spectrum_of_its_law() -> None:
    surface = filtered_surfaces(2, 2026)[1]
    for speed, force in ((0.03, 0.5), (0.15, 1.6)):
        motion = np.column_stack([np.full(60_000, speed), np.zeros(60_000), np.full(60_000, force)])
        wave = surface.wave(motion, 1)
        x, y = conditions(motion[:1])
        predictor, drive = surface.filter_at(float(x[0]), float(y[0]))
        hertz, response = freqz([drive], [1.0, *predictor], 4096, fs=2000.0)
        power, heard = np.abs(response) ** 2, hertz > 10.0
        level = float(np.exp(surface.log_level(x, y)[0]))
        assert np.std(wave) == pytest.approx(level * float(np.sqrt(power[heard].sum() / power.sum())), rel=0.06)
        found_hertz, found = welch(wave, 2000.0, nperseg=256)
        band = (found_hertz > 30.0) & (found_hertz < 900.0)
        expected = np.interp(found_hertz[band], hertz, power) * level**2
        assert np.std(np.log(found[band] / expected)) < 0.2
    assert not np.allclose(surface.filter_at(-1.0, 0.0)[0], surface.filter_at(1.0, 0.0)[0], atol=0.05)
    assert filtered_surfaces(2, 2026)[0].label == "filtered-01"


@pytest.mark.parametrize(
    ("option", "name", "said"),
    [
        ("--page", "gone.md", "gone.md: cannot be read"),
        ("--page", "plain.md", "plain.md: the page has no `<!-- measured: begin"),
        ("--page", "folder", "folder: cannot be read"),
        ("--results", "plain.md/few-shot.json", "few-shot.json: cannot be written (File exists)"),
        ("--results", "folder", "folder: cannot be written (Is a directory)"),
        ("--chart", "plain.md/few-shot.png", "few-shot.png: cannot be written (File exists)"),
    ],
)
def test_an_unwritable_place_is_reported_in_one_line_before_anything_is_fitted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], option: str, name: str, said: str
) -> None:
    (tmp_path / "plain.md").write_text("# Page\n", encoding="utf-8")
    (tmp_path / "folder").mkdir()
    work = tmp_path / "work"
    words = {"--model": DEFAULT, "--engine": ENGINE, "--results": tmp_path / "few-shot.json", "--work": work} | {option: tmp_path / name}
    assert main(["few-shot", *(str(word) for pair in words.items() for word in pair)]) == 3
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not work.exists() and not (tmp_path / "few-shot.json").exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "plain.md"]


def test_the_published_table_is_that_of_the_published_results() -> None:
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    page = TABLES.read_text(encoding="utf-8")
    assert len(results["materials"]) >= 10
    assert with_measured_words(page, page_words(results, "../../../Documentation~/images/few-shot.png")) == page


FLAT = LevelTable((0.1,), (0.0,), 1.0, 0.0, 0.0)


def motion_of(speed_mps: np.ndarray, force_newtons: float | np.ndarray = 1.0) -> np.ndarray:
    force = np.broadcast_to(force_newtons, speed_mps.shape)
    return np.stack([speed_mps, np.zeros_like(speed_mps), force], axis=1).astype(np.float32)


def recorded(wave: np.ndarray, motion: np.ndarray) -> MaterialRecording:
    return MaterialRecording(wave.astype(np.float32), motion)


def swept(seconds: float, low: float = 0.02, high: float = 0.2, period: float = 2.5) -> np.ndarray:
    time = np.arange(int(2000 * seconds)) / 2000.0
    return np.exp(np.interp(np.sin(2.0 * np.pi * time / period), [-1.0, 1.0], np.log([low, high])))


def test_the_autoregressive_rival_recovers_an_autoregressive_spectrum() -> None:
    rng = np.random.default_rng(12)
    speed = swept(10.0)
    wave = lfilter([1.0], [1.0, -1.6, 0.9], rng.standard_normal(len(speed)))
    wave /= np.sqrt(np.mean(wave**2))
    rival = fit_autoregressive([recorded(wave, motion_of(speed))], FLAT, 3)
    assert len(rival.filters) == 3
    made = rival.render(motion_of(np.full(20000, 0.06)), 1)
    assert np.sqrt(np.mean(made**2)) == pytest.approx(1.0, abs=0.15)
    ratio = 10.0 * np.log10(power_spectrum(made, 256)[3:100] / power_spectrum(wave, 256)[3:100])
    assert np.sqrt(np.mean(ratio**2)) < 1.0
