"""A synthetic data set with the faults of the real one, and what reading and preparation make of it."""
