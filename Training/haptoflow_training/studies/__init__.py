"""User studies: plans, logs, their analysis, and simulated participants that test the analysis."""
