#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// A file that is either written completely or not created. The content goes to `partial()`; `commit` moves it to its
/// final name. "-" is standard output. Links are followed and kept. Devices, pipes, /dev/stdout and its kin are written
/// directly and never replaced. Without `commit`, and after SIGINT or SIGTERM, no partial file remains.
class OutputFile {
public:
    /// `role` is the option that names the path: "--report". Throws UsageError if the path is an input or another
    /// output (command_files.hpp), InputError if it cannot be written; both name it.
    OutputFile(const std::string& role, const std::filesystem::path& path);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile(OutputFile&&) = delete;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    /// A new, empty file of this process.
    [[nodiscard]] const std::filesystem::path& partial() const noexcept { return partial_; }
    /// The path as the user gave it.
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    /// Throws InputError that names the path.
    void commit();

private:
    void removePartial() const noexcept;

    std::filesystem::path path_;
    std::filesystem::path target_;
    std::filesystem::path partial_;
    bool isWrittenInPlace_ = false;
};

/// Writes the whole text to the partial file; does not commit. Throws InputError that names the path.
void writeText(const OutputFile& file, const std::string& text);

/// An output that an option asks for: there is none where its path is empty, and the functions then do nothing.
using OptionalOutput = std::unique_ptr<OutputFile>;
[[nodiscard]] OptionalOutput optionalOutput(const std::string& role, const std::filesystem::path& path);
void writeText(const OptionalOutput& file, const std::string& text);
void commit(const OptionalOutput& file);

/// Throws UsageError that suggests a name if the extension of a path is not ".wav". Devices, pipes, empty paths and
/// names without an extension are accepted.
void requireWavName(const std::string& role, const std::filesystem::path& path);

/// Maximum number of 32-bit float samples of one channel in a WAV file, whose sizes are 32-bit numbers.
inline constexpr std::uint64_t maximumWavSamples = (0xFFFF'FFFFULL - 1024) / sizeof(float);

/// Writes one channel of 32-bit float samples, +-1, in parts. Throws InputError that names the file as `shownAs`.
class WavWriter {
public:
    /// Stores `comment` in the file as text; readRecording returns it. An empty one is not stored.
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
