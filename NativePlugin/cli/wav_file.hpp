#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// Maximum number of 32-bit float samples of one channel in a WAV file, whose sizes are 32-bit numbers.
inline constexpr std::uint64_t maximumWavSamples = (0xFFFF'FFFFULL - 1024) / sizeof(float);

/// Writes one channel of 32-bit float samples, +-1, in parts. Throws InputError that names the file as `shownAs`.
class WavWriter {
public:
    /// `comment` is text stored beside the samples; readRecording returns it.
    WavWriter(const std::filesystem::path& file, int rateHz, std::string shownAs, const std::string& comment = "");
    WavWriter(const WavWriter&) = delete;
    WavWriter& operator=(const WavWriter&) = delete;
    WavWriter(WavWriter&&) = delete;
    WavWriter& operator=(WavWriter&&) = delete;
    ~WavWriter();

    void write(std::span<const float> samples);
    /// Completes the header; nothing can be written afterwards.
    void close();

private:
    struct SoundFile;
    std::unique_ptr<SoundFile> file_;
    std::string shownAs_;
};

/// One channel of a sound file.
struct Recording {
    double rateHz = 0.0;
    std::vector<float> samples;
    std::string comment;
};

/// Reads channel `channel` (from 1 on; 0 for a file that must have a single one) of a sound file of 8 to 192 kHz and at
/// most ten minutes. `role` is the file's part in the command: "the sweep". Throws InputError that names the path;
/// samples that are not finite are errors, too.
[[nodiscard]] Recording readRecording(const std::string& role, const std::string& path, int channel = 0);

}  // namespace haptoflow::cli
