"""HaptoFlow's training pipeline: recordings, networks, training, evaluation, export."""
