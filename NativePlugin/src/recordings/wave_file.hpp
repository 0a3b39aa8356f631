#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::recordings {

/// The content of a WAV file (RIFF, RF64 or Wave64): PCM of 8 to 32 bits, or float of 32 or 64 bits. Home-made:
/// libsndfile, which the command line writes with, would be one more library to ship with the plugin on every platform.
struct WaveFile {
    double rateHz = 0.0;
    std::size_t channels = 1;
    /// Interleaved, +-1.
    std::vector<float> samples;
    /// False if the file does not say how many samples it has, because its writer could not go back to the head; then
    /// they are all that follows.
    bool isSizeKnown = true;
};

/// Reads a whole file of 1 or 3 channels. `name` is the file's in messages. Throws RecordingUnusable that names the
/// file, what was found and what is expected.
[[nodiscard]] WaveFile readWaveFile(const std::string& name, std::string_view bytes);

}  // namespace haptoflow::recordings
