"""Whether what the engine renders is what was recorded."""
