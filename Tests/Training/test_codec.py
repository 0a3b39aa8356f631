from __future__ import annotations

import csv
import hashlib
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from numpy.typing import NDArray

from haptoflow_paper.codec.encodec import EnCodec
from haptoflow_paper.codec.representation import CodecRepresentation, Representation, build_representation
from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecConfig, SmallCodecShape, read_small_codec_config
from haptoflow_paper.codec.trainer import SegmentSampler, train_small_codec, validate
from haptoflow_training.errors import InputError
from haptoflow_training.training.batches import HeldOut


@dataclass(frozen=True)
class Span:
    start: int
    length: int
    split: str


@dataclass(frozen=True)
class Store:
    waveform: NDArray[np.float32]
    recordings: tuple[Span, ...]

    @property
    def motion(self) -> NDArray[np.float32]:
        return np.zeros((len(self.waveform), 3), dtype=np.float32)


@dataclass
class StoppingStore:
    """Fails at the n-th reading, like a killed run."""

    store: Store
    readings_left: int
    recordings: tuple[Span, ...] = field(init=False)

    def __post_init__(self) -> None:
        self.recordings = self.store.recordings

    @property
    def motion(self) -> NDArray[np.float32]:
        return self.store.motion

    @property
    def waveform(self) -> NDArray[np.float32]:
        self.readings_left -= 1
        if self.readings_left < 0:
            raise KeyboardInterrupt
        return self.store.waveform


def _texture(generator: np.random.Generator, samples: int) -> NDArray[np.float32]:
    """A tone in low-passed noise with random gain, similar to a material's acceleration."""
    noise = np.convolve(generator.standard_normal(samples + 7), np.hanning(8), mode="valid")
    time_seconds = np.arange(samples) / 2000.0
    frequency_hz = generator.uniform(40.0, 300.0)
    wave = noise / noise.std() + 1.5 * np.sin(2.0 * np.pi * frequency_hz * time_seconds)
    return (wave * 10.0 ** generator.uniform(-2.0, 0.0)).astype(np.float32)


@pytest.fixture(scope="module")
def store() -> Store:
    generator = np.random.default_rng(5)
    length = 4000
    splits = ("train",) * 8 + ("validation",) * 2 + ("test",)
    waveform = np.concatenate([_texture(generator, length) for _ in splits])
    return Store(waveform, tuple(Span(k * length, length, split) for k, split in enumerate(splits)))


