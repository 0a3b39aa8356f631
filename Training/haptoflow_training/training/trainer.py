"""The training loop: level model first, then level and skeleton or network together, then the level once more.

Resumable: a checkpoint holds weights, moving average, optimiser, random generators and position. A run that is started
again in the same folder continues and ends with the same weights as one that was never interrupted. A run with a time
budget continues with the time that is left; its number of steps depends on the machine.
"""

from __future__ import annotations

import dataclasses
import math
import os
import signal
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any, Self

import torch
from torch import Tensor, nn
from torch.nn.parallel import DistributedDataParallel
from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.extensions import located
from haptoflow_training.models.haptoflow_model import HaptoFlowModel, SkeletonModel
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.refiner import Refiner
from haptoflow_training.models.skeleton import Skeleton
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.stopping import Stopped, end_if_stopped
from haptoflow_training.training.batches import SegmentBatches
from haptoflow_training.training.budget import Budget
from haptoflow_training.training.config import TrainingConfig, config_of_run
from haptoflow_training.training.energy_distance import LabelBalance
from haptoflow_training.training.losses import Losses, SkeletonLosses
from haptoflow_training.training.starting_weights import MovingAverage, adopt_base, adopt_start, checkpoint_of
from haptoflow_training.training.processes import Processes
from haptoflow_training.training.run_log import MetricsLog, plot_metrics, source_commit
from haptoflow_training.whole_file import write_json

_COLUMNS = ("step", "phase", "field_loss", "level_loss", "validation_field_loss", "validation_level_loss", "seconds")
_LOG_EVERY = 100
_CHECKPOINT_EVERY = 1000
# A slow machine takes minutes for so many steps, and a killed program should not lose them.
_CHECKPOINT_SECONDS = 30.0
_VALIDATION_BATCH = 512
# Steps of each phase that are timed before a budget is divided, after warm-up steps.
_REHEARSED_STEPS, _WARM_UP_STEPS = 12, 2
# The largest share of a time limit that this timing may use; with little time, fewer steps are timed.
_REHEARSED_SHARE = 0.08
_MINIMUM_TRAINING_SECONDS = 1.0
# The time left is shown as the bar's unit: the bar's own estimate assumes that all steps take equally long.
_LIMITED_BAR = "{desc}: {percentage:3.0f}%|{bar}| {unit} [{elapsed}{postfix}]"
_SECONDS_BETWEEN_BARS = 0.5


class TrainingStopped(Stopped):
    """The run was asked to stop; its checkpoint is written."""


@dataclass(frozen=True)
class TimeLimit:
    """The wall-clock time of a run. seconds_after: the time of what follows training, included in the time shown as
    left."""

    training_seconds: float
    seconds_after: float = 0.0


WaveVectors = Sequence[Sequence[tuple[float, float]]]


@dataclass(frozen=True)
class Phase:
    """Steps that train with one objective (losses.py). own_previous_every: every n-th step trains on chains of segments
    in which the network's own output is the previous waveform (self-forcing); 0 for no such steps."""

    name: str
    objective: str
    steps: int
    learning_rate: float
    batch_size: int
    own_previous_every: int = 0
    first_step: int = 0

    @property
    def end(self) -> int:
        return self.first_step + self.steps


def trainer_of(config: TrainingConfig) -> type[Trainer]:
    """The class that trains a run of this configuration."""
    trainer: type[Trainer] = located(config.trained_by)
    return trainer


def build_model(config: TrainingConfig, wave_vectors: WaveVectors, specimens: int = 0) -> HaptoFlowModel:
    """The untrained model of `config`. wave_vectors: of each label's ribs, empty for none. specimens: recorded
    pieces of each label, 0 if they are not told apart."""
    return trainer_of(config).build_model(config, wave_vectors, specimens)


def planned_steps(config: TrainingConfig) -> list[int]:
    """The steps of each phase of a run of `config`."""
    return [phase.steps for phase in trainer_of(config).phases(config)]


