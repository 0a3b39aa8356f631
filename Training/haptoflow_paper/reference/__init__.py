"""What rows are measured against: held-out recordings, and reference rows such as white noise."""
