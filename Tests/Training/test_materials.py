"""The twenty materials: their file, its errors, and the published statistics their targets must lie in."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.synthetic import load_materials
from haptoflow_training.recordings.synthetic.materials import (
    DEFAULT_MATERIALS_PATH,
    Calibrated,
    select_materials,
    write_calibrated,
)

_WORDS = (
    "wood plywood stone concrete brick ceramic glass metal|metal mesh|plastic rubber leather cotton corduroy "
    "jute fur paper cardboard sandpaper carpet"
)
LABELS = [label for part in _WORDS.split("|") for label in ([part] if part == "metal mesh" else part.split())]


def test_the_labels_are_the_twenty_in_their_order():
    materials = load_materials()
    assert [material.label for material in materials] == LABELS
    assert [material.texture_id for material in materials] == list(range(20))


def test_targets_lie_between_the_5th_and_95th_published_percentile():
    for material in load_materials():
        targets = material.targets
        assert 0.25 <= targets.k <= 3.99, material.label
        assert 0.25 <= targets.p <= 1.58, material.label
        assert -0.14 <= targets.q <= 0.78, material.label
        assert 64.0 <= targets.centroid_hz <= 195.0, material.label
        assert -14.2 <= targets.slope_db_per_octave <= -2.4, material.label


def test_any_two_materials_differ_by_more_than_the_perception_threshold():
    materials = load_materials()
    for first in range(20):
        for second in range(first):
            one, other = materials[first].targets, materials[second].targets
            level_db = abs(20 * np.log10(one.k / other.k))
            centroid = abs(np.log(one.centroid_hz / other.centroid_hz)) / np.log(1.18)
            slope_db = abs(one.slope_db_per_octave - other.slope_db_per_octave)
            assert max(level_db / 2.2, centroid, slope_db / 2.0) > 0.7, (
                materials[first].label,
                materials[second].label,
            )


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
