"""How well a user's own model renders the user's own recordings."""
