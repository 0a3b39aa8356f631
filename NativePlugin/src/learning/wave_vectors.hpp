#pragma once

#include "learning/prepared_recording.hpp"
#include "learning/sliding.hpp"

#include <vector>

namespace haptoflow::learning {

/// A family of ribs or threads, across them, in cycles per millimetre.
struct WaveVector {
    double x = 0.0;
    double y = 0.0;

    [[nodiscard]] double cyclesPerMillimetre() const;
};

/// At most two, the clearest first, with wavelengths of 0.4 to 8 mm: lines of the spectrum that follow the speed, by
/// direction. None where there are none, or where the recording cannot tell: less than about 0.2 m of path, or always
/// the same speed. Where all strokes go one way, a vector lies along it.
///
/// A ruled surface with wave vector k sounds at |k . v|: with the place x on the surface, it is a line at
/// exp(2 pi i k . x), whatever speed and direction do meanwhile. The mean of the windows' spectra at k, over that of
/// its neighbours, is the evidence for a line there; a rib's evidence is that of its first six harmonics together.
/// Training does the same (preprocessing/wave_vectors.py).
[[nodiscard]] std::vector<WaveVector> findWaveVectors(const PreparedRecording& recording, const Sliding& sliding);

}  // namespace haptoflow::learning
