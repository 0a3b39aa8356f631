"""The study of materials fitted to seconds of recording, beside rivals."""
