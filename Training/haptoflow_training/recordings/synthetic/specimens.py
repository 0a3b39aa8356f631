"""Specimens of a material: pieces of it that differ in everything random and share everything that is the label's.

Another specimen is another random surface, other asperities, another jitter of the ribs; statistics, calibrated values
and ribs (wavelength, direction, profile, place) are the same. One specimen is held out entirely: no training protocol
records it, evaluation does.
"""

from __future__ import annotations

from haptoflow_training.recordings.recording import RecordingIdentity

TRAINING_SPECIMENS = (0, 1, 2, 3)
HELD_OUT_SPECIMEN = 4
_DEGREES_BETWEEN_DIRECTIONS = 45


def training_specimen(identity: RecordingIdentity) -> int:
    """The specimen that the training protocols record under this identity, one of TRAINING_SPECIMENS.

    Hand recordings go round the specimens by repeat, machine recordings by direction. Each round begins one later than
    the round before, so that what recurs every second or fourth time meets all specimens. Repeats of a machine pass
    are on two specimens.
    """
    count = len(TRAINING_SPECIMENS)
    if identity.direction_degrees is None:
        place, further = identity.repeat, 0
    else:
        place, further = identity.direction_degrees // _DEGREES_BETWEEN_DIRECTIONS, 2 * identity.repeat
    return TRAINING_SPECIMENS[(place + place // count + further) % count]
