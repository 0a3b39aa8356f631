"""Materials fitted to seconds of recording: cases, figures, an autoregressive model beside them."""
