#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// Most samples that one channel of 32-bit float has room for in a WAV file, whose sizes are 32-bit numbers.
inline constexpr std::uint64_t mostWavSamples = (0xFFFF'FFFFULL - 1024) / sizeof(float);

/// Writes one channel of 32-bit float samples, +-1, piece by piece. Throws InputError that calls the file `shownAs`.
class WavWriter {
public:
    /// `comment` is text that stands in the file beside the samples; readRecording gives it back.
    WavWriter(const std::filesystem::path& file, int rateHz, std::string shownAs, const std::string& comment = "");
    WavWriter(const WavWriter&) = delete;
    WavWriter& operator=(const WavWriter&) = delete;
    WavWriter(WavWriter&&) = delete;
    WavWriter& operator=(WavWriter&&) = delete;
    ~WavWriter();

    void write(std::span<const float> samples);
    /// Completes the header; nothing can be written after it.
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

/// Reads channel `channel` (from 1 on; 0 for a file that may have one only) of a sound file of 8 to 192 kHz and at most
/// ten minutes. Throws InputError that calls the file by its path; samples that are not finite are refused too.
[[nodiscard]] Recording readRecording(const std::string& path, int channel = 0);

}  // namespace haptoflow::cli
