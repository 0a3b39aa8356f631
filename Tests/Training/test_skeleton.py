"""The skeleton: noise through a filter that continues the past, a drive that swings with the ribs, lines, impulses."""

from __future__ import annotations

import math

import pytest
import torch

from haptoflow_training.models.all_pole_filter import PredictedFilter
from haptoflow_training.models.level_model import PREVIOUS_LIMIT, LevelModel
from haptoflow_training.models.refiner import ENTERING, Refiner
from haptoflow_training.models.skeleton import (
    LINE_HARMONICS,
    ORDER,
    OUTPUTS,
    RUNG_GAINS,
    SWING_HARMONICS,
    Skeleton,
    SkeletonGains,
)
from haptoflow_training.models.skeleton_model import SkeletonModel
from haptoflow_training.models.surface_waves import FAMILIES, SurfaceWaves, advanced

SKELETON = Skeleton(hidden=16).eval().requires_grad_(False)
# Mild resonances, at level 1.
RAW = torch.tensor([[0.9, -0.7, 0.3, 0.2, -0.25] + [0.0] * (ORDER - 5) + [0.0]])
COSINE, SINE = 0, 1


def _gains(raw: torch.Tensor = RAW) -> SkeletonGains:
    """Of the filter alone."""
    return SkeletonGains(
        *PredictedFilter(ORDER)(raw),
        torch.zeros(1, FAMILIES, 2, SWING_HARMONICS, 1),
        torch.zeros(1, FAMILIES, 2, LINE_HARMONICS, 1),
        torch.zeros(1, RUNG_GAINS),
    )


def _with_ribs(seed: int) -> SkeletonGains:
    generator, gains = torch.Generator().manual_seed(seed), _gains()
    return gains._replace(
        swing=torch.randn(gains.swing.shape, generator=generator),
        lines=torch.randn(gains.lines.shape, generator=generator),
    )


def _nothing() -> SkeletonGains:
    """No filter, so that noise passes as it is."""
    return _gains(torch.zeros(1, ORDER + 1))


def _noise(rows: int, seed: int, samples: int = 200) -> torch.Tensor:
    return torch.randn(rows, 1, samples, generator=torch.Generator().manual_seed(seed))


def _phases(rates_hz: tuple[float, float, float], turns: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> torch.Tensor:
    return torch.tensor([[*turns, *rates_hz]])


def test_without_ribs_and_rungs_its_power_is_1_in_the_long_run() -> None:
    gains, still, previous = _gains(), _phases((0.0, 0.0, 0.0)).expand(64, 6), torch.zeros(64, 1, 200)
    powers = []
    for hop in range(40):
        begun = SKELETON.parts(_noise(64, hop), previous, gains, still).begun[:, :, :28]
        previous = torch.cat([previous[:, :, 28:], begun], dim=2)
        powers.append(begun.square().mean().item())
    assert sum(powers[10:]) / 30.0 == pytest.approx(1.0, rel=0.05)


@pytest.mark.parametrize("later", [1, 27, 150])
def test_a_segment_begun_later_says_the_same_of_the_same_samples(later: int) -> None:
    gains, phases = _with_ribs(2), _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4))
    previous, noise = _noise(1, 3), _noise(1, 4)
    first = SKELETON.parts(noise, previous, gains, phases).begun
    second = SKELETON.parts(
        torch.cat([noise[:, :, later:], _noise(1, 5, later)], dim=2),
        torch.cat([previous[:, :, later:], first[:, :, :later]], dim=2),
        gains,
        advanced(phases, later),
    ).begun
    torch.testing.assert_close(second[:, :, : 200 - later], first[:, :, later:], rtol=0.0, atol=5e-3)
    assert first.square().mean() > 0.5


def _line(gains: SkeletonGains, phases: torch.Tensor) -> torch.Tensor:
    """[200]: the lines alone."""
    silence = torch.zeros(1, 1, 200)
    # The past is the line, too, as it would be after a while.
    before = SKELETON._lines(gains, phases)[:, :ORDER]
    previous = torch.cat([silence[:, 0, ORDER:], before], dim=1).unsqueeze(1)
    return SKELETON.parts(silence, previous, gains, phases).begun[0, 0]


def test_lines_are_fixed_to_the_place_in_every_pass_and_met_backwards_on_the_way_back() -> None:
    gains = _gains()
    gains.lines[0, 0, COSINE, :4, 0] = torch.tensor([0.8, -0.5, 0.3, 0.2])
    first = _line(gains, _phases((40.0, 0.0, 0.0), (0.3, 0.0, 0.0)))
    # The segments of another pass begin elsewhere: here 27 samples further on and whole ribs later.
    again = _line(gains, _phases((40.0, 0.0, 0.0), (5.3 + 40.0 * 27.0 / 2000.0, 0.0, 0.0)))
    torch.testing.assert_close(again[:173], first[27:], rtol=0.0, atol=2e-3)
    end = 0.3 + 40.0 * 200.0 / 2000.0
    back = _line(gains, _phases((-40.0, 0.0, 0.0), (end, 0.0, 0.0)))
    torch.testing.assert_close(back, torch.flip(first, [0]), rtol=0.0, atol=2e-3)
    assert first.square().mean() > 0.3


