"""`haptoflow-paper check-published`: what can only be run where the published weights are, as one report."""
