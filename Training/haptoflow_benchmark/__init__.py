"""Measurements of a model: with own recordings, of materials learnt from seconds.

Builds on haptoflow_training, which never imports it. The comparison with rivals is haptoflow_paper.
"""
