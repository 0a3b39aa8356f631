"""The skeleton: noise that swings with the ribs, lines and impulses drive a filter that continues the past."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
import scipy.signal
import torch

from haptoflow_training.models.all_pole_filter import PredictedFilter, burg_reflection
from haptoflow_training.models.level_model import PREVIOUS_LIMIT, LevelModel
from haptoflow_training.models.refiner import ENTERING, Refiner
from haptoflow_training.models.skeleton import (
    LINE_HARMONICS, ORDER, OUTPUTS, IMPULSE_GAINS, SWING_HARMONICS, Skeleton, SkeletonGains
)
from haptoflow_training.models.haptoflow_model import SkeletonModel
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
        torch.zeros(1, IMPULSE_GAINS),
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
        segment = SKELETON.parts(_noise(64, hop), previous, gains, still).segment[:, :, :28]
        previous = torch.cat([previous[:, :, 28:], segment], dim=2)
        powers.append(segment.square().mean().item())
    assert sum(powers[10:]) / 30.0 == pytest.approx(1.0, rel=0.05)


@pytest.mark.parametrize("later", [1, 27, 150])
def test_a_segment_begun_later_says_the_same_of_the_same_samples(later: int) -> None:
    gains, phases = _with_ribs(2), _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4))
    previous, noise = _noise(1, 3), _noise(1, 4)
    first = SKELETON.parts(noise, previous, gains, phases).segment
    second = SKELETON.parts(
        torch.cat([noise[:, :, later:], _noise(1, 5, later)], dim=2),
        torch.cat([previous[:, :, later:], first[:, :, :later]], dim=2),
        gains,
        advanced(phases, later),
    ).segment
    torch.testing.assert_close(second[:, :, : 200 - later], first[:, :, later:], rtol=0.0, atol=5e-3)
    assert first.square().mean() > 0.5


def _line(gains: SkeletonGains, phases: torch.Tensor) -> torch.Tensor:
    """[200]: the lines alone."""
    silence = torch.zeros(1, 1, 200)
    return SKELETON.parts(silence, silence, gains, phases).segment[0, 0]


def test_lines_are_fixed_to_the_place_in_every_pass_and_met_backwards_on_the_way_back() -> None:
    gains = _nothing()
    gains.lines[0, 0, COSINE, :4, 0] = torch.tensor([0.8, -0.5, 0.3, 0.2])
    first = _line(gains, _phases((40.0, 0.0, 0.0), (0.3, 0.0, 0.0)))
    # The segments of another pass begin elsewhere: here 27 samples further on and whole ribs later.
    again = _line(gains, _phases((40.0, 0.0, 0.0), (5.3 + 40.0 * 27.0 / 2000.0, 0.0, 0.0)))
    torch.testing.assert_close(again[:173], first[27:], rtol=0.0, atol=2e-3)
    end = 0.3 + 40.0 * 200.0 / 2000.0
    back = _line(gains, _phases((-40.0, 0.0, 0.0), (end, 0.0, 0.0)))
    torch.testing.assert_close(back, torch.flip(first, [0]), rtol=0.0, atol=2e-3)
    assert first.square().mean() > 0.3


@pytest.mark.parametrize("rate_hz", [60.0, -60.0])
@pytest.mark.parametrize("order", [1, 3, 14])
def test_a_line_at_the_output_has_amplitude_and_phase_of_the_filter_s_frequency_response(
    rate_hz: float, order: int
) -> None:
    gains = _gains()
    gains.lines[0, 1, COSINE, order - 1, 0], gains.lines[0, 1, SINE, order - 1, 0] = 1.5, -0.7
    made, phases, silence = torch.zeros(1, 1, 200), _phases((0.0, rate_hz, 0.0), (0.0, 0.3, 0.0)), torch.zeros(1, 1, 200)
    for _ in range(4):
        # The last of these begins when what the filter did at first has faded.
        phases = advanced(phases, 200)
        made = SKELETON.parts(silence, made, gains, phases).segment
    frequency = order * 60.0 / 2000.0
    _, response = scipy.signal.freqz(1.0, np.concatenate([[1.0], gains.coefficients[0]]), worN=[2.0 * np.pi * frequency])
    ahead = math.copysign(phases[0, 1].item(), rate_hz) * order
    angle = 2.0 * np.pi * (ahead + frequency * (np.arange(200) + 0.5))
    driven = (1.5 + 0.7j) * np.exp(1j * angle)
    expected = gains.log_gain.exp().item() * (response[0] * driven).real
    assert np.abs(expected).max() > 0.1 and abs(np.angle(response[0])) > 0.05
    np.testing.assert_allclose(made[0, 0].numpy(), expected, atol=5e-3)


def test_the_impulses_drive_the_filter_beside_the_noise_and_relative_to_it() -> None:
    gains, phases = _gains(), _phases((0.0, 0.0, 0.0))
    noise, silence = _noise(1, 31).clamp(-1.9, 1.9), torch.zeros(1, 1, 200)
    noise[0, 0, 40] = 4.5
    gains.impulses[0, 0] = 0.2
    with_impulse = SKELETON.parts(noise, silence, gains, phases)
    without = SKELETON.parts(noise, silence, gains._replace(impulses=torch.zeros(1, IMPULSE_GAINS)), phases)
    assert with_impulse.impulses.nonzero()[:, 2].tolist() == [40]
    response = scipy.signal.lfilter([1.0], np.concatenate([[1.0], gains.coefficients[0]]), with_impulse.impulses[0, 0])
    difference = (with_impulse.segment - without.segment)[0, 0].numpy()
    np.testing.assert_allclose(difference, response, atol=1e-4)
    louder = SKELETON.parts(noise, silence, gains._replace(log_gain=gains.log_gain + math.log(2.0)), phases)
    torch.testing.assert_close(louder.impulses, 2.0 * with_impulse.impulses)


@pytest.fixture
def exact_skeleton() -> Iterator[Skeleton]:
    """In double precision, in which the same sum in another order differs by nothing."""
    torch.set_default_dtype(torch.float64)
    yield Skeleton(hidden=16).eval().requires_grad_(False)
    torch.set_default_dtype(torch.float32)


@pytest.mark.parametrize("bare", [True, False], ids=["impulses of one sample", "ringing impulses that have faded"])
def test_a_hand_over_with_the_same_noise_and_past_is_exact_although_lines_and_impulses_run(
    bare: bool, exact_skeleton: Skeleton
) -> None:
    later, generator = 90, torch.Generator().manual_seed(32)
    gains, phases = _with_ribs(2), _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4))
    impulses = torch.randn(1, 10, 13, generator=generator)
    noise = torch.randn(1, 1, 200, generator=generator)
    if bare:
        impulses[:, :, 1:] = 0.0
    else:
        noise[:, :, later - 64 : later] = noise[:, :, later - 64 : later].clamp(-1.9, 1.9)
    noise[0, 0, 10], noise[0, 0, 130] = 4.4, -3.7
    gains = SkeletonGains(*(part.double() for part in gains))
    gains = gains._replace(swing=0.3 * gains.swing, lines=0.2 * gains.lines, impulses=0.04 * impulses.flatten(1))
    phases = phases.double()
    previous = torch.randn(1, 1, 200, generator=generator)
    first = exact_skeleton.parts(noise, previous, gains, phases)
    second = exact_skeleton.parts(
        torch.cat([noise[:, :, later:], noise[:, :, :later]], dim=2),
        torch.cat([previous[:, :, later:], first.segment[:, :, :later]], dim=2),
        gains,
        advanced(phases, later),
    )
    assert first.impulses[:, :, :later].abs().max() > 0.05 and first.impulses[:, :, later:].abs().max() > 0.05
    assert first.segment.abs().max() < PREVIOUS_LIMIT
    torch.testing.assert_close(second.segment[:, :, : 200 - later], first.segment[:, :, later:], rtol=0.0, atol=1e-9)


def test_the_swing_modulates_the_drive_within_its_limit() -> None:
    gains, phases, noise = _nothing(), _phases((40.0, 0.0, 0.0), (0.2, 0.0, 0.0)), _noise(1, 7)
    still = SKELETON.parts(noise, torch.zeros(1, 1, 200), gains, phases).segment
    torch.testing.assert_close(still, noise)
    angle = 2.0 * math.pi * (0.2 + 40.0 * (torch.arange(200) + 0.5) / 2000.0)
    for size in (0.5, 1.5, 40.0):
        gains.swing[0, 0, COSINE, 0, 0], gains.swing[0, 0, SINE, 1, 0] = size, -0.5 * size
        swing = 2.0 * torch.tanh(0.5 * size * (angle.cos() - 0.5 * (2.0 * angle).sin()))
        made = SKELETON.parts(noise, torch.zeros(1, 1, 200), gains, phases).segment
        expected = (noise[0, 0] * swing.exp()).clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT)
        torch.testing.assert_close(made[0, 0], expected, rtol=2e-3, atol=1e-3)
        assert swing.abs().max() <= 2.0


STILL = _phases((0.0, 0.0, 0.0)).expand(2, 6)


def _own_condition() -> tuple[torch.Tensor, torch.Tensor]:
    return torch.randn(2, 64, generator=torch.Generator().manual_seed(10)), torch.tensor([[0.1, 0.0, 1.0]] * 2)


def test_an_untrained_skeleton_has_a_filter_and_neither_swing_lines_nor_rungs() -> None:
    gains = Skeleton(hidden=16).gains(*_own_condition(), STILL)
    assert gains.coefficients.abs().max() > 0.0
    assert all(part.abs().max() == 0.0 for part in (gains.swing, gains.lines, gains.impulses))


def test_the_waveform_trains_lines_swing_and_rungs_and_only_the_likelihood_trains_the_filter() -> None:
    skeleton, filtering = Skeleton(hidden=16), OUTPUTS[0]
    phases = _phases((40.0, 25.0, 66.0)).expand(2, 6)
    weight = skeleton.perceptron.layers[-1].weight
    parts = skeleton.parts(2.0 * _noise(2, 11), _noise(2, 12), skeleton.gains(*_own_condition(), phases), phases)
    (weighed,) = torch.autograd.grad(parts.segment.square().sum(), weight)
    assert weighed[:filtering].abs().max() == 0.0
    swing, lines, impulses = weighed[filtering:].split(OUTPUTS[1:])
    assert all(part.abs().max() > 0.0 for part in (swing, lines, impulses))
    likelihood = skeleton.likelihood(_noise(2, 13), skeleton.gains(*_own_condition(), phases), phases)
    (weighed,) = torch.autograd.grad(likelihood.sum(), weight)
    assert weighed[:filtering].abs().max() > 0.0


def _recorded(gains: SkeletonGains, phases: torch.Tensor, rows: int) -> torch.Tensor:
    """Segments of the skeleton, [rows, 1, 200]."""
    earlier = advanced(phases, -200).expand(rows, 6)
    past = SKELETON.parts(_noise(rows, 20), _noise(rows, 21), gains, earlier).segment
    return SKELETON.parts(_noise(rows, 22), past, gains, phases.expand(rows, 6)).segment


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


def test_lines_in_a_recording_do_not_count_as_errors_of_prediction() -> None:
    phases, gains = _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4)), _with_ribs(2)
    gains, plain = (gains._replace(swing=0.3 * gains.swing, lines=share * gains.lines) for share in (0.2, 0.0))
    many = phases.expand(4, 6)
    with_lines, without = (SKELETON.parts(_noise(4, 22), _noise(4, 21), each, many).segment for each in (gains, plain))
    assert (with_lines - without).abs().max() > 0.5 and with_lines.abs().max() < PREVIOUS_LIMIT
    found = SKELETON.likelihood(with_lines, gains, many)
    torch.testing.assert_close(found, SKELETON.likelihood(without, plain, many), rtol=0.0, atol=1e-4)
    assert (SKELETON.likelihood(with_lines, plain, many) > found + 0.1).all()


def test_the_distance_of_a_filter_is_zero_at_burg_s_estimate_and_the_level_of_unit_scale_and_no_other() -> None:
    skeleton, segment = Skeleton(hidden=16).requires_grad_(False), _noise(2, 33)
    given = segment, *_own_condition(), _phases((0.0, 0.0, 0.0)).expand(2, 6)
    last = skeleton.perceptron.layers[-1]
    last.weight.zero_()
    last.bias.zero_()
    last.bias[:ORDER] = torch.atanh(burg_reflection(segment[:1, 0], ORDER)[0])
    own, other = skeleton.filter_distance(*given)
    assert own == pytest.approx(0.0, abs=1e-6) and other > 0.05
    last.bias[ORDER] = 0.5
    assert skeleton.filter_distance(*given)[0] == pytest.approx(0.25, abs=1e-3)


def test_the_rates_of_the_surface_s_waves_change_every_gain_and_the_film() -> None:
    alone, refined = _refined(trained=False)
    given = _own_condition()
    phases = [_phases((rate_hz, 0.0, 0.0), (turn, 0.0, 0.0)).expand(2, 6) for rate_hz, turn in ((40, 0), (90, 0), (40, 0.5))]
    slow, fast, elsewhere = (alone.skeleton.gains(*given, each) for each in phases)
    assert all((one - other).abs().max() > 1e-4 for one, other in zip(slow, fast, strict=True))
    assert all(torch.equal(one, other) for one, other in zip(slow, elsewhere, strict=True)), "the place is not a feature"
    assert refined.refiner is not None
    film = [refined.refiner.film(*given, each) for each in phases]
    assert (film[0] - film[1]).abs().max() > 1e-4 and torch.equal(film[0], film[2])


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


def test_a_refinement_sees_segment_impulses_and_the_harmonics_of_all_families_added() -> None:
    _, model = _refined(trained=True)
    noise, previous, embedding, motion, phases = _given()
    parts = model.skeleton.parts(noise, previous, model.skeleton.gains(embedding, motion, phases), phases)
    seen = Refiner.entering(parts)
    assert seen.shape == (2, ENTERING, 200)
    torch.testing.assert_close(seen[:, :2], torch.cat([parts.segment, parts.impulses], dim=1))
    cosines, sines = SurfaceWaves(SWING_HARMONICS, 700.0)(phases)
    torch.testing.assert_close(seen[:, 2:], torch.cat([cosines.sum(dim=1), sines.sum(dim=1)], dim=1))
