"""Networks: the velocity field, the level model, and the representations they work on."""
