"""Training runs: configuration, batches, losses, the loop, its log."""
