#pragma once

#include <filesystem>
#include <string>

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

/// A path of the command line and its role: "--waveform".
struct NamedPath {
    std::string role;
    std::filesystem::path path;
};

/// Throws UsageError that suggests a name if the extension of a path is not ".wav". Devices, pipes, empty paths and
/// names without an extension are accepted.
void requireWavName(const NamedPath& output);

}  // namespace haptoflow::cli
