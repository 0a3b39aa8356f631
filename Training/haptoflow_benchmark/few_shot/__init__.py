"""Materials fitted to seconds of recording: cases, rivals, figures, report."""
