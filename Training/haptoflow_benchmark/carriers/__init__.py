"""What a device with one carrier plays of a model's labels."""
