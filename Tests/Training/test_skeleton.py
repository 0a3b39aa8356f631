"""The skeleton: an all-pole filter that continues its own past. Noise whose gain follows the ribs, lines and impulses
drive it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
import scipy.signal
import torch

from haptoflow_training.models.all_pole_filter import PredictedFilter, burg_reflection
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.refiner import ENTERING, Refiner
from haptoflow_training.models.skeleton import (
    IMPULSE_GAINS, LINE_HARMONICS, NOISE_BEFORE, ORDER, OUTPUTS, SKELETON_LIMIT, SWING_HARMONICS, Skeleton, SkeletonGains
)
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.models.label_embedding import FAMILIES, SurfaceWaves, advanced

SKELETON = Skeleton((16, 16)).eval().requires_grad_(False)
# Mild resonances, at level 1.
RAW = torch.tensor([[0.9, -0.7, 0.3, 0.2, -0.25] + [0.0] * (ORDER - 5) + [0.0]])
COSINE, SINE = 0, 1


def _gains(raw: torch.Tensor = RAW) -> SkeletonGains:
    """Of the filter alone."""
    coefficients, log_gain = PredictedFilter(ORDER)(raw)
    return SkeletonGains(
        coefficients,
        log_gain,
        torch.zeros(1, FAMILIES, 2, SWING_HARMONICS, 1),
        torch.zeros(1, FAMILIES, 2, LINE_HARMONICS, 1),
        torch.zeros(1, IMPULSE_GAINS),
        log_gain,
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


def _noise(rows: int, seed: int, samples: int = NOISE_BEFORE + 200) -> torch.Tensor:
    return torch.randn(rows, 1, samples, generator=torch.Generator().manual_seed(seed))


def _wave(rows: int, seed: int) -> torch.Tensor:
    return _noise(rows, seed, 200)


QUIET = torch.zeros(1, 1, NOISE_BEFORE + 200)
SILENCE = torch.zeros(1, 1, 200)


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


def _line(gains: SkeletonGains, phases: torch.Tensor) -> torch.Tensor:
    """[200]: the lines alone."""
    return SKELETON.parts(QUIET, SILENCE, gains, phases).segment[0, 0]


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
    made, phases = SILENCE, _phases((0.0, rate_hz, 0.0), (0.0, 0.3, 0.0))
    for _ in range(4):
        # The last of these begins when what the filter did at first has faded.
        phases = advanced(phases, 200)
        made = SKELETON.parts(QUIET, made, gains, phases).segment
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
    noise = _noise(1, 31).clamp(-1.9, 1.9)
    noise[0, 0, NOISE_BEFORE + 40] = 4.5
    gains.impulses[0, 0] = 0.2
    with_impulse = SKELETON.parts(noise, SILENCE, gains, phases)
    without = SKELETON.parts(noise, SILENCE, gains._replace(impulses=torch.zeros(1, IMPULSE_GAINS)), phases)
    assert with_impulse.impulses.nonzero()[:, 2].tolist() == [40]
    response = scipy.signal.lfilter([1.0], np.concatenate([[1.0], gains.coefficients[0]]), with_impulse.impulses[0, 0])
    difference = (with_impulse.segment - without.segment)[0, 0].numpy()
    np.testing.assert_allclose(difference, response, atol=1e-4)
    louder = SKELETON.parts(noise, SILENCE, gains._replace(log_gain=gains.log_gain + math.log(2.0)), phases)
    torch.testing.assert_close(louder.impulses, 2.0 * with_impulse.impulses)


@pytest.fixture
def exact_skeleton() -> Iterator[Skeleton]:
    """In double precision, in which the same sum in another order differs by nothing."""
    torch.set_default_dtype(torch.float64)
    yield Skeleton((16, 16)).eval().requires_grad_(False)
    torch.set_default_dtype(torch.float32)


@pytest.mark.parametrize("later", [12, 90, 150])
def test_a_skeleton_goes_on_exactly_amid_lines_and_ringing_impulses(later: int, exact_skeleton: Skeleton) -> None:
    generator = torch.Generator().manual_seed(32)
    gains, phases = _with_ribs(2), _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4))
    gains = SkeletonGains(*(part.double() for part in gains))
    impulses = 0.04 * torch.randn(1, IMPULSE_GAINS, generator=generator)
    gains = gains._replace(swing=0.3 * gains.swing, lines=0.2 * gains.lines, impulses=impulses)
    phases = phases.double()
    noise = torch.randn(1, 1, NOISE_BEFORE + 200, generator=generator)
    # One before the segment, and one shortly before it is handed over.
    noise[0, 0, NOISE_BEFORE - 20], noise[0, 0, NOISE_BEFORE + later - 5] = 4.4, -3.7
    own = torch.randn(1, 1, 200, generator=generator)
    first = exact_skeleton.parts(noise, own, gains, phases)
    second = exact_skeleton.parts(
        torch.cat([noise[:, :, later:], noise[:, :, :later]], dim=2),
        torch.cat([own[:, :, later:], first.segment[:, :, :later]], dim=2),
        gains,
        advanced(phases, later),
    )
    for one, other in ((first.impulses, second.impulses), (first.segment, second.segment)):
        torch.testing.assert_close(other[:, :, : 200 - later], one[:, :, later:], rtol=0.0, atol=1e-9)
    assert first.impulses[:, :, :10].abs().max() > 0.01 and second.impulses[:, :, :10].abs().max() > 0.01
    assert first.segment.abs().max() < SKELETON_LIMIT


def test_the_swing_modulates_the_drive_within_its_limit() -> None:
    gains, phases, noise = _nothing(), _phases((40.0, 0.0, 0.0), (0.2, 0.0, 0.0)), _noise(1, 7)
    still = SKELETON.parts(noise, SILENCE, gains, phases).segment
    torch.testing.assert_close(still, noise[:, :, NOISE_BEFORE:])
    angle = 2.0 * math.pi * (0.2 + 40.0 * (torch.arange(200) + 0.5) / 2000.0)
    for size in (0.5, 1.5, 40.0):
        gains.swing[0, 0, COSINE, 0, 0], gains.swing[0, 0, SINE, 1, 0] = size, -0.5 * size
        swing = 2.0 * torch.tanh(0.5 * size * (angle.cos() - 0.5 * (2.0 * angle).sin()))
        made = SKELETON.parts(noise, SILENCE, gains, phases).segment
        expected = (noise[0, 0, NOISE_BEFORE:] * swing.exp()).clamp(-SKELETON_LIMIT, SKELETON_LIMIT)
        torch.testing.assert_close(made[0, 0], expected, rtol=2e-3, atol=1e-3)
        assert swing.abs().max() <= 2.0


STILL = _phases((0.0, 0.0, 0.0)).expand(2, 6)


def _own_condition() -> tuple[torch.Tensor, torch.Tensor]:
    return torch.randn(2, 64, generator=torch.Generator().manual_seed(10)), torch.tensor([[0.1, 0.0, 1.0]] * 2)


def test_an_untrained_skeleton_has_a_filter_and_neither_swing_lines_nor_rungs() -> None:
    gains = Skeleton((16, 16)).gains(*_own_condition(), STILL)
    assert gains.coefficients.abs().max() > 0.0
    assert all(part.abs().max() == 0.0 for part in (gains.swing, gains.lines, gains.impulses))


def _moved_by(skeleton: Skeleton, loss: torch.Tensor) -> dict[str, bool]:
    """Which weights the gradient of a loss reaches: those of the filter's perceptron, 16 wide, those of the other one,
    and the rows of the last layer."""
    weights = [skeleton.perceptron.layers[layer].weight for layer in (0, 2, 4)]
    first, second, last = torch.autograd.grad(loss, weights, allow_unused=True)
    names = "filter", "level", "swing", "lines", "impulses"
    rows = dict(zip(names, last.split((ORDER, 1, *OUTPUTS[1:])), strict=True))
    assert second[:16, 16:].abs().max() == 0.0 and second[16:, :16].abs().max() == 0.0
    return {
        "own layers": bool(first[:16].any() or second[:16, :16].any() or rows["level"][:, :16].any()),
        "other layers": bool(first[16:].any() or second[16:, 16:].any()),
        "noise": bool(rows["level"][:, 16:].any()),
        **{name: bool(rows[name].any()) for name in ("filter", "swing", "lines", "impulses")},
    }


def _alive(seed: int) -> Skeleton:
    """With all that the second perceptron says."""
    torch.manual_seed(seed)
    skeleton = Skeleton((16, 16))
    last = skeleton.perceptron.layers[-1]
    torch.nn.init.normal_(last.weight[ORDER, 16:], std=0.2)
    torch.nn.init.normal_(last.weight[ORDER + 1 :, 16:], std=0.1)
    return skeleton


def test_the_waveform_moves_the_second_perceptron_and_the_likelihood_the_first_and_neither_the_other() -> None:
    skeleton, phases = _alive(9), _phases((40.0, 25.0, 66.0)).expand(2, 6)
    parts = skeleton.parts(2.0 * _noise(2, 11), _wave(2, 12), skeleton.gains(*_own_condition(), phases), phases)
    driving = {"other layers", "noise", "swing", "lines", "impulses"}
    moved = _moved_by(skeleton, parts.segment.square().sum())
    assert {name for name, is_moved in moved.items() if is_moved} == driving
    likelihood = skeleton.likelihood(_wave(2, 13), skeleton.gains(*_own_condition(), phases), phases)
    moved = _moved_by(skeleton, likelihood.sum())
    assert {name for name, is_moved in moved.items() if is_moved} == {
        "own layers", "filter", "other layers", "swing", "lines",
    }  # fmt: skip
    tails = skeleton.tail_likelihood(_wave(2, 13), skeleton.gains(*_own_condition(), phases), phases)
    moved = _moved_by(skeleton, tails.sum())
    assert {name for name, is_moved in moved.items() if is_moved} == {"other layers", "noise", "impulses"}
    distance = skeleton.filter_distance(_wave(2, 13), *_own_condition(), phases)
    moved = _moved_by(skeleton, distance.sum())
    assert {name for name, is_moved in moved.items() if is_moved} == {"own layers", "filter"}


def test_the_noise_is_weaker_than_all_that_drives_the_filter_by_what_the_second_perceptron_says() -> None:
    skeleton = _alive(9).requires_grad_(False)
    with_less = skeleton.gains(*_own_condition(), STILL)
    skeleton.perceptron.layers[-1].weight[ORDER, 16:] = 0.0
    alike = skeleton.gains(*_own_condition(), STILL)
    torch.testing.assert_close(alike.log_gain, alike.log_drive)
    torch.testing.assert_close(with_less.log_drive, alike.log_drive)
    assert (with_less.log_gain - with_less.log_drive).abs().min() > 0.01


def test_two_perceptrons_are_one_with_blocks_of_zeros() -> None:
    two = _alive(9).requires_grad_(False)
    one = Skeleton((32,)).requires_grad_(False)
    one.load_state_dict(two.state_dict())
    phases = _phases((40.0, 25.0, 66.0)).expand(2, 6)
    first, second = (each.gains(*_own_condition(), phases) for each in (two, one))
    for name in ("coefficients", "log_gain", "swing", "lines", "impulses"):
        torch.testing.assert_close(getattr(first, name), getattr(second, name), rtol=0.0, atol=1e-6)
    assert two.perceptron.layers[2].weight.eq(0.0).sum() == 2 * 16 * 16


def _recorded(gains: SkeletonGains, phases: torch.Tensor, rows: int) -> torch.Tensor:
    """Segments of the skeleton, [rows, 1, 200]."""
    earlier = advanced(phases, -200).expand(rows, 6)
    many = _many(gains, rows)
    past = SKELETON.parts(_noise(rows, 20), _wave(rows, 21), many, earlier).segment
    return SKELETON.parts(_noise(rows, 22), past, many, phases.expand(rows, 6)).segment


def test_the_likelihood_is_best_at_the_true_filter_level_and_swing() -> None:
    phases, true = _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4)), _with_ribs(2)
    segment = _recorded(true, phases, 128)

    def likelihood(gains: SkeletonGains) -> float:
        return SKELETON.likelihood(segment, gains, phases.expand(128, 6)).mean().item()

    best = likelihood(true)
    other = _gains(RAW + 0.15 * torch.randn(RAW.shape, generator=torch.Generator().manual_seed(1)))
    wrong = {
        "filter": true._replace(coefficients=other.coefficients),
        "louder": true._replace(log_gain=true.log_gain + 0.1, log_drive=true.log_drive + 0.1),
        "softer": true._replace(log_gain=true.log_gain - 0.1, log_drive=true.log_drive - 0.1),
        "swing": true._replace(swing=torch.zeros_like(true.swing)),
        "lines": true._replace(lines=0.8 * true.lines),
    }
    for name, gains in wrong.items():
        assert likelihood(gains) > best + 0.003, name


def _with_impulses(gains: SkeletonGains, up: float, down: float) -> SkeletonGains:
    """Of one sample each, from the third threshold on."""
    impulses = torch.zeros(1, 2, 5, 13)
    impulses[0, 0, 2, 0], impulses[0, 1, 2, 0] = up, down
    return gains._replace(impulses=impulses.reshape(1, -1))


def test_the_noise_is_found_that_makes_a_sample_with_its_impulse() -> None:
    generator = torch.Generator().manual_seed(41)
    gains = torch.zeros(3, 2, 5, 13)
    gains[..., 0] = 0.3 * torch.rand(3, 2, 5, generator=generator)
    noise = torch.nn.functional.pad(1.7 * torch.randn(3, 1, 200, generator=generator), (NOISE_BEFORE, 0))
    noise[0, 0, -1], noise[1, 0, -1], noise[2, 0, -1] = 4.6, -5.2, 0.0
    driven = noise[:, 0, NOISE_BEFORE:] + SKELETON.impulses(noise, gains.flatten(1))[:, 0]
    found, log_slope = SKELETON.impulses.explained(driven, gains.flatten(1))
    torch.testing.assert_close(found, noise[:, 0, NOISE_BEFORE:].abs(), rtol=0.0, atol=1e-4)
    assert log_slope[0, -1] > 1.0 and log_slope[2, -1] == 0.0


def test_the_noise_is_found_beneath_impulses_that_ring_on() -> None:
    generator = torch.Generator().manual_seed(41)
    # Rings add to an impulse's first sample, too.
    gains = torch.cat([0.3 * torch.ones(3, 2, 5, 1), 0.05 * torch.randn(3, 2, 5, 12, generator=generator)], dim=3)
    noise = torch.nn.functional.pad(torch.randn(3, 1, 200, generator=generator), (NOISE_BEFORE, 0))
    noise[:, 0, -9], noise[:, 0, -1] = 3.7, torch.tensor([4.6, -4.8, 0.0])
    driven = noise[:, 0, NOISE_BEFORE:] + SKELETON.impulses(noise, gains.flatten(1))[:, 0]
    found, _ = SKELETON.impulses.explained(driven, gains.flatten(1))
    torch.testing.assert_close(found, noise[:, 0, NOISE_BEFORE:].abs(), rtol=0.0, atol=1e-2)


def test_impulses_are_most_likely_with_the_ring_that_they_have() -> None:
    ring = torch.zeros(1, 2, 5, 13)
    ring[0, :, 2, 7] = 0.3
    true = _with_impulses(_gains(), 0.4, 0.3)
    true = true._replace(impulses=true.impulses + ring.reshape(1, -1))
    phases = _phases((0.0, 0.0, 0.0))
    segment = _recorded(true, phases, 1500)

    def likelihood(share: float) -> float:
        """Of so much of the ring, with the same first sample."""
        other = (share - 1.0) * ring
        other[..., 0] -= other[..., 7] * SKELETON.impulses.atoms[7, 0]
        gains = true._replace(impulses=true.impulses + other.reshape(1, -1))
        return SKELETON.tail_likelihood(segment, _many(gains, 1500), phases.expand(1500, 6)).mean().item()

    best = likelihood(1.0)
    for share in (-1.0, 0.0, 2.0):
        assert likelihood(share) > best + 2e-4, f"ring times {share}"


def test_the_tails_are_most_likely_with_the_impulses_and_the_noise_that_made_them() -> None:
    true = _with_impulses(_gains(), 0.4, 0.1)._replace(log_gain=_gains().log_gain - 0.1)
    phases = _phases((0.0, 0.0, 0.0))
    segment = _recorded(true, phases, 1500)

    def likelihood(gains: SkeletonGains) -> float:
        return SKELETON.tail_likelihood(segment, _many(gains, 1500), phases.expand(1500, 6)).mean().item()

    best = likelihood(true)
    wrong = {
        "none": _with_impulses(true, 0.0, 0.0),
        "strong": _with_impulses(true, 0.8, 0.2),
        "the other way": _with_impulses(true, 0.1, 0.4),
        "louder": true._replace(log_gain=true.log_gain + 0.1),
        "softer": true._replace(log_gain=true.log_gain - 0.1),
    }
    for name, gains in wrong.items():
        assert likelihood(gains) > best + 2e-4, name


def _many(gains: SkeletonGains, rows: int) -> SkeletonGains:
    return SkeletonGains(*(part.expand(rows, *part.shape[1:]) for part in gains))


def test_lines_in_a_recording_do_not_count_as_errors_of_prediction() -> None:
    phases, gains = _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4)), _with_ribs(2)
    gains, plain = (gains._replace(swing=0.3 * gains.swing, lines=share * gains.lines) for share in (0.2, 0.0))
    many = phases.expand(4, 6)
    with_lines, without = (SKELETON.parts(_noise(4, 22), _wave(4, 21), each, many).segment for each in (gains, plain))
    assert (with_lines - without).abs().max() > 0.5 and with_lines.abs().max() < SKELETON_LIMIT
    found = SKELETON.likelihood(with_lines, gains, many)
    torch.testing.assert_close(found, SKELETON.likelihood(without, plain, many), rtol=0.0, atol=1e-4)
    assert (SKELETON.likelihood(with_lines, plain, many) > found + 0.1).all()


def test_the_distance_of_a_filter_is_zero_at_burg_s_estimate_and_the_level_of_unit_scale_and_no_other() -> None:
    skeleton, segment = Skeleton((16, 16)).requires_grad_(False), _wave(2, 33)
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
    alone = SkeletonModel(wave_vectors=[(), ()], level=LevelModel(8), skeleton=Skeleton((16, 16)))
    torch.nn.init.normal_(alone.skeleton.perceptron.layers[-1].weight, std=0.2)
    refiner = Refiner(width=16, previous_width=8)
    if trained:
        torch.nn.init.normal_(refiner.leave.weight, std=0.2)
    refined = SkeletonModel(wave_vectors=[(), ()], level=alone.level, skeleton=alone.skeleton, refiner=refiner)
    return alone.eval().requires_grad_(False), refined.eval().requires_grad_(False)


def _given() -> tuple[torch.Tensor, ...]:
    phases = _phases((40.0, -25.0, 66.0), (0.1, 0.7, 0.4)).expand(2, 6)
    return _noise(2, 16), torch.cat([_wave(2, 17), _wave(2, 18)], dim=1), *_own_condition(), phases


def test_an_untrained_refinement_is_the_skeleton_and_a_trained_one_is_not() -> None:
    alone, untrained = _refined(trained=False)
    assert torch.equal(untrained.one_step(*_given()), alone.one_step(*_given()))
    alone, trained = _refined(trained=True)
    difference = trained.one_step(*_given()) - alone.one_step(*_given())
    assert difference[:, 0].abs().max() > 0.01 and difference[:, 1].abs().max() == 0.0


def test_the_skeleton_continues_its_own_past_and_the_network_sees_both() -> None:
    noise, pasts, *condition = _given()
    for model in _refined(trained=True):
        made = model.one_step(noise, pasts, *condition)
        played = model.one_step(noise, torch.cat([_wave(2, 19), pasts[:, 1:]], dim=1), *condition)
        beneath = model.one_step(noise, torch.cat([pasts[:, :1], _wave(2, 19)], dim=1), *condition)
        assert torch.equal(played[:, 1], made[:, 1]) and (beneath - made).abs().amax(dim=(0, 2)).min() > 0.01
        assert torch.equal(played[:, 0], made[:, 0]) == (model.refiner is None)
    correction = made[:, :1] - made[:, 1:]
    parts = model.skeleton.parts(noise, pasts[:, 1:], model.skeleton.gains(*condition), condition[-1])
    assert model.refiner is not None
    torch.testing.assert_close(correction, model.refiner(parts, pasts, *condition), rtol=0.0, atol=1e-5)
    exchanged = model.refiner(parts, pasts.flip(1), *condition)
    assert (exchanged - correction).abs().max() > 1e-3


def test_a_refinement_sees_segment_impulses_and_the_harmonics_of_all_families_added() -> None:
    _, model = _refined(trained=True)
    noise, previous, embedding, motion, phases = _given()
    parts = model.skeleton.parts(noise, previous[:, 1:], model.skeleton.gains(embedding, motion, phases), phases)
    seen = Refiner.entering(parts)
    assert seen.shape == (2, ENTERING, 200)
    torch.testing.assert_close(seen[:, :2], torch.cat([parts.segment, parts.impulses], dim=1))
    cosines, sines = SurfaceWaves(SWING_HARMONICS, 700.0)(phases)
    torch.testing.assert_close(seen[:, 2:], torch.cat([cosines.sum(dim=1), sines.sum(dim=1)], dim=1))
