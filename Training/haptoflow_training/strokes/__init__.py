"""Hand-like movement: the sigma-lognormal model and strokes built from it."""