def _config(folder: Path, steps: int) -> SmallCodecConfig:
    return SmallCodecConfig(
        output_folder=folder,
        shape=SmallCodecShape(latent_channels=16, width=8),
        steps=steps,
        batch=16,
        learning_rate=3e-3,
        validate_every_steps=max(1, steps // 5),
        validation_segments=64,
        threads=1,
    )


@pytest.fixture(scope="module")
def trained(store: Store, tmp_path_factory: pytest.TempPathFactory) -> tuple[SmallCodec, SmallCodecConfig]:
    config = _config(tmp_path_factory.mktemp("trained"), 100)
    return train_small_codec(store, config), config


def test_training_reaches_ten_decibels_on_held_out_recordings(
    store: Store, trained: tuple[SmallCodec, SmallCodecConfig]
) -> None:
    codec, config = trained
    unseen = SegmentSampler(store, "test", HeldOut()).draw(np.random.default_rng(9), 64)
    assert validate(codec, unseen) > 10.0
    assert validate(SmallCodec(config.shape), unseen) < 1.0


def test_a_resumed_run_equals_the_uninterrupted_one(store: Store, tmp_path: Path) -> None:
    straight = train_small_codec(store, _config(tmp_path / "straight", 10))
    stopping = StoppingStore(store, readings_left=3 + 7)
    with pytest.raises(KeyboardInterrupt):
        train_small_codec(stopping, _config(tmp_path / "stopped", 10))
    assert not (tmp_path / "stopped" / "small-codec.pt").exists()
    counting = StoppingStore(store, readings_left=10_000)
    resumed = train_small_codec(counting, _config(tmp_path / "stopped", 10))

    # Two probes, the validation draw, the four steps after the checkpoint of step 6, the draw for the statistics.
    assert 10_000 - counting.readings_left == 3 + 4 + 1
    expected = straight.state_dict()
    assert all(torch.equal(value, expected[name]) for name, value in resumed.state_dict().items())
    lines = (tmp_path / "stopped" / "log.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "step,time_loss,spectral_loss,validation_snr_db,learning_rate,elapsed_seconds"
    assert [line.split(",")[0] for line in lines[1:]] == ["2", "4", "6", "8", "10"]


def test_a_checkpoint_of_another_configuration_is_refused(store: Store, tmp_path: Path) -> None:
    config = _config(tmp_path, 2)
    train_small_codec(store, config)
    with pytest.raises(InputError, match=r"checkpoint\.pt: .* other values of learning_rate, seed"):
        train_small_codec(store, replace(config, seed=2, learning_rate=1e-4))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[training]\nseed = 1", "output_folder is missing"),
        ("[training]\noutput_folder = 'a'\nstep = 3", r"\[training\] step is unknown, expected one of batch"),
        ("[training]\noutput_folder = 'a'\nsteps = 0", r"steps = 0, expected a whole number of at least 1"),
        ("[training]\noutput_folder = 'a'\nsteps = true", r"steps = True, expected a whole number"),
        ("[training]\noutput_folder = 'a'\nlearning_rate = nan", r"learning_rate = nan, expected a number"),
        ("[training]\noutput_folder = 3", "output_folder = 3, expected a folder as text"),
        ("[codec]\nwidth = 2.5\n[training]\noutput_folder = 'a'", r"\[codec\] width = 2.5, expected a whole"),
        ("[training]\noutput_folder = 'a'\nshape = 3", r"\[training\] shape is unknown"),
        ("[optimiser]", "'optimiser' is unknown"),
        ("codec = 3", "'codec' is a value"),
        ("[training", "not valid TOML"),
    ],
)
def test_a_wrong_configuration_names_file_and_key(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "codec.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=rf"codec\.toml: .*{message}"):
        read_small_codec_config(path)


def _codec(seed: int) -> EnCodec:
    torch.manual_seed(seed)
    return EnCodec().eval()


@pytest.fixture(scope="module")
def codec() -> EnCodec:
    return _codec(1)


@pytest.fixture(scope="module")
def published_file(codec: EnCodec, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("published") / "encodec.th"
    quantizer = {"quantizer.vq.layers.0._codebook.embed": torch.randn(1024, 128)}
    torch.save({**codec.state_dict(), **quantizer}, path)
    return path


@torch.no_grad()
def test_a_published_checkpoint_loads_and_its_quantizer_is_ignored(codec: EnCodec, published_file: Path) -> None:
    loaded = _codec(2)
    waveform = torch.randn(1, 1, 2400)
    assert not torch.equal(loaded.encode(waveform), codec.encode(waveform))
    loaded.load_checkpoint(published_file, hashlib.sha256(published_file.read_bytes()).hexdigest())
    assert torch.equal(loaded.encode(waveform), codec.encode(waveform))


@pytest.mark.parametrize("digest", ["0" * 64, "0" * 8])
def test_a_wrong_sha256_is_refused_and_both_digests_are_named(
    codec: EnCodec, published_file: Path, digest: str
) -> None:
    with pytest.raises(InputError, match=rf"encodec\.th: SHA-256 is [0-9a-f]{{64}}, expected {digest};"):
        codec.load_checkpoint(published_file, digest)


def test_missing_unexpected_and_misshapen_entries_are_named_and_nothing_is_loaded(
    codec: EnCodec, tmp_path: Path
) -> None:
    state = codec.state_dict()
    del state["encoder.model.0.conv.conv.bias"]
    state["encoder.model.99.weight"] = torch.zeros(1)
    state["decoder.model.15.conv.conv.bias"] = torch.zeros(2)
    torch.save(state, tmp_path / "other.th")
    loaded = _codec(2)
    untouched = {name: value.clone() for name, value in loaded.state_dict().items()}
    with pytest.raises(InputError) as raised:
        loaded.load_checkpoint(tmp_path / "other.th")
    message = str(raised.value)
    assert "other.th" in message
    assert "missing: encoder.model.0.conv.conv.bias" in message
    assert "unexpected: encoder.model.99.weight" in message
    assert "decoder.model.15.conv.conv.bias [2] instead of [1]" in message
    assert all(torch.equal(value, loaded.state_dict()[name]) for name, value in untouched.items())


class _Malicious:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return print, ("ran code from a checkpoint",)


def test_a_checkpoint_cannot_run_code(codec: EnCodec, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    torch.save({"encoder": _Malicious()}, tmp_path / "malicious.th")
    with pytest.raises(InputError, match="not a PyTorch checkpoint of tensors, whole"):
        codec.load_checkpoint(tmp_path / "malicious.th")
    assert capsys.readouterr().out == ""


@pytest.fixture(scope="module")
def small_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    torch.manual_seed(4)
    codec = SmallCodec(SmallCodecShape(latent_channels=12, width=8))
    codec.normaliser.fit(codec.encoder(torch.randn(64, 1, 200)).detach())
    path = tmp_path_factory.mktemp("small") / "small-codec.pt"
    codec.save(path)
    return path


@pytest.fixture(scope="module")
def small(small_file: Path) -> CodecRepresentation:
    representation = build_representation({"kind": "small-codec", "checkpoint": str(small_file)})
    assert isinstance(representation, CodecRepresentation)
    return representation


@pytest.fixture(scope="module")
def encodec() -> CodecRepresentation:
    representation = build_representation({"kind": "encodec", "random_weights": True})
    assert isinstance(representation, CodecRepresentation)
    return representation


@pytest.mark.parametrize(("name", "shape"), [("small", (12, 25)), ("encodec", (128, 8))])
@torch.no_grad()
def test_a_codec_turns_segments_into_its_shape_and_back(
    name: str, shape: tuple[int, int], request: pytest.FixtureRequest
) -> None:
    representation: Representation = request.getfixturevalue(name)
    assert representation.shape == shape
    assert representation.is_latent
    latent = representation.encode(torch.randn(3, 1, 200))
    assert latent.shape == (3, *shape)
    waveform = representation.decode(latent)
    assert waveform.shape == (3, 1, 200)
    assert torch.isfinite(waveform).all()


@pytest.mark.parametrize(
    ("config", "message"),
    [
        ({}, "kind = None, expected one of encodec, raw, small-codec"),
        ({"kind": "opus"}, "kind = 'opus'"),
        ({"kind": "raw", "checkpoint": "a.pt"}, "'raw': checkpoint is unknown"),
        ({"kind": "small-codec"}, "'small-codec': checkpoint is missing"),
        ({"kind": "small-codec", "checkpoint": 3}, "checkpoint = 3, expected text"),
        ({"kind": "small-codec", "checkpoint": "absent.pt"}, "absent.pt: no such file"),
        ({"kind": "encodec", "random_weights": 1}, "random_weights = 1, expected true or false"),
        ({"kind": "encodec", "random_weights": True, "waveform_scale": 0}, "waveform_scale = 0, expected"),
    ],
)
def test_a_wrong_representation_table_names_the_key(config: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        build_representation(config)
