"""Held-out materials of the synthetic recorder: recordings of seconds, and how often their ribs are found."""
