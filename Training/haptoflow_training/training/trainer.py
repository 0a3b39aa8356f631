"""The training loop: level model first, then level and velocity field together, then the level once more.

Resumable: a checkpoint holds weights, moving average, optimiser, generators and position; a run that is started
again in the same folder goes on from it and ends with the same weights as one that was never stopped.
"""

from __future__ import annotations

import math
import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

import torch
from torch import Tensor, nn
from torch.nn.parallel import DistributedDataParallel
from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.models.haptoflow_model import PREVIOUS_LIMIT, HaptoFlowModel, unit_scale
from haptoflow_training.models.level_model import level_loss
from haptoflow_training.models.representation import build_representation
from haptoflow_training.training.batches import SegmentBatch, SegmentBatches, Store
from haptoflow_training.training.config import TrainingConfig, config_from_dict
from haptoflow_training.training.flow_matching import flow_matching_loss
from haptoflow_training.training.moving_average import MovingAverage
from haptoflow_training.training.processes import Processes
from haptoflow_training.training.run_log import MetricsLog, plot_metrics, source_commit, write_json

_COLUMNS = ("step", "phase", "field_loss", "level_loss", "validation_field_loss", "validation_level_loss", "seconds")
_LOG_EVERY = 100
_CHECKPOINT_EVERY = 1000
_VALIDATION_BATCH = 512


class TrainingStopped(Exception):
    """The run was asked to stop; its checkpoint is written."""


class Losses(nn.Module):
    """Both losses in one forward pass, so that several processes synchronise all gradients at once."""

    def __init__(self, model: HaptoFlowModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, batch: SegmentBatch, with_field: bool, generator: torch.Generator) -> tuple[Tensor, Tensor]:
        model = self.model
        level = level_loss(model.log_level(batch.label, batch.level_motion), batch.level_mean_square_mps2)
        if not with_field:
            return level, torch.zeros(())
        embedding = model.embedding(batch.label)
        # The field sees waves of unit scale; it must not move the level to make its own task easier.
        log_level = model.log_level(batch.label, batch.motion).detach()
        segment = model.representation.encode(self._steady_segment(batch, embedding))
        scaled_previous = unit_scale(batch.previous, log_level).clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT)
        previous = model.representation.encode(scaled_previous)

        def field(noisy: Tensor, moment: Tensor) -> Tensor:
            return model.field(noisy, moment, previous, embedding, batch.motion)

        # A burst that the level cannot foresee (an impact, the first motion after a rest) is learnt, but must not
        # outweigh a hundred ordinary segments.
        weight = 1.0 / segment.square().mean(dim=(1, 2)).clamp(min=1.0)
        return level, flow_matching_loss(field, segment, generator, weight)

    def _steady_segment(self, batch: SegmentBatch, embedding: Tensor) -> Tensor:
        """The segment in unit scale as if the motion went on as it began: each sample is divided by the level of its
        own moment, since at run time the hand's next tenth of a second is not known."""
        rows, knots, _ = batch.motion_path.shape
        path = batch.motion_path.reshape(rows * knots, 3)
        with torch.no_grad():
            log_level = self.model.level(embedding.repeat_interleave(knots, dim=0), path).reshape(rows, 1, knots)
        samples = batch.segment.shape[-1]
        log_level = nn.functional.interpolate(log_level, size=samples, mode="linear", align_corners=True)
        return batch.segment * torch.exp(-log_level)


def build_model(config: TrainingConfig, label_count: int) -> HaptoFlowModel:
    """The untrained model that `config` describes."""
    return HaptoFlowModel(
        label_count=label_count,
        representation=build_representation(config.model.representation),
        width=config.model.width,
        previous_width=config.model.previous_width,
        patch=config.model.patch,
    )


@dataclass(frozen=True)
class _Phase:
    name: str
    first_step: int
    steps: int

    @property
    def end(self) -> int:
        return self.first_step + self.steps


