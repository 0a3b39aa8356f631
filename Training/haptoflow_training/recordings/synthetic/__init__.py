"""The synthetic recorder: a stylus dragged over a height profile, and the sensors mounted on it."""

from haptoflow_training.recordings.synthetic.materials import Material, load_materials
from haptoflow_training.recordings.synthetic.recorder import (
    hand_conditions, machine_conditions, record_condition, record_condition_of
)
from haptoflow_training.recordings.synthetic.surface import (
    FURTHER_SPECIMENS, HELD_OUT_SPECIMEN, TRAINING_SPECIMENS, training_specimen
)

__all__ = [
    "FURTHER_SPECIMENS",
    "HELD_OUT_SPECIMEN",
    "TRAINING_SPECIMENS",
    "Material",
    "hand_conditions",
    "load_materials",
    "machine_conditions",
    "record_condition",
    "record_condition_of",
    "training_specimen",
]
