"""The native engine from Python: its C interface, whole renders, the time a segment takes."""
