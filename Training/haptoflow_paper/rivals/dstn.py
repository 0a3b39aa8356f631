"""The DSTN rival (after Joolee and Jeon 2022): convolutions, an LSTM encoder-decoder, attention.

Layer sizes are not published. Here: two strided convolutions shorten the previous waveform to 20 steps, an LSTM of 128
encodes them, an LSTM of 128 decodes the segment 10 samples a step and attends to the encoder's states; material and
motion initialise the encoder and enter every step of the decoder. It is trained on its own earlier steps, as at run
time.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_paper.rivals.condition import ConditionEncoder
from haptoflow_paper.rivals.rival import RegressingRival
from haptoflow_training.waveform import SEGMENT_SAMPLES

STATE = 128
CONDITION = 64
STEP_SAMPLES = 10
STEPS = SEGMENT_SAMPLES // STEP_SAMPLES


class DecoderCell(nn.Module):
    """One LSTM step written out: 20 exported LSTM nodes would each carry a copy of the weights."""

    def __init__(self, inputs: int) -> None:
        super().__init__()
        self.gates = nn.Linear(inputs + STATE, 4 * STATE)
        # A positive forget bias speeds up learning of long continuations (Jozefowicz et al. 2015).
        nn.init.constant_(self.gates.bias[STATE : 2 * STATE], 1.0)

    def forward(self, inputs: Tensor, hidden: Tensor, cell: Tensor) -> tuple[Tensor, Tensor]:
        enter, keep, leave, candidate = self.gates(torch.cat([inputs, hidden], dim=1)).split(STATE, dim=1)
        cell = torch.sigmoid(keep) * cell + torch.sigmoid(enter) * torch.tanh(candidate)
        return torch.sigmoid(leave) * torch.tanh(cell), cell


class DstnRival(RegressingRival):
    """Previous waveform, material and motion to the segment, in 20 steps of 10 samples. If sampled, each decoder
    step also reads the noise of its own 10 samples."""

    def __init__(self, *, ribs: bool = False, sampled: bool = False) -> None:
        super().__init__(ribs=ribs, sampled=sampled)
        self.condition = ConditionEncoder(CONDITION)
        self.convolutions = nn.Sequential(
            nn.Conv1d(1, 32, 9, stride=5, padding=4),
            nn.ReLU(),
            nn.Conv1d(32, 64, 5, stride=2, padding=2),
            nn.ReLU(),
        )
        self.first_state = nn.Linear(CONDITION, 2 * STATE)
        self.encoder = nn.LSTM(64, STATE)
        self.query = nn.Linear(STATE, STATE, bias=False)
        self.decoder = DecoderCell((2 if sampled else 1) * STEP_SAMPLES + CONDITION + STATE)
        self.leave = nn.Linear(2 * STATE, STEP_SAMPLES)

    def _attend(self, hidden: Tensor, states: Tensor) -> Tensor:
        scores = torch.matmul(states, self.query(hidden).unsqueeze(-1)) * (1.0 / math.sqrt(STATE))
        return (torch.softmax(scores, dim=1) * states).sum(dim=1)

    def own_form(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        condition = self.condition(embedding, motion)
        features = self.convolutions(previous).permute(2, 0, 1)
        # A first state computed from the condition has the batch's size, in the exported graph too.
        first_hidden, first_cell = torch.tanh(self.first_state(condition)).unsqueeze(0).split(STATE, dim=2)
        states, (hidden, cell) = self.encoder(features, (first_hidden, first_cell))
        states, hidden, cell = states.permute(1, 0, 2), hidden.squeeze(0), cell.squeeze(0)

        written = previous[:, 0, -STEP_SAMPLES:]
        steps = []
        drawn = noisy.reshape(-1, SEGMENT_SAMPLES).split(STEP_SAMPLES, dim=1) if self.is_sampled else None
        for step in range(STEPS):
            context = self._attend(hidden, states)
            inputs = [written, condition, context] + ([drawn[step]] if drawn is not None else [])
            hidden, cell = self.decoder(torch.cat(inputs, dim=1), hidden, cell)
            written = self.leave(torch.cat([hidden, context], dim=1))
            steps.append(written)
        return torch.cat(steps, dim=1).unsqueeze(1)
