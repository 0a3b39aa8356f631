"""Which acceleration should be full scale, from recorded strokes."""
