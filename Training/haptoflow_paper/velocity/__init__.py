"""Which estimate of the tip's velocity: today's beside rivals, on strokes whose true velocity is known."""
