"""Whether a place of a surface feels the same twice."""
