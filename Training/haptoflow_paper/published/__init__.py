"""The authors' published checkpoint: read, computed as they compute it, and written as a model file of the engine."""
