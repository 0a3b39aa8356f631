"""Training objectives of rows: mean flow and reflow."""