class Trainer:
    """Trains one configuration on one store into one folder."""

    def __init__(self, config: TrainingConfig, store: Store, folder: Path, processes: Processes) -> None:
        self._config, self._store, self._folder, self._processes = config, store, folder, processes
        optimiser = config.optimiser
        self._phases = (
            _Phase("level", 0, optimiser.level_steps),
            _Phase("field", optimiser.level_steps, optimiser.steps),
            _Phase("polish", optimiser.level_steps + optimiser.steps, optimiser.level_polish_steps),
        )
        torch.set_num_threads(config.threads)
        torch.manual_seed(config.seed)
        self.model = build_model(config, len(store.labels))
        self._losses = Losses(self.model)
        self._average = MovingAverage(self.model, optimiser.average_decay)
        self._optimiser = torch.optim.AdamW(
            self.model.parameters(), lr=optimiser.learning_rate, weight_decay=optimiser.weight_decay
        )
        seed = config.seed * 1000 + processes.rank
        self._noise = torch.Generator().manual_seed(seed)
        self._batches = SegmentBatches(store, "train", config.batch, seed)
        self._batch_size = max(1, optimiser.batch_size // processes.count)
        self._validation = SegmentBatches(store, "validation", config.batch, 7).draw(_VALIDATION_BATCH)
        self._step = 0
        self._seconds = 0.0
        self._stop = False

    @property
    def averaged_model(self) -> HaptoFlowModel:
        """The moving average: what is validated and exported."""
        return self._average.module  # type: ignore[return-value]

    @property
    def checkpoint_path(self) -> Path:
        return self._folder / "checkpoint.pt"

    @property
    def _total(self) -> int:
        return self._phases[-1].end

    def run(self) -> None:
        """Train to the end, or until SIGINT or SIGTERM: then write a checkpoint and raise TrainingStopped."""
        self._folder.mkdir(parents=True, exist_ok=True)
        if self.checkpoint_path.exists():
            self._load()
        log = MetricsLog(self._folder / "metrics.csv", _COLUMNS, self._step) if self._processes.is_first else None
        previous_handlers = {
            number: signal.signal(number, self._ask_to_stop) for number in (signal.SIGINT, signal.SIGTERM)
        }
        try:
            self._train(log)
        finally:
            for number, handler in previous_handlers.items():
                signal.signal(number, handler)
        if log is not None:
            self._write_summary()
            plot_metrics(log, self._folder / "metrics.png")

    def _ask_to_stop(self, number: int, frame: FrameType | None) -> None:
        self._stop = True

    def _learning_rate(self, phase: _Phase) -> float:
        peak, done = self._config.optimiser.learning_rate, self._step - phase.first_step
        warm = min(1.0, (done + 1) / max(1, self._config.optimiser.warm_up_steps))
        late = max(0.0, done / phase.steps - 0.5) * 2.0
        return peak * warm * (0.02 + 0.98 * 0.5 * (1.0 + math.cos(math.pi * late)))

    def _train(self, log: MetricsLog | None) -> None:
        clock = time.monotonic()
        losses: nn.Module = self._losses
        if self._processes.count > 1:
            losses = DistributedDataParallel(self._losses, find_unused_parameters=True)
        bar = tqdm(total=self._total, initial=self._step, unit="step", disable=log is None, desc=self._config.name)
        for phase in self._phases:
            if self._step >= phase.end:
                continue
            self._enter(phase)
            while self._step < phase.end:
                level, field = self._train_step(losses, phase)
                bar.update()
                if self._step % _LOG_EVERY == 0 or self._step == phase.end:
                    self._seconds += time.monotonic() - clock
                    clock = time.monotonic()
                    self._report(log, phase, level, field, bar)
                if self._step % _CHECKPOINT_EVERY == 0 or self._step == self._total or self._stop:
                    self._save()
                if self._stop:
                    raise TrainingStopped(f"stopped at step {self._step} of {self._total}; start again to go on")
        bar.close()

    def _enter(self, phase: _Phase) -> None:
        if phase.name != "polish":
            return
        # The level is fitted anew to the averaged embedding, which is the one that will be exported.
        if self._step == phase.first_step:
            self.model.load_state_dict(self.averaged_model.state_dict())
        for parameter in (*self.model.field.parameters(), *self.model.embedding.parameters()):
            parameter.requires_grad_(False)

    def _train_step(self, losses: nn.Module, phase: _Phase) -> tuple[Tensor, Tensor]:
        for group in self._optimiser.param_groups:
            group["lr"] = self._learning_rate(phase)
        batch = self._batches.draw(self._batch_size if phase.name == "field" else 8 * self._batch_size)
        level, field = losses(batch, phase.name == "field", self._noise)
        total = level + field
        if not torch.isfinite(total):
            raise InputError(
                f"the loss became {total.item()} at step {self._step} of {self._folder}: "
                "lower optimiser.learning_rate or look for non-finite recordings with `haptoflow-training inspect`"
            )
        self._optimiser.zero_grad(set_to_none=True)
        total.backward()
        nn.utils.clip_grad_norm_(self.model.parameters(), self._config.optimiser.gradient_clip)
        self._optimiser.step()
        self._average.update(self.model)
        self._step += 1
        return level.detach(), field.detach()

    @torch.no_grad()
    def validate(self) -> tuple[float, float]:
        """(level loss, field loss) of the averaged model on fixed pairs of the validation split."""
        generator = torch.Generator().manual_seed(99)
        level, field = Losses(self.averaged_model)(self._validation, True, generator)
        return level.item(), field.item()

    def _report(self, log: MetricsLog | None, phase: _Phase, level: Tensor, field: Tensor, bar: tqdm) -> None:
        level, field = self._processes.mean(level), self._processes.mean(field)
        if log is None:
            return
        validate = self._step % (10 * _LOG_EVERY) == 0 or self._step == phase.end
        validation_level, validation_field = self.validate() if validate else (math.nan, math.nan)
        log.append(
            {
                "step": self._step,
                "phase": phase.name,
                "field_loss": field.item() if phase.name == "field" else math.nan,
                "level_loss": level.item(),
                "validation_field_loss": validation_field if phase.name != "level" else math.nan,
                "validation_level_loss": validation_level,
                "seconds": round(self._seconds, 1),
            }
        )
        bar.set_postfix(phase=phase.name, field=f"{field.item():.4f}", level=f"{level.item():.3f}")

    def _save(self) -> None:
        # Every process has its own generators; weights are the same everywhere.
        own = {"noise": self._noise.get_state(), "batches": self._batches.state()}
        path = self._folder / f"generators-{self._processes.rank}.pt"
        _save_atomically({"step": self._step, **own}, path)
        if self._processes.is_first:
            content = {
                "config": self._config.to_dict(),
                "labels": list(self._store.labels),
                "step": self._step,
                "seconds": self._seconds,
                "model": self.model.state_dict(),
                "average": self._average.state(),
                "optimiser": self._optimiser.state_dict(),
            }
            _save_atomically(content, self.checkpoint_path)
        self._processes.wait()

    def _load(self) -> None:
        content = torch.load(self.checkpoint_path, map_location="cpu")
        own = torch.load(self._folder / f"generators-{self._processes.rank}.pt", map_location="cpu")
        if content["config"] != self._config.to_dict() or content["labels"] != list(self._store.labels):
            raise InputError(
                f"{self.checkpoint_path} belongs to another configuration: choose another --out, or delete the folder"
            )
        if own["step"] != content["step"]:
            raise InputError(f"{self._folder}: checkpoint and generators disagree: delete the folder and start again")
        self.model.load_state_dict(content["model"])
        self._average.restore(content["average"])
        self._optimiser.load_state_dict(content["optimiser"])
        self._step, self._seconds = content["step"], content["seconds"]
        self._noise.set_state(own["noise"])
        self._batches.restore(own["batches"])

    def _write_summary(self) -> None:
        level, field = self.validate()
        write_json(
            self._folder / "run.json",
            {
                "configuration": self._config.to_dict(),
                "seed": self._config.seed,
                "commit": source_commit(Path(__file__).parent),
                "labels": list(self._store.labels),
                "steps": self._step,
                "processes": self._processes.count,
                "training_seconds": round(self._seconds, 1),
                "validation_level_loss": level,
                "validation_field_loss": field,
            },
        )


def _save_atomically(content: dict[str, object], path: Path) -> None:
    temporary = path.with_suffix(".part")
    torch.save(content, temporary)
    os.replace(temporary, path)


def load_trained(folder: Path) -> tuple[TrainingConfig, list[str], HaptoFlowModel]:
    """Rebuild the averaged model of a finished run from the configuration saved with it."""
    path = folder / "checkpoint.pt"
    if not path.exists():
        raise InputError(f"{path} does not exist: train first (`haptoflow-training train --out {folder}`)")
    content = torch.load(path, map_location="cpu")
    config = config_from_dict(content["config"], path)
    model = build_model(config, len(content["labels"]))
    model.load_state_dict(content["average"]["module"])
    return config, content["labels"], model.eval().requires_grad_(False)
