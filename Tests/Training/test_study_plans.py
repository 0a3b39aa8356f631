"""Plans of the two user studies, and the golden file that the Unity package reads too."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.studies.plans import SplitMix64, latency_plan, similarity_plan, williams_design

GOLDEN = Path(__file__).parents[1] / "Golden" / "studies" / "plans.json"
LEVELS = [float(level) for level in range(50, 251, 20)]
MATERIALS = ["ceramic", "jute", "wood", "plastic", "fur", "metal"]
METHODS = ["haptoflow", "transformer", "dstn", "spsi"]


def test_the_generator_gives_the_published_values_of_splitmix64() -> None:
    random = SplitMix64(1234567)
    assert [random.next() for _ in range(5)] == [
        6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431, 16408922859458223821,
    ]  # fmt: skip


@pytest.mark.parametrize("count", range(1, 13))
def test_in_a_williams_design_each_treatment_has_each_place_and_follows_each_other_equally_often(count: int) -> None:
    rows = williams_design(count)
    assert len(rows) == (1 if count == 1 else count if count % 2 == 0 else 2 * count)
    for place in range(count):
        assert set(Counter(row[place] for row in rows).values()) == {len(rows) // count}
    pairs = Counter(pair for row in rows for pair in zip(row, row[1:]))
    assert len(pairs) == count * (count - 1) and len(set(pairs.values())) <= 1


@pytest.mark.parametrize("participant", range(1, 25))
def test_every_participant_gets_every_level_once_under_each_condition_after_four_practice_trials(
    participant: int,
) -> None:
    plan = latency_plan(participant, 3, LEVELS)
    assert [trial.trial for trial in plan] == list(range(1, 27))
    practice, first, second = plan[:4], plan[4:15], plan[15:]
    order = ["turn-on", "turn-off"] if participant % 2 else ["turn-off", "turn-on"]
    assert [(trial.condition, trial.delay_ms) for trial in practice] == [
        (order[0], 50.0), (order[0], 250.0), (order[1], 50.0), (order[1], 250.0),
    ]  # fmt: skip
    for block, condition in ((first, order[0]), (second, order[1])):
        assert {trial.condition for trial in block} == {condition}
        assert sorted(trial.delay_ms for trial in block) == LEVELS
    assert [trial.block for trial in plan] == ["practice"] * 4 + ["main"] * 22


@pytest.mark.parametrize("participant", range(1, 25))
def test_every_participant_rates_every_method_once_on_every_material_one_material_after_another(
    participant: int,
) -> None:
    plan = similarity_plan(participant, 3, MATERIALS, METHODS)
    assert [(trial.block, trial.material, trial.method) for trial in plan[:4]] == [
        ("practice", "ceramic", method) for method in METHODS
    ]
    main_trials = plan[4:]
    assert {trial.block for trial in main_trials} == {"main"}
    for begin in range(0, 24, 4):
        assert len({trial.material for trial in main_trials[begin : begin + 4]}) == 1
    assert len({(trial.material, trial.method) for trial in main_trials}) == 24


def test_over_24_participants_each_method_stands_six_times_at_each_place_of_each_material() -> None:
    places = Counter()
    for participant in range(1, 25):
        trials = [trial for trial in similarity_plan(participant, 9, MATERIALS, METHODS) if trial.block == "main"]
        places.update((trial.material, trial.method, place % 4) for place, trial in enumerate(trials))
    assert set(places.values()) == {6} and len(places) == 6 * 4 * 4


def test_the_committed_golden_plans_are_what_the_command_writes(tmp_path: Path) -> None:
    assert main(["study", "golden", "--out", str(tmp_path / "plans.json")]) == 0
    assert (tmp_path / "plans.json").read_bytes() == GOLDEN.read_bytes()
    golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
    assert {case["participant"] for case in golden["latency"]} == {1, 2, 7, 24}
    assert {len(case["levels_ms"]) for case in golden["latency"]} == {11, 4}
    assert {(len(case["materials"]), len(case["methods"])) for case in golden["similarity"]} == {(6, 4), (3, 3), (2, 6)}
    assert {case["seed"] for case in golden["similarity"]} == {1, 2**63 + 5}
