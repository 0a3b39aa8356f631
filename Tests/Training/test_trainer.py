"""The training loop: it learns, it resumes to the same weights, it shares a batch between processes."""

from __future__ import annotations

import copy
import json
import os
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import pytest
import torch
from training_fixtures import make_store

from haptoflow_training.errors import InputError
from haptoflow_training.training import trainer as trainer_module
from haptoflow_training.training.config import BatchConfig, ModelConfig, OptimiserConfig, TrainingConfig
from haptoflow_training.training.processes import Processes
from haptoflow_training.training.trainer import Trainer, TrainingStopped, load_trained

ALONE = Processes(rank=0, count=1)


def _config(steps: int = 30) -> TrainingConfig:
    return TrainingConfig(
        name="test",
        tier="standard",
        threads=1,
        model=ModelConfig(hidden=(8, 8)),
        optimiser=OptimiserConfig(
            batch_size=8, level_steps=20, steps=steps, level_polish_steps=10, warm_up_steps=5, average_decay=0.9
        ),
        batch=BatchConfig(),
    )


def ask_to_stop_after(trainer: Trainer, step: int) -> None:
    """Ask the trainer to stop after this many steps, as a signal would."""
    train_step = trainer._train_step

    def stop_in_the_middle(*arguments: object) -> object:
        result = train_step(*arguments)  # type: ignore[arg-type]
        trainer._stop = trainer._step == step
        return result

    trainer._train_step = stop_in_the_middle  # type: ignore[method-assign,assignment]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An uninterrupted run."""
    folder = tmp_path_factory.mktemp("whole")
    Trainer(_config(), make_store(), folder, ALONE).run()
    return folder


def assert_same_weights(folder: Path, whole: Path) -> None:
    found, wanted = (load_trained(each)[2].state_dict() for each in (folder, whole))
    for name, weights in wanted.items():
        torch.testing.assert_close(found[name], weights, msg=name)


def test_training_lowers_both_validation_losses(tmp_path: Path) -> None:
    trainer = Trainer(_config(steps=80), make_store(), tmp_path, ALONE)
    level_before, _ = trainer.validate()
    untrained = copy.deepcopy(trainer.averaged_model.network.state_dict())
    trainer.run()
    level_after, field_after = trainer.validate()
    assert level_after < level_before
    # Over the same level: the field's loss also depends on the scale that the level gives it.
    trainer.averaged_model.network.load_state_dict(untrained)
    assert field_after < trainer.validate()[1]


