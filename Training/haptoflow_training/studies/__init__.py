"""User studies: plans, logs, their analysis, and participants that are simulated to test it."""
