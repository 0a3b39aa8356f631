"""The touch-down vibration of each material: stiffer is higher and bounces more, within the format's limits."""

from __future__ import annotations

import dataclasses

import pytest

from haptoflow_training.recordings.landing import landing_of, landing_of_spring
from haptoflow_training.recordings.synthetic import Material, load_materials

MATERIALS = {material.label: material for material in load_materials()}


def test_rubber_wood_and_stone_ring_in_the_order_of_their_stiffness() -> None:
    landings = [landing_of(MATERIALS[label]) for label in ("rubber", "wood", "stone")]
    frequencies = [landing.modes[0].frequency_hz for landing in landings]
    assert frequencies == sorted(frequencies) and frequencies[2] > 3.0 * frequencies[0]
    restitutions = [landing.restitution for landing in landings]
    assert restitutions == sorted(restitutions) and restitutions[2] > restitutions[0]


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
