"""The Transformer rival (after Cai and Zhu, adjunct proceedings of ISMAR 2022).

Two pages without layer sizes were published. Here: the previous waveform as 20 tokens of 10 samples and one token for
material and motion; two encoder and two decoder layers of width 128 with four heads; 20 learnt queries that become the
segment in one pass. Layers normalise their input, which trains without a warm-up.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_paper.rivals.condition import ConditionEncoder
from haptoflow_paper.rivals.rival import RegressingRival
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
