"""Figures of a row beside a recording, and how they are judged."""
