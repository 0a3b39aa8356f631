"""The native engine from Python: its C interface, whole renders, and timing."""
