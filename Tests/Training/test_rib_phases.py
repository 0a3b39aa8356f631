"""Ribs in recordings that begin anywhere: their phase is followed, and a network's own delay is taken off it."""

from __future__ import annotations

import math

import numpy as np
import pytest
import torch
from numpy.typing import NDArray

from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.skeleton import Skeleton
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.models.surface_waves import FAMILIES, path_of, with_path
from haptoflow_training.preprocessing.rib_phases import rib_phase_turns
from haptoflow_training.training.skeleton_losses import SkeletonLosses

RATE_HZ = 2000
VECTOR = (0.5, 0.3)


def _stroke(seconds: float, speed_mps: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Back and forth along the first axis: motion [n, 3] and place in mm [n, 2]."""
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    velocity = speed_mps * np.sin(2.0 * np.pi * 0.25 * time)
    motion = np.stack([velocity, 0.0 * time, 1.0 + 0.0 * time], axis=1)
    return motion, np.cumsum(motion[:, :2], axis=0) * 1000.0 / RATE_HZ


@pytest.mark.parametrize("offset", [-0.4, 0.0, 0.3])
def test_the_phase_of_ribs_is_found_wherever_a_recording_begins_and_while_it_drifts(offset: float) -> None:
    rng = np.random.default_rng(5)
    motion, place = _stroke(8.0, 0.2)
    true = offset + 0.1 * np.sin(2.0 * np.pi * 0.1 * np.arange(len(place)) / RATE_HZ)
    wave = np.cos(2.0 * np.pi * (place @ np.array(VECTOR) + true)) + 0.7 * rng.standard_normal(len(place))
    found = rib_phase_turns(wave, motion, place, VECTOR)
    moving = np.abs(motion[:, 0]) > 0.05
    missed = np.angle(np.exp(2j * np.pi * (found - true)))[moving] / (2.0 * np.pi)
    assert np.sqrt(np.mean(missed**2)) < 0.03


@pytest.mark.parametrize("rate_hz", [60.0, -60.0, 180.0])
def test_a_followed_phase_becomes_the_one_at_which_the_skeleton_s_fundamental_is_a_cosine_of_it(rate_hz: float) -> None:
    torch.manual_seed(3)
    skeleton = Skeleton(16)
    with torch.no_grad():
        skeleton.perceptron.layers[-1].bias.normal_(0.0, 0.3)
    model = SkeletonModel(wave_vectors=[[VECTOR]], level=LevelModel(16), skeleton=skeleton)
    losses = SkeletonLosses(model, ribs_followed=True)
    # The first family alone, with the phase 0.2 turns at the first sample.
    plain = torch.zeros(1, 2 * FAMILIES)
    plain[0, 0], plain[0, FAMILIES] = 0.2, rate_hz
    samples = (torch.arange(200.0) + 0.5) / RATE_HZ
    path = torch.zeros(1, FAMILIES, 200)
    path[0, 0] = 0.2 + rate_hz * samples
    followed = with_path(plain, path)
    embedding, motion = torch.randn(1, EMBEDDING_SIZE), torch.tensor([[0.1, 0.0, 1.0]])
    aligned = losses._aligned(followed, embedding, motion)
    gains = skeleton.gains(embedding, motion, aligned)
    # The fundamental alone, driven for long: a filter's answer to a line, by the filter itself.
    angle = 2.0 * math.pi * path_of(aligned)[0, 0] * math.copysign(1.0, rate_hz)
    step = 2.0 * math.pi * abs(rate_hz) / RATE_HZ
    past = angle[0] + step * torch.arange(-3000.0, 0.0)
    drive = sum(
        gains.lines[0, 0, part, 0, 0] * turned(torch.cat([past, angle]).double())
        for part, turned in enumerate((torch.cos, torch.sin))
    )
    wave = np.zeros(len(drive) + 24)
    coefficients = gains.coefficients[0].detach().double().numpy()
    for n, value in enumerate(drive.detach().numpy()):
        wave[n + 24] = value - coefficients @ wave[n : n + 24][::-1]
    ended = wave[-200:]
    stated = math.copysign(1.0, rate_hz) * path_of(followed)[0, 0].double().numpy()
    line = np.mean(ended * np.exp(-2j * np.pi * stated))
    assert abs(np.angle(line)) < 0.05 and abs(line) > 1e-3


def test_what_the_recorder_states_is_left_as_it_is() -> None:
    model = SkeletonModel(wave_vectors=[[VECTOR]], level=LevelModel(16), skeleton=Skeleton(16))
    assert not SkeletonLosses(model).ribs_followed
