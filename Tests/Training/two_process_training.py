"""Started by torchrun in test_trainer: trains in step with the other process and saves its weights."""

from __future__ import annotations

import sys
from pathlib import Path

import torch
from test_trainer import _config
from training_fixtures import make_store

from haptoflow_training.training.processes import join_processes
from haptoflow_training.training.trainer import Trainer

if __name__ == "__main__":
    folder = Path(sys.argv[1])
    with join_processes() as processes:
        trainer = Trainer(_config(), make_store(), folder / "run", processes)
        trainer.run()
        torch.save(trainer.model.state_dict(), folder / f"weights-{processes.rank}.pt")
