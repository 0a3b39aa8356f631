"""Measuring the recorder against its published targets, and the commands that record and report."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from haptoflow_training.cli import main
from haptoflow_training.recordings.synthetic import TRAINING_SPECIMENS, load_materials
from haptoflow_training.recordings.synthetic.measurement import (
    TOLERANCE, Design, Deviation, SpreadMeasurement, calibrate, measure, measure_spread
)
from haptoflow_training.recordings.synthetic.materials import DEFAULT_MATERIALS_PATH, Targets

MATERIALS = {material.label: material for material in load_materials()}
# From 20 mm/s like the report: at lower speeds ribs are met at less than 20 Hz, which bends a ruled label's level law.
SMALL = Design(
    speeds_mmps=(20.0, 80.0, 200.0),
    forces_newtons=(0.5, 1.0, 2.0),
    directions_degrees=(0.0, 45.0, 90.0, 135.0),
    duration_seconds=1.3,
    reference_repeats=2,
    fast_speeds_mmps=(),
)


def test_a_deviation_passes_only_within_every_tolerance():
    targets = Targets(1.0, 1.0, 0.2, 100.0, -8.0)
    assert Deviation.of(targets, targets).passes()
    for wrong in (
        Targets(1.25, 1.0, 0.2, 100.0, -8.0),
        Targets(1.0, 1.2, 0.2, 100.0, -8.0),
        Targets(1.0, 1.0, 0.4, 100.0, -8.0),
        Targets(1.0, 1.0, 0.2, 120.0, -8.0),
        Targets(1.0, 1.0, 0.2, 100.0, -10.5),
    ):
        assert not Deviation.of(wrong, targets).passes()
    assert (TOLERANCE.level_db, TOLERANCE.p, TOLERANCE.q) == (1.5, 0.15, 0.15)


@pytest.mark.parametrize("label", ["glass", "metal mesh", "carpet"])
def test_a_material_measured_afresh_meets_its_targets(label):
    measured = measure(MATERIALS[label], seed=31, design=SMALL)
    deviation = Deviation.of(measured.targets(), MATERIALS[label].targets)
    assert deviation.passes(), deviation


@pytest.mark.long(
    because="dozens of recordings are simulated at every speed; the targets of single materials are tested by "
    "test_a_material_measured_afresh_meets_its_targets"
)
def test_the_pooled_centroid_grows_with_speed_as_in_published_textures_and_beyond():
    """About v^0.15 in the published statistics; with a fixed contact it is v^0.005 beyond 200 mm/s."""
    design = Design(
        speeds_mmps=(20.0, 200.0),
        forces_newtons=(1.0,),
        directions_degrees=(0.0, 45.0, 90.0),
        duration_seconds=1.1,
        reference_repeats=1,
        fast_speeds_mmps=(1500.0,),
    )
    found = [measure(material, seed=31, design=design) for material in MATERIALS.values()]
    assert 0.10 < np.mean([each.centroid_exponent for each in found]) < 0.20
    assert 0.05 < np.mean([each.fast_centroid_exponent for each in found]) < 0.15
    moving = [each.centroid_exponent > 0.04 for each in found]
    assert all(moving), "a label whose centroid stays is one filter at every speed"


def test_calibration_restores_a_detuned_material():
    ceramic = MATERIALS["ceramic"]
    design = replace(SMALL, speeds_mmps=(20.0, 200.0), forces_newtons=(0.5, 2.0), directions_degrees=(0.0, 90.0))
    wrong = ceramic.with_calibrated(
        height_micrometres=3.0 * ceramic.calibrated.height_micrometres,
        height_exponent=ceramic.calibrated.height_exponent + 0.7,
        force_exponent=ceramic.calibrated.force_exponent - 0.4,
        absorption_db_per_octave=ceramic.calibrated.absorption_db_per_octave + 3.0,
    )
    before = Deviation.of(measure(wrong, seed=7, design=design).targets(), ceramic.targets)
    _, measured = calibrate(wrong, seed=7, design=design, rounds=3)
    assert not before.passes()
    assert Deviation.of(measured.targets(), ceramic.targets).passes()


def test_the_report_names_a_material_that_misses_its_target_and_writes_table_numbers_and_picture(
    tmp_path, monkeypatch, capsys
):
    from haptoflow_training.commands import report_recorder

    monkeypatch.setattr(report_recorder, "_measure", lambda each: (measure(each, seed=31, design=_TINY), SPREAD))
    monkeypatch.setattr(report_recorder, "ProcessPoolExecutor", _SameProcess)
    path = tmp_path / "materials.toml"
    text = DEFAULT_MATERIALS_PATH.read_text()
    path.write_text(text.replace("k = 0.28, p = 0.7", "k = 1.5, p = 0.7"))
    out = tmp_path / "report"
    words = ["report-recorder", "--materials", str(path), "--labels", "glass,metal", "--out", str(out)]
    assert main(words) == 3
    message = capsys.readouterr().err
    assert "glass" in message and "metal" not in message.split("materials.toml:")[1]
    document = json.loads((out / "recorder-report.json").read_text())
    assert [entry["label"] for entry in document["materials"]] == ["glass", "metal"]
    exponents = [entry["centroid_exponent"] for entry in document["materials"]]
    assert document["pooled_centroid_exponent"] == pytest.approx(np.mean(exponents))
    assert document["pooled_fast_centroid_exponent"] is not None
    assert f"v^{np.mean(exponents):.2f}" in (out / "recorder-report.md").read_text()
    assert document["materials"][0]["passes"] is False and document["materials"][1]["passes"] is True
    assert "| metal |" in (out / "recorder-report.md").read_text()
    assert document["materials"][0]["spread"]["specimen_db"] == 1.4
    assert "| metal | 1.40 (0.75) | 0.40 (0.2) | 0.60 | +0.10 |" in (out / "recorder-report.md").read_text()
    assert (out / "images" / "recorder-spectra.png").read_bytes().startswith(b"\x89PNG")


def test_the_measured_spread_of_specimens_is_what_the_material_states():
    label = "glass"
    found = measure_spread(MATERIALS[label], seed=5, design=replace(SMALL, duration_seconds=1.8, reference_repeats=2))
    assert found.specimen_db == pytest.approx(MATERIALS[label].specimen_spread_db, rel=0.2)
    assert found.specimen_slope_db_per_octave == pytest.approx(MATERIALS[label].specimen_tilt_db_per_octave, rel=0.4)
    assert found.mean_db == pytest.approx(0.0, abs=0.3)
    plain = measure_spread(MATERIALS[label].without_spread, seed=5, design=replace(SMALL, directions_degrees=(0.0,)))
    assert plain.specimen_db < 0.25


SPREAD = SpreadMeasurement(1.4, 0.4, 0.6, 0.1)
_TINY = Design((50.0, 200.0), (0.5, 2.0), (0.0, 45.0, 90.0, 135.0), 1.2, 2, (800.0,))


class _SameProcess:
    def __init__(self, workers):
        self.map = map

    def __enter__(self):
        return self

    def __exit__(self, *error):
        return None


def test_record_writes_a_data_set_that_says_it_is_synthetic_and_completes_an_unfinished_one(tmp_path, capsys):
    words = ["record", "--protocol", "hand", "--labels", "wood,paper", "--recordings-per-label", "2"]
    words += ["--duration-seconds", "2", "--jobs", "2", "--seed", "4"]
    assert main([*words, "--out", str(tmp_path / "a")]) == 0
    provenance = json.loads((tmp_path / "a" / "provenance.json").read_text())
    assert provenance["synthetic"] is True and provenance["seed"] == 4
    assert provenance["specimens"] == list(TRAINING_SPECIMENS)
    assert (tmp_path / "a" / "texture_list.xlsx").is_file()
    files = sorted((tmp_path / "a" / "sensor_data" / "accel").glob("*_hand_*.csv"))
    assert len(files) == 4 and {each.name.split("_")[0] for each in files} == {"0", "16"}

    shutil.copytree(tmp_path / "a", tmp_path / "b")
    lost = tmp_path / "b" / "sensor_data" / "force" / files[1].name
    lost.unlink()
    kept = tmp_path / "b" / "sensor_data" / "accel" / files[0].name
    kept.write_text("untouched")
    capsys.readouterr()
    assert main([*words, "--out", str(tmp_path / "b")]) == 0
    assert "3 of 4" in capsys.readouterr().out
    assert lost.read_bytes() == (tmp_path / "a" / "sensor_data" / "force" / files[1].name).read_bytes()
    assert kept.read_text() == "untouched"


def test_record_refuses_an_unknown_label_and_no_recordings(tmp_path, capsys):
    assert main(["record", "--out", str(tmp_path), "--labels", "marzipan"]) == 3
    assert "marzipan" in capsys.readouterr().err
    assert main(["record", "--out", str(tmp_path), "--recordings-per-label", "0"]) == 3
    assert "--recordings-per-label" in capsys.readouterr().err