def test_a_line_s_sine_lies_behind_the_rib_whichever_way_the_tip_moves() -> None:
    gains = _gains()
    gains.lines[0, 1, SINE, 0, 0] = 0.7
    there = _line(gains, _phases((0.0, 50.0, 0.0)))
    back = _line(gains, _phases((0.0, -50.0, 0.0)))
    torch.testing.assert_close(there, back, rtol=0.0, atol=1e-4)
    # A quarter turn of 50 Hz is 10 ms: there the sine is largest.
    assert there.argmax().item() == pytest.approx(9.5, abs=1.0)


def test_the_filter_does_not_continue_the_lines_of_the_past() -> None:
    gains, phases = _with_ribs(6)._replace(swing=_gains().swing), _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4))
    silence = torch.zeros(1, 1, 200)
    alone = SKELETON._lines(gains, phases)
    torch.testing.assert_close(_line(gains, phases), alone[0, ORDER:], rtol=0.0, atol=1e-4)
    from_silence = SKELETON.parts(silence, silence, gains, phases).begun[0, 0]
    assert (from_silence - alone[0, ORDER:])[:10].abs().max() > 0.05, "a past without the lines is something else"


def test_the_swing_modulates_the_drive_within_its_limit() -> None:
    gains, phases, noise = _nothing(), _phases((40.0, 0.0, 0.0), (0.2, 0.0, 0.0)), _noise(1, 7)
    still = SKELETON.parts(noise, torch.zeros(1, 1, 200), gains, phases).begun
    torch.testing.assert_close(still, noise)
    angle = 2.0 * math.pi * (0.2 + 40.0 * (torch.arange(200) + 0.5) / 2000.0)
    for size in (0.5, 1.5, 40.0):
        gains.swing[0, 0, COSINE, 0, 0], gains.swing[0, 0, SINE, 1, 0] = size, -0.5 * size
        swing = 2.0 * torch.tanh(0.5 * size * (angle.cos() - 0.5 * (2.0 * angle).sin()))
        made = SKELETON.parts(noise, torch.zeros(1, 1, 200), gains, phases).begun
        expected = (noise[0, 0] * swing.exp()).clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT)
        torch.testing.assert_close(made[0, 0], expected, rtol=2e-3, atol=1e-3)
        assert swing.abs().max() <= 2.0


def test_a_loud_past_is_bounded() -> None:
    raw = torch.full((1, ORDER + 1), 30.0)
    made = SKELETON.parts(_noise(1, 8), 1000.0 * _noise(1, 9), _gains(raw), _phases((0.0, 0.0, 0.0))).begun
    assert torch.isfinite(made).all() and made.abs().max() <= PREVIOUS_LIMIT


def _own_condition() -> tuple[torch.Tensor, torch.Tensor]:
    return torch.randn(2, 64, generator=torch.Generator().manual_seed(10)), torch.tensor([[0.1, 0.0, 1.0]] * 2)


def test_an_untrained_skeleton_has_a_filter_and_neither_swing_lines_nor_rungs() -> None:
    gains = Skeleton(hidden=16).gains(*_own_condition())
    assert gains.coefficients.abs().max() > 0.0
    assert all(part.abs().max() == 0.0 for part in (gains.swing, gains.lines, gains.rungs))


def test_predicted_lines_and_rungs_are_limited() -> None:
    skeleton = Skeleton(hidden=16)
    with torch.no_grad():
        skeleton.perceptron.layers[-1].bias.fill_(1000.0)
        gains = skeleton.gains(*_own_condition())
    assert gains.lines.abs().max() == pytest.approx(3.0) and gains.rungs.abs().max() == pytest.approx(8.0)


def test_the_waveform_trains_lines_swing_and_rungs_and_only_the_likelihood_trains_the_filter() -> None:
    skeleton, filtering = Skeleton(hidden=16), OUTPUTS[0]
    phases = _phases((40.0, 25.0, 66.0)).expand(2, 6)
    weight = skeleton.perceptron.layers[-1].weight
    parts = skeleton.parts(2.0 * _noise(2, 11), _noise(2, 12), skeleton.gains(*_own_condition()), phases)
    (weighed,) = torch.autograd.grad(parts.begun.square().sum(), weight)
    assert weighed[:filtering].abs().max() == 0.0
    swing, lines, rungs = weighed[filtering:].split(OUTPUTS[1:])
    assert all(part.abs().max() > 0.0 for part in (swing, lines, rungs))
    likelihood = skeleton.likelihood(_noise(2, 13), skeleton.gains(*_own_condition()), phases)
    (weighed,) = torch.autograd.grad(likelihood.sum(), weight)
    assert weighed[:filtering].abs().max() > 0.0


def _recorded(gains: SkeletonGains, phases: torch.Tensor, rows: int) -> torch.Tensor:
    """Segments of the skeleton, [rows, 1, 200]."""
    earlier = advanced(phases, -200).expand(rows, 6)
    past = SKELETON.parts(_noise(rows, 20), _noise(rows, 21), gains, earlier).begun
    return SKELETON.parts(_noise(rows, 22), past, gains, phases.expand(rows, 6)).begun


