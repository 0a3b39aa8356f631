"""The rows of the accuracy table: planned, trained, measured, stored."""
