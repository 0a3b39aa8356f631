"""Specimens of a material: pieces with the same label that differ in everything random.

Another specimen has another random surface, other asperities and another jitter of the ribs; statistics, calibrated
values and ribs (wavelength, direction, profile, place) are the same. One specimen is held out: no training protocol
records it, only the evaluation does.
"""

from __future__ import annotations

from haptoflow_training.recordings.recording import RecordingIdentity

TRAINING_SPECIMENS = (0, 1, 2, 3)
HELD_OUT_SPECIMEN = 4
_DEGREES_BETWEEN_DIRECTIONS = 45


def training_specimen(identity: RecordingIdentity) -> int:
    """The specimen that the training protocols record under this identity, one of TRAINING_SPECIMENS.

    Hand recordings cycle through the specimens by repeat, machine recordings by direction. Each cycle begins one later
    than the cycle before, so that conditions that recur every second or fourth time meet all specimens. Repeats of a
    machine pass are on two specimens.
    """
    count = len(TRAINING_SPECIMENS)
    if identity.direction_degrees is None:
        place, further = identity.repeat, 0
    else:
        place, further = identity.direction_degrees // _DEGREES_BETWEEN_DIRECTIONS, 2 * identity.repeat
    return TRAINING_SPECIMENS[(place + place // count + further) % count]