def test_the_likelihood_is_best_at_the_true_filter_level_and_swing() -> None:
    phases, true = _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4)), _with_ribs(2)
    segment = _recorded(true, phases, 128)

    def likelihood(gains: SkeletonGains) -> float:
        return SKELETON.likelihood(segment, gains, phases.expand(128, 6)).mean().item()

    best = likelihood(true)
    other = _gains(RAW + 0.15 * torch.randn(RAW.shape, generator=torch.Generator().manual_seed(1)))
    wrong = {
        "filter": true._replace(coefficients=other.coefficients),
        "louder": true._replace(log_gain=true.log_gain + 0.1),
        "softer": true._replace(log_gain=true.log_gain - 0.1),
        "swing": true._replace(swing=torch.zeros_like(true.swing)),
        "lines": true._replace(lines=0.8 * true.lines),
    }
    for name, gains in wrong.items():
        assert likelihood(gains) > best + 0.003, name


def test_the_likelihood_ignores_the_lines() -> None:
    phases, gains = _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4)), _with_ribs(2)
    plain = gains._replace(lines=torch.zeros_like(gains.lines))
    segment, lines = _recorded(plain, phases, 4), SKELETON._lines(gains, phases)
    with_lines = SKELETON.likelihood(segment + lines[:, None, ORDER:], gains, phases.expand(4, 6))
    without = SKELETON.likelihood(segment, plain, phases.expand(4, 6))
    torch.testing.assert_close(with_lines, without, rtol=0.0, atol=1e-4)


def test_the_likelihood_does_not_depend_on_what_was_before_the_segment() -> None:
    phases, gains = _phases((0.0, 0.0, 0.0)), _gains()
    pasts = torch.zeros(16, 1, 200), 4.0 * _noise(16, 24)
    begun = [SKELETON.parts(_noise(16, 23), past, gains, phases.expand(16, 6)).begun for past in pasts]
    assert (begun[0] - begun[1]).abs().max() > 1.0
    silent, foreign = (SKELETON.likelihood(wave, gains, phases.expand(16, 6)) for wave in begun)
    torch.testing.assert_close(silent, foreign, rtol=0.0, atol=1e-4)


def _refined(*, trained: bool) -> tuple[SkeletonModel, SkeletonModel]:
    """A skeleton alone, and with a refinement over it."""
    torch.manual_seed(15)
    alone = SkeletonModel(wave_vectors=[(), ()], level=LevelModel(8), skeleton=Skeleton(16))
    torch.nn.init.normal_(alone.skeleton.perceptron.layers[-1].weight, std=0.2)
    refiner = Refiner(width=16, previous_width=8)
    if trained:
        torch.nn.init.normal_(refiner.leave.weight, std=0.2)
    refined = SkeletonModel(wave_vectors=[(), ()], level=alone.level, skeleton=alone.skeleton, refiner=refiner)
    return alone.eval().requires_grad_(False), refined.eval().requires_grad_(False)


def _given() -> tuple[torch.Tensor, ...]:
    phases = _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4)).expand(2, 6)
    return _noise(2, 16), _noise(2, 17), *_own_condition(), phases


def test_an_untrained_refinement_is_the_skeleton_and_a_trained_one_is_not() -> None:
    alone, untrained = _refined(trained=False)
    assert torch.equal(untrained.one_step(*_given()), alone.one_step(*_given()))
    alone, trained = _refined(trained=True)
    assert (trained.one_step(*_given()) - alone.one_step(*_given())).abs().max() > 0.01


def test_every_input_affects_the_refinement() -> None:
    _, model = _refined(trained=True)
    noise, previous, embedding, motion, phases = _given()
    parts = model.skeleton.parts(noise, previous, model.skeleton.gains(embedding, motion), phases)
    assert model.refiner is not None
    before = model.refiner(parts, previous, embedding, motion)
    changed = [model.refiner(parts._replace(**{name: getattr(parts, name) + 0.3}), previous, embedding, motion)
               for name in parts._fields]  # fmt: skip
    changed += [
        model.refiner(parts, previous + 0.3, embedding, motion),
        model.refiner(parts, previous, embedding + 0.3, motion),
        model.refiner(parts, previous, embedding, motion + 0.1),
    ]
    assert all(not torch.allclose(after, before, atol=1e-5) for after in changed)


def test_a_refinement_sees_segment_impulses_and_the_harmonics_of_all_families_added() -> None:
    _, model = _refined(trained=True)
    noise, previous, embedding, motion, phases = _given()
    parts = model.skeleton.parts(noise, previous, model.skeleton.gains(embedding, motion), phases)
    seen = Refiner.entering(parts)
    assert seen.shape == (2, ENTERING, 200)
    torch.testing.assert_close(seen[:, :2], torch.cat([parts.begun, parts.struck], dim=1))
    cosines, sines = SurfaceWaves(SWING_HARMONICS, 700.0)(phases)
    torch.testing.assert_close(seen[:, 2:], torch.cat([cosines.sum(dim=1), sines.sum(dim=1)], dim=1))
