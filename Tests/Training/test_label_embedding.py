"""Labels and their specimens as embeddings, and the phases of a surface at a place."""

from __future__ import annotations

import torch

from haptoflow_training.models.label_embedding import LabelEmbedding, surface_phases

RIBS = [((0.8, 0.0), (0.0, 0.5)), ()]


def _with_specimens() -> LabelEmbedding:
    torch.manual_seed(3)
    embedding = LabelEmbedding(64, RIBS, specimens=5)
    assert embedding.pieces is not None
    with torch.no_grad():
        embedding.pieces.normal_()
    return embedding


def test_the_offsets_of_a_label_s_specimens_add_up_to_zero_and_differ() -> None:
    embedding = _with_specimens()
    torch.testing.assert_close(embedding.offsets.sum(dim=1), torch.zeros(2, 60), rtol=0.0, atol=1e-5)
    of_specimens = torch.stack([embedding(torch.tensor([1]), torch.tensor([number]))[0] for number in range(5)])
    torch.testing.assert_close(of_specimens.mean(dim=0), embedding(torch.tensor([1]))[0])
    assert of_specimens.std(dim=0)[:60].min() > 1e-3


def test_an_unknown_specimen_gives_the_label_itself_and_a_known_one_keeps_the_wave_vectors() -> None:
    embedding = _with_specimens()
    label, specimen = torch.tensor([0, 0, 1]), torch.tensor([-1, 2, -1])
    made = embedding(label, specimen)
    torch.testing.assert_close(made[[0, 2]], embedding(label)[[0, 2]], rtol=0.0, atol=0.0)
    assert (made[1] - embedding(label)[1]).abs().max() > 0.01
    torch.testing.assert_close(made[:, -4:], embedding(label)[:, -4:], rtol=0.0, atol=0.0)
    torch.testing.assert_close(embedding(label), embedding.weight[label])


def _phases(position_mm: tuple[float, float], wander: tuple[float, ...] = (0.0,) * 6) -> list[float]:
    embedding = LabelEmbedding(64, RIBS)(torch.tensor([0]))
    motion = torch.tensor([[0.1, -0.2, 1.0]])
    return surface_phases(embedding, motion, torch.tensor([position_mm]), torch.tensor([wander]))[0].tolist()


def _same(one: list[float], other: list[float]) -> None:
    torch.testing.assert_close(torch.tensor(one), torch.tensor(other), rtol=0.0, atol=2e-3)


def test_phases_are_the_fraction_of_the_ribs_crossed_and_the_rates_k_times_v_with_their_sign() -> None:
    # 0.8 ribs a millimetre along x at 100 mm/s, 0.5 along y at -200 mm/s; stick-slip has no place.
    _same(_phases((1.5, 0.5)), [0.2, 0.25, 0.0, 80.0, -100.0, 0.0])


def test_wander_displaces_the_ribs_and_is_all_there_is_of_stick_and_slip() -> None:
    _same(
        _phases((1.5, 0.5), (0.3, -0.5, 0.7, 4.0, -6.0, 42.0)),
        [0.5, 0.75, 0.7, 84.0, -106.0, 42.0],
    )