class Trainer:
    """Trains one configuration on one store into one folder."""

    def __init__(
        self,
        config: TrainingConfig,
        store: SegmentStore,
        folder: Path,
        processes: Processes,
        base: Path | None = None,
        wave_vectors: WaveVectors | None = None,
        start: Path | None = None,
    ) -> None:
        self._config, self._store, self._folder, self._processes = config, store, folder, processes
        self._limit: TimeLimit | None = None
        self._clock: Callable[[], float] = time.monotonic
        self._bar_shown = 0.0
        self._start, self._base, self._wave_vectors = start, base, wave_vectors
        optimiser = config.optimiser
        self._phases = list(self.phases(config))
        self._budget: Budget | None = None
        torch.set_num_threads(config.threads)
        torch.manual_seed(config.seed)
        specimens = 1 + max((each.specimen for each in store.recordings if each.specimen is not None), default=-1)
        self.model = self.build_model(config, wave_vectors or [()] * len(store.labels), specimens)
        self.check_start(config, processes, base)
        if base is not None:
            adopt_base(self.model, base, list(store.labels))
        if start is not None:
            adopt_start(self.model, start, list(store.labels))
        self._balance = LabelBalance(len(store.labels))
        self._losses = self.losses_of(config)(
            self.model, train_level=not config.recipe.shares_base, balance=self._balance,
            ribs_followed=store.ribs_followed,
        )  # fmt: skip
        self._average = MovingAverage(self.model, optimiser.average_decay)
        self._optimiser = torch.optim.AdamW(
            self.model.parameters(), lr=optimiser.learning_rate, weight_decay=optimiser.weight_decay, foreach=True
        )
        seed = config.seed * 1000 + processes.rank
        self._noise = torch.Generator().manual_seed(seed)
        self._batches = SegmentBatches(store, "train", config.batch, seed)
        self._validation = SegmentBatches(store, "validation", config.batch, 7).draw(_VALIDATION_BATCH)
        self._step = 0
        self._seconds = 0.0
        self._stop = False
        self._signal = int(signal.SIGTERM)
        self._own_saved: dict[str, Any] | None = None
        self._saved_at = 0.0

    @staticmethod
    def build_model(config: TrainingConfig, wave_vectors: WaveVectors, specimens: int = 0) -> HaptoFlowModel:
        """As the function `build_model`, for configurations of this trainer."""
        shape = config.model
        level, refiner = LevelModel(), None
        if shape.network == "refinement":
            refiner = Refiner(width=shape.width, previous_width=shape.previous_width, levels=shape.levels)
        skeleton = Skeleton(shape.hidden)
        return SkeletonModel(
            wave_vectors=wave_vectors, level=level, skeleton=skeleton, refiner=refiner, specimens=specimens
        )

    @staticmethod
    def losses_of(config: TrainingConfig) -> type[Losses]:
        """The class of the losses of a run."""
        return SkeletonLosses

    @staticmethod
    def possible_phases(config: TrainingConfig) -> list[Phase]:
        """Every phase in order, those of 0 steps too."""
        optimiser, recipe = config.optimiser, config.recipe
        # A tier that shares another run's level has no level to fit.
        level_steps, polish_steps = (
            (0, 0) if recipe.shares_base else (optimiser.level_steps, optimiser.level_polish_steps)
        )
        rate, batch, energy_batch = optimiser.learning_rate, optimiser.batch_size, recipe.energy_batch_size
        forced_rate = recipe.self_forcing_learning_rate
        forced = Phase("self-forcing", "energy", recipe.self_forcing_steps, forced_rate, batch, 1)
        if recipe.energy_steps:
            # If all pasts were the network's own, it would forget how to continue a recorded one.
            forced = Phase("self-forcing", "energy", recipe.self_forcing_steps, forced_rate, energy_batch, 2)
        fitted = "likelihood" if config.model.network == "skeleton" else "energy"
        return [
            Phase("embedding", fitted, recipe.embedding_steps, recipe.embedding_learning_rate, batch),
            Phase("level", "level", level_steps, rate, 8 * batch),
            Phase("filter", "filter", recipe.filter_steps, rate, batch),
            Phase("field", fitted, optimiser.steps, rate, batch),
            Phase("energy", "energy", recipe.energy_steps, recipe.energy_learning_rate, energy_batch),
            forced,
            Phase("polish", "level", polish_steps, rate, 8 * batch),
        ]

    @classmethod
    def phases(cls, config: TrainingConfig) -> tuple[Phase, ...]:
        """The phases of a run of `config`, one after the other."""
        phases: list[Phase] = []
        for phase in cls.possible_phases(config):
            if phase.steps:
                phases.append(dataclasses.replace(phase, first_step=phases[-1].end if phases else 0))
        return tuple(phases)

    @staticmethod
    def check_start(config: TrainingConfig, processes: Processes, base: Path | None) -> None:
        """InputError for a run that cannot begin, whatever its recordings; asked before they are prepared."""
        if config.recipe.shares_base != (base is not None):
            raise InputError(
                "--base FOLDER and recipe.shares_base = true go together: the one names the run whose level is kept, "
                "the other says that it is"
            )

    def limit_time(self, limit: TimeLimit) -> None:
        """Call before `run`: a wall-clock limit in place of the configuration's steps. One process only."""
        self._limit = limit

    @property
    def averaged_model(self) -> HaptoFlowModel:
        """The moving average of the model, which is validated and exported."""
        return self._average.module  # type: ignore[return-value]

    @property
    def checkpoint_path(self) -> Path:
        return self._folder / "checkpoint.pt"

    @property
    def _total(self) -> int:
        return self._phases[-1].end

    def run(self) -> None:
        """Train to the end, or until SIGINT or SIGTERM: then write a checkpoint and raise TrainingStopped. A
        finished run is left unchanged, with the commit that trained it in its summary."""
        self._folder.mkdir(parents=True, exist_ok=True)
        if self.checkpoint_path.exists():
            self._load()
            if self._step == self._total and (self._folder / "run.json").exists():
                return
        # The commit at the start of training; the tree may change while the run goes on.
        commit = source_commit(Path(__file__).parent)
        log = MetricsLog(self._folder / "metrics.csv", _COLUMNS, self._step) if self._processes.is_first else None
        # Until the first step there is nothing to save: a signal ends the program at once.
        if self._budget is None:
            self._budget = self.shared_out_budget()
        end_if_stopped()
        previous_handlers = {
            number: signal.signal(number, self._ask_to_stop) for number in (signal.SIGINT, signal.SIGTERM)
        }
        try:
            self._train(log)
        finally:
            for number, handler in previous_handlers.items():
                signal.signal(number, handler)
        if self._stop:
            # The signal came after the last step.
            raise self._stopped()
        if log is not None:
            self._write_summary(commit)
            plot_metrics(log, self._folder / "metrics.png")

    def _ask_to_stop(self, number: int, frame: FrameType | None) -> None:
        self._stop, self._signal = True, number

    def _stopped(self) -> TrainingStopped:
        words = f"stopped at step {self._step} of {self._total}, no model is written yet"
        return TrainingStopped(self._signal, f"{words}; run the same command again to go on from there")

    def _learning_rate(self, phase: Phase) -> float:
        peak, done = phase.learning_rate, self._step - phase.first_step
        warm = min(1.0, (done + 1) / max(1, self._config.optimiser.warm_up_steps))
        late = max(0.0, done / phase.steps - 0.5) * 2.0
        return peak * warm * (0.02 + 0.98 * 0.5 * (1.0 + math.cos(math.pi * late)))

    def _train(self, log: MetricsLog | None) -> None:
        clock = time.monotonic()
        losses: nn.Module = self._losses
        if self._processes.count > 1:
            losses = DistributedDataParallel(self._losses, find_unused_parameters=True)
        self._saved_at = clock
        bar = tqdm(
            total=self._total, initial=self._step, unit="step", disable=log is None, desc=self._config.name,
            bar_format=None if self._limit is None else _LIMITED_BAR,
        )  # fmt: skip
        for index, phase in enumerate(self._phases):
            if self._step >= phase.end:
                continue
            self.enter(phase)
            while self._step < phase.end:
                level, field = self._train_step(losses, phase)
                phase = self._paced(index)
                self._show_progress(bar)
                if self._step % _LOG_EVERY == 0 or self._step == phase.end:
                    self._seconds += time.monotonic() - clock
                    clock = time.monotonic()
                    self._report(log, phase, level, field, bar)
                is_due = time.monotonic() - self._saved_at >= _CHECKPOINT_SECONDS
                # Processes that train together save and stop at the same step.
                is_due, self._stop = self._processes.any(is_due, self._stop)
                if self._step % _CHECKPOINT_EVERY == 0 or self._step == self._total or is_due or self._stop:
                    self._save()
                if self._stop:
                    raise self._stopped()
        bar.close()

    def _show_progress(self, bar: tqdm) -> None:
        """Show steps; with a time limit, show the estimated time left, including what follows training."""
        if self._limit is None or self._budget is None:
            bar.total = self._total
            bar.update()
            return
        left = self._budget.left_seconds + self._limit.seconds_after
        bar.n = sum(self._budget.used_seconds)
        bar.total = bar.n + left
        minutes, seconds = divmod(round(left), 60)
        bar.unit = f"step {self._step}, {minutes}:{seconds:02d} left"
        if time.monotonic() - self._bar_shown > _SECONDS_BETWEEN_BARS:
            self._bar_shown = time.monotonic()
            bar.refresh()

    def _paced(self, index: int) -> Phase:
        """The running phase, with its length adjusted to its share of the budget."""
        if self._budget is not None:
            self._budget.spend(index)
            done = self._step - self._phases[index].first_step
            self._plan([*self._planned_steps[:index], self._budget.steps(index, done), *self._planned_steps[index + 1 :]])
        return self._phases[index]

    @property
    def _planned_steps(self) -> list[int]:
        return [phase.steps for phase in self._phases]

    def _plan(self, steps: Sequence[int]) -> None:
        first = 0
        for index, (phase, count) in enumerate(zip(list(self._phases), steps, strict=True)):
            self._phases[index] = dataclasses.replace(phase, first_step=first, steps=count)
            first += count

    def shared_out_budget(self) -> Budget | None:
        """The time of a run with a limit, divided among the phases; None without."""
        if self._limit is None:
            return None
        begun, seconds = self._clock(), self._limit.training_seconds
        costs = self.rehearsed(_REHEARSED_SHARE * seconds)
        if all(phase.name == "embedding" for phase in self._phases):
            # Labels alone are found after these steps; more would change nothing.
            needed = sum(cost * phase.steps for cost, phase in zip(costs, self._phases, strict=True))
            if needed < seconds - (self._clock() - begun):
                return None
        return self.divided(max(seconds - (self._clock() - begun), _MINIMUM_TRAINING_SECONDS), costs)

    def rehearsed(self, longest_seconds: float) -> list[float]:
        """Seconds of a step of each phase, measured on a network that is then discarded."""
        tried = self.rehearsal()
        return [tried._seconds_per_step(phase, longest_seconds / len(tried._phases)) for phase in tried._phases]

    def rehearsal(self) -> Self:
        """A trainer of the same run that has not begun."""
        tried = type(self)(
            self._config, self._store, self._folder, self._processes, self._base, self._wave_vectors, self._start
        )
        tried._clock = self._clock
        return tried

    def divided(self, seconds: float, seconds_per_step: Sequence[float]) -> Budget:
        """The budget of a run that begins now and may take `seconds` in all."""
        budget = Budget.shared_out(
            seconds,
            self._planned_steps,
            seconds_per_step,
            kept=[phase.objective == "level" for phase in self._phases],
            clock=self._clock,
        )
        budget.start()
        return budget

    def _seconds_per_step(self, phase: Phase, longest_seconds: float) -> float:
        self._step = phase.first_step
        self.enter(phase)
        entered = self._clock()
        for _ in range(_WARM_UP_STEPS):
            self._train_step(self._losses, phase)
            if self._clock() - entered > 0.5 * longest_seconds:
                break
        begun = self._clock()
        for step in range(1, _REHEARSED_STEPS + 1):
            self._train_step(self._losses, phase)
            if self._clock() - entered > longest_seconds:
                break
        return (self._clock() - begun) / step

    def enter(self, phase: Phase) -> None:
        """Prepare for the steps of a phase; also where a run is resumed within it."""
        if self._step == phase.first_step and phase.name in ("energy", "polish"):
            self.start_from_average()
        if phase.name == "polish":
            # The level is fitted again to the averaged embedding, which is the one that is exported.
            self._train_only(self.model.level)
        elif self._config.recipe.embedding_steps:
            self._train_only(self.model.embedding if phase.name == "embedding" else self.model)

    def _train_only(self, part: nn.Module) -> None:
        self.model.requires_grad_(False)
        part.requires_grad_(True)

    def start_from_average(self) -> None:
        """Start a phase that refines the exported average from it rather than from the last noisy step."""
        self.model.load_state_dict(self.averaged_model.state_dict())

    def _train_step(self, losses: nn.Module, phase: Phase) -> tuple[Tensor, Tensor]:
        for group in self._optimiser.param_groups:
            group["lr"] = self._learning_rate(phase)
        size = max(1, phase.batch_size // self._processes.count)
        forced = phase.own_previous_every and self._step % phase.own_previous_every == 0
        batch = self._batches.draw_chains(size) if forced else self._batches.draw(size)
        level, field = losses(batch, phase.objective, self._noise)
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
    def validate(self, phase: Phase | None = None) -> tuple[float, float]:
        """(level loss, loss of the phase's objective) of the averaged model on fixed pairs of the validation split."""
        generator = torch.Generator().manual_seed(99)
        losses = self.losses_of(self._config)(self.averaged_model, ribs_followed=self._store.ribs_followed)
        objective = (phase or self._phases[-1]).objective
        if objective == "level":
            objective = next((entry.objective for entry in self._phases if entry.name == "field"), "level")
        level, field = losses(self._validation, objective, generator)
        return level.item(), field.item()

    def _report(self, log: MetricsLog | None, phase: Phase, level: Tensor, field: Tensor, bar: tqdm) -> None:
        level, field = self._processes.mean(level), self._processes.mean(field)
        if log is None:
            return
        validate = self._step % (10 * _LOG_EVERY) == 0 or self._step == phase.end
        validation_level, validation_field = self.validate(phase) if validate else (math.nan, math.nan)
        log.append(
            {
                "step": self._step,
                "phase": phase.name,
                "field_loss": field.item() if phase.objective != "level" else math.nan,
                "level_loss": level.item(),
                "validation_field_loss": validation_field if phase.objective != "level" else math.nan,
                "validation_level_loss": validation_level,
                "seconds": round(self._seconds, 1),
            }
        )
        bar.set_postfix(phase=phase.name, field=f"{field.item():.4f}", level=f"{level.item():.3f}")

    def _save(self) -> None:
        # Each process has its own generators and running averages; the weights are the same everywhere.
        own = {"noise": self._noise.get_state(), "batches": self._batches.state(), "balance": self._balance.state()}
        path = self._folder / f"generators-{self._processes.rank}.pt"
        # A program that is killed between the two files goes on from the checkpoint before.
        now = {"step": self._step, **own}
        _save_atomically({**now, "before": self._own_saved}, path)
        self._own_saved = now
        if self._processes.is_first:
            content = {
                "config": self._config.to_dict(),
                "labels": list(self._store.labels),
                "step": self._step,
                "seconds": self._seconds,
                "steps": self._planned_steps,
                "budget": (self._budget.allotted_seconds, self._budget.used_seconds) if self._budget else None,
                "model": self.model.state_dict(),
                "average": self._average.state(),
                "optimiser": self._optimiser.state_dict(),
            }
            _save_atomically(content, self.checkpoint_path)
        self._processes.wait()
        self._saved_at = time.monotonic()

    def _load(self) -> None:
        content = torch.load(self.checkpoint_path, map_location="cpu")
        own = torch.load(self._folder / f"generators-{self._processes.rank}.pt", map_location="cpu")
        same_config = config_of_run(content["config"], self.checkpoint_path, type(self._config)) == self._config
        if not same_config or content["labels"] != list(self._store.labels):
            raise InputError(
                f"{self.checkpoint_path} belongs to another configuration: choose another --out, or delete the folder"
            )
        if own["step"] != content["step"]:
            own = own.get("before") or own
        if own["step"] != content["step"]:
            raise InputError(f"{self._folder}: checkpoint and generators disagree: delete the folder and start again")
        self.model.load_state_dict(content["model"])
        self._average.restore(content["average"])
        self._optimiser.load_state_dict(content["optimiser"])
        self._step, self._seconds = content["step"], content["seconds"]
        self._plan(content["steps"])
        self._budget = Budget(*content["budget"], clock=self._clock) if content["budget"] else None
        self._own_saved = {key: value for key, value in own.items() if key != "before"}
        self._noise.set_state(own["noise"])
        self._batches.restore(own["batches"])
        self._balance.restore(own["balance"])

    def _write_summary(self, commit: str) -> None:
        field_phases = [phase for phase in self._phases if phase.objective != "level"]
        level, field = self.validate(field_phases[-1] if field_phases else None)
        write_json(
            self._folder / "run.json",
            {
                "configuration": self._config.to_dict(),
                "seed": self._config.seed,
                "commit": commit,
                "from": "/".join(self._start.parts[-2:]) if self._start else None,
                "labels": list(self._store.labels),
                "steps": self._step,
                "processes": self._processes.count,
                "training_seconds": round(self._seconds, 1),
                "phases": self._described_phases(),
                "validation_level_loss": level,
                "validation_field_loss": field,
            },
        )

    def _described_phases(self) -> list[dict[str, Any]]:
        used = self._budget.used_seconds if self._budget else [None] * len(self._phases)
        return [
            {"name": phase.name, "steps": phase.steps, **({"core_seconds": round(seconds, 1)} if seconds else {})}
            for phase, seconds in zip(self._phases, used, strict=True)
        ]


def _save_atomically(content: dict[str, object], path: Path) -> None:
    temporary = path.with_suffix(".part")
    torch.save(content, temporary)
    os.replace(temporary, path)


def load_trained(folder: Path) -> tuple[TrainingConfig, list[str], HaptoFlowModel]:
    """Rebuild the averaged model of a finished run from the configuration saved with it."""
    content = checkpoint_of(folder)
    planned = sum(content["steps"])
    if content["step"] < planned:
        raise InputError(
            f"{folder}: interrupted at step {content['step']} of {planned}; go on with `haptoflow-training train --out "
            f"{folder}` and its configuration first"
        )
    config = config_of_run(content["config"], folder / "checkpoint.pt")
    weights = content["average"]["module"]
    specimens = weights["embedding.pieces"].shape[1] if "embedding.pieces" in weights else 0
    model = build_model(config, [()] * len(content["labels"]), specimens)
    model.load_state_dict(weights)
    return config, content["labels"], model.eval().requires_grad_(False)
