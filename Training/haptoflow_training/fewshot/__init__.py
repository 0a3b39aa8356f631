"""A new material from seconds of recording, under a model file that stays as it is."""
