"""The Transformer rival (after Cai and Zhu, adjunct proceedings of ISMAR 2022).

Two pages without layer sizes were published. Here: the previous waveform as 20 tokens of 10 samples and one token for
material and motion; two encoder and two decoder layers of width 128 with four heads; 20 learnt queries that become the
segment in one pass. Layers normalise their input, which trains without a warm-up.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_paper.rivals.rival import ConditionEncoder, RegressingRival
from haptoflow_training.waveform import SEGMENT_SAMPLES

WIDTH = 128
HEADS = 4
HEAD_WIDTH = WIDTH // HEADS
# Twice the width instead of the usual four times, so that the whole is about as large as the velocity field.
HIDDEN = 2 * WIDTH
LAYERS = 2
TOKEN_SAMPLES = 10
TOKENS = SEGMENT_SAMPLES // TOKEN_SAMPLES
MEMORY_TOKENS = TOKENS + 1


class Attention(nn.Module):
    """Scaled dot-product attention; queries [B, query_tokens, 128] over memory [B, memory_tokens, 128].

    The numbers of tokens are fixed, so that only the batch size varies in the exported graph.
    """

    def __init__(self, query_tokens: int, memory_tokens: int) -> None:
        super().__init__()
        self._query_tokens, self._memory_tokens = query_tokens, memory_tokens
        self.query = nn.Linear(WIDTH, WIDTH)
        self.key = nn.Linear(WIDTH, WIDTH)
        self.value = nn.Linear(WIDTH, WIDTH)
        self.leave = nn.Linear(WIDTH, WIDTH)

    def forward(self, queries: Tensor, memory: Tensor) -> Tensor:
        query = self.query(queries).reshape(-1, self._query_tokens, HEADS, HEAD_WIDTH).permute(0, 2, 1, 3)
        key = self.key(memory).reshape(-1, self._memory_tokens, HEADS, HEAD_WIDTH).permute(0, 2, 3, 1)
        value = self.value(memory).reshape(-1, self._memory_tokens, HEADS, HEAD_WIDTH).permute(0, 2, 1, 3)
        weights = torch.softmax(torch.matmul(query * (1.0 / math.sqrt(HEAD_WIDTH)), key), dim=-1)
        heads = torch.matmul(weights, value).permute(0, 2, 1, 3)
        return self.leave(heads.reshape(-1, self._query_tokens, WIDTH))


def _feed_forward() -> nn.Sequential:
    return nn.Sequential(
        nn.LayerNorm(WIDTH), nn.Linear(WIDTH, HIDDEN), nn.ReLU(), nn.Linear(HIDDEN, WIDTH)
    )


class EncoderLayer(nn.Module):
    """Self-attention over tokens [B, 21, 128]."""

    def __init__(self) -> None:
        super().__init__()
        self.norm = nn.LayerNorm(WIDTH)
        self.attention = Attention(MEMORY_TOKENS, MEMORY_TOKENS)
        self.feed_forward = _feed_forward()

    def forward(self, tokens: Tensor) -> Tensor:
        normed = self.norm(tokens)
        tokens = tokens + self.attention(normed, normed)
        return tokens + self.feed_forward(tokens)


class DecoderLayer(nn.Module):
    """Self-attention over tokens [B, 20, 128], then attention over memory [B, 21, 128]."""

    def __init__(self) -> None:
        super().__init__()
        self.own_norm = nn.LayerNorm(WIDTH)
        self.own_attention = Attention(TOKENS, TOKENS)
        self.memory_norm = nn.LayerNorm(WIDTH)
        self.memory_attention = Attention(TOKENS, MEMORY_TOKENS)
        self.feed_forward = _feed_forward()

    def forward(self, tokens: Tensor, memory: Tensor) -> Tensor:
        normed = self.own_norm(tokens)
        tokens = tokens + self.own_attention(normed, normed)
        tokens = tokens + self.memory_attention(self.memory_norm(tokens), memory)
        return tokens + self.feed_forward(tokens)


class TransformerRival(RegressingRival):
    """Previous waveform, material and motion to the segment, all 20 tokens at once. If sampled, each query also
    reads the noise of its own 10 samples."""

    def __init__(self, *, ribs: bool = False, sampled: bool = False) -> None:
        super().__init__(ribs=ribs, sampled=sampled)
        self.condition = ConditionEncoder(WIDTH)
        self.enter = nn.Linear(TOKEN_SAMPLES, WIDTH)
        self.enter_noise = nn.Linear(TOKEN_SAMPLES, WIDTH, bias=False) if sampled else None
        # As large as the tokens they are added to: at a tenth of it, attention cannot distinguish positions and
        # training stays at silence, the mean over all phases.
        self.positions = nn.Parameter(torch.randn(1, MEMORY_TOKENS, WIDTH))
        self.queries = nn.Parameter(torch.randn(1, TOKENS, WIDTH))
        self.encoder = nn.ModuleList(EncoderLayer() for _ in range(LAYERS))
        self.memory_norm = nn.LayerNorm(WIDTH)
        self.decoder = nn.ModuleList(DecoderLayer() for _ in range(LAYERS))
        self.leave = nn.Sequential(nn.LayerNorm(WIDTH), nn.Linear(WIDTH, TOKEN_SAMPLES))

    def own_form(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        past = self.enter(previous.reshape(-1, TOKENS, TOKEN_SAMPLES))
        condition = self.condition(embedding, motion).unsqueeze(1)
        memory = torch.cat([past, condition], dim=1) + self.positions
        for layer in self.encoder:
            memory = layer(memory)
        memory = self.memory_norm(memory)
        # Broadcasting repeats the queries for each row of the batch.
        tokens = self.queries + condition
        if self.enter_noise is not None:
            tokens = tokens + self.enter_noise(noisy.reshape(-1, TOKENS, TOKEN_SAMPLES))
        for layer in self.decoder:
            tokens = layer(tokens, memory)
        return self.leave(tokens).reshape(-1, 1, SEGMENT_SAMPLES)


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