def test_a_finished_run_that_is_started_again_keeps_its_summary(whole: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(whole, tmp_path / "run")
    said = (folder / "run.json").read_text(encoding="utf-8")
    # The present commit is not the one that trained.
    (folder / "run.json").write_text(said.replace('"commit": "', '"commit": "older '), encoding="utf-8")
    Trainer(_config(), make_store(), folder, ALONE).run()
    assert "older " in json.loads((folder / "run.json").read_text(encoding="utf-8"))["commit"]


def test_a_resumed_run_ends_with_the_weights_of_an_uninterrupted_one(whole: Path, tmp_path: Path) -> None:
    interrupted = Trainer(_config(), make_store(), tmp_path, ALONE)
    ask_to_stop_after(interrupted, 33)
    with pytest.raises(TrainingStopped, match="step 33 of 60"):
        interrupted.run()
    # Half of its phases are missing, so it must not be exported as finished.
    with pytest.raises(InputError, match="interrupted at step 33 of 60; go on with"):
        load_trained(tmp_path)
    Trainer(_config(), make_store(), tmp_path, ALONE).run()
    assert_same_weights(tmp_path, whole)


def test_a_folder_of_another_configuration_is_refused(whole: Path) -> None:
    with pytest.raises(InputError, match="another configuration"):
        Trainer(_config(steps=31), make_store(), whole, ALONE).run()


def test_a_loss_that_is_not_finite_stops_the_run_with_a_remedy(tmp_path: Path) -> None:
    store = make_store()
    store.waveform[: len(store.waveform) // 3] = float("nan")
    with pytest.raises(InputError, match="learning_rate"):
        Trainer(_config(), store, tmp_path, ALONE).run()


def test_a_run_that_was_never_trained_cannot_be_loaded(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="train first"):
        load_trained(tmp_path)


# A bare machine's own name does not resolve: torchrun needs the loopback address.
_TORCHRUN_ON_A_NAMELESS_MACHINE = """
import runpy, socket
socket.gethostname = lambda: "this-name-does-not-resolve.invalid"
runpy.run_module("torch.distributed.run", run_name="__main__")
"""


def _free_port() -> str:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return str(listener.getsockname()[1])


@pytest.mark.long(
    because="two processes of PyTorch start and find each other; what they compute is tested in one process"
)
def test_two_torchrun_processes_end_with_equal_weights_on_a_machine_whose_name_does_not_resolve(tmp_path: Path) -> None:
    script = Path(__file__).with_name("two_process_training.py")
    environment = dict(os.environ, OMP_NUM_THREADS="1", PYTHONPATH=os.pathsep.join(sys.path))
    subprocess.run(
        [sys.executable, "-c", _TORCHRUN_ON_A_NAMELESS_MACHINE, "--master_addr", "127.0.0.1",
         "--master_port", _free_port(), "--redirects", "1", "--tee", "1", "--nproc_per_node", "2", str(script), str(tmp_path)],
        env=environment, check=True, capture_output=True, timeout=240,
    )  # fmt: skip
    first, second = (torch.load(tmp_path / f"weights-{rank}.pt") for rank in (0, 1))
    run = json.loads((tmp_path / "run" / "run.json").read_text(encoding="utf-8"))
    assert run["processes"] == 2
    for name, weights in first.items():
        torch.testing.assert_close(second[name], weights, rtol=0.0, atol=0.0, msg=name)


def test_a_slow_run_writes_its_first_checkpoint_after_half_a_minute_and_a_killed_one_goes_on_from_it(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store, now = make_store(), [0.0]
    monkeypatch.setattr(trainer_module.time, "monotonic", lambda: now[0])
    killed = Trainer(_config(), store, tmp_path / "run", ALONE)
    train_step = killed._train_step

    def slow(*arguments: object) -> object:
        now[0] += 4.0
        if killed._step == 25:
            raise MemoryError
        return train_step(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(killed, "_train_step", slow)
    with pytest.raises(MemoryError):
        killed.run()
    assert torch.load(tmp_path / "run" / "checkpoint.pt")["step"] == 24
    Trainer(_config(), store, tmp_path / "run", ALONE).run()
    assert_same_weights(tmp_path / "run", whole)


def test_a_run_killed_between_the_two_files_of_a_checkpoint_goes_on_from_the_one_before(
    whole: Path, tmp_path: Path
) -> None:
    store = make_store()
    for step in (20, 33):
        interrupted = Trainer(_config(), store, tmp_path / "run", ALONE)
        ask_to_stop_after(interrupted, step)
        before = (tmp_path / "run" / "checkpoint.pt").read_bytes() if step == 33 else b""
        with pytest.raises(TrainingStopped):
            interrupted.run()
    (tmp_path / "run" / "checkpoint.pt").write_bytes(before)
    Trainer(_config(), store, tmp_path / "run", ALONE).run()
    assert_same_weights(tmp_path / "run", whole)


def test_a_signal_after_the_last_step_stops_the_run_too(tmp_path: Path) -> None:
    trainer = Trainer(_config(), make_store(), tmp_path, ALONE)
    save = trainer._save

    def save_and_be_asked() -> None:
        save()
        if trainer._step == trainer._total:
            trainer._ask_to_stop(15, None)

    trainer._save = save_and_be_asked  # type: ignore[method-assign]
    with pytest.raises(TrainingStopped, match="step 60 of 60"):
        trainer.run()
    Trainer(_config(), make_store(), tmp_path, ALONE).run()
    assert (tmp_path / "run.json").exists()
