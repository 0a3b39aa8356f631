#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace haptoflow::cli {

/// Most samples that one channel of 32-bit float has room for in a WAV file, whose sizes are 32-bit numbers.
inline constexpr std::uint64_t mostWavSamples = (0xFFFF'FFFFULL - 1024) / sizeof(float);

/// Writes one channel of 32-bit float samples, +-1, piece by piece. Throws InputError that calls the file `shownAs`.
class WavWriter {
public:
    WavWriter(const std::filesystem::path& file, int rateHz, std::string shownAs);
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

}  // namespace haptoflow::cli
