"""From a trained run to a `.haptoflow` model file."""
