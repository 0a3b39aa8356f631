"""The native engine from Python: its C interface and whole renders."""
