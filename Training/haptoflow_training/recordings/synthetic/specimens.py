"""Specimens of a material: pieces with the same label that differ in everything random.

Another specimen has another random surface, other asperities and another jitter of the ribs, and is a little louder or
softer, brighter or duller (spread.py). Calibrated values and ribs (wavelength, direction, profile, place) are the same.
One specimen is held out: its level and tilt are the label's, and no training protocol records it, only the evaluation
does. Further specimens are for figures between two pieces.
"""

from __future__ import annotations

from haptoflow_training.recordings.recording import RecordingIdentity

TRAINING_SPECIMENS = (0, 1, 2, 3, 4, 5, 6, 7)
HELD_OUT_SPECIMEN = 8
FURTHER_SPECIMENS = (9, 10, 11, 12)
# The steps of the machine protocol.
_DEGREES, _MMPS, _MILLINEWTONS = 45, 10, 500


def training_specimen(identity: RecordingIdentity) -> int:
    """The specimen that the training protocols record under this identity, one of TRAINING_SPECIMENS.

    Hand recordings cycle through the specimens by repeat; each cycle begins one earlier than the cycle before, so that
    conditions that recur every second, fourth or seventh time meet all specimens. Machine recordings move on by
    direction, speed, force and repeat together, so that each direction, speed and force meets several specimens, and
    repeats of a pass are on different ones.
    """
    count = len(TRAINING_SPECIMENS)
    if identity.direction_degrees is None:
        return TRAINING_SPECIMENS[(identity.repeat - identity.repeat // count) % count]
    place = identity.direction_degrees // _DEGREES + identity.speed_mmps // _MMPS
    place += 2 * (identity.force_millinewtons // _MILLINEWTONS) + 3 * identity.repeat
    return TRAINING_SPECIMENS[place % count]
