#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace haptoflow::cli {

/// A file that appears whole or not at all. What is written goes to `partial()`; `commit` puts it in its place. A link
/// is followed and stays; a device, a pipe or a file of /dev and /proc is written to, never replaced. Without `commit`
/// nothing is left behind, nor where SIGINT or SIGTERM ends the process.
class OutputFile {
public:
    /// Throws InputError naming the path where nothing can be written there.
    explicit OutputFile(const std::filesystem::path& path);
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
    OutputFile(OutputFile&&) = delete;
    OutputFile& operator=(OutputFile&&) = delete;
    ~OutputFile();

    /// An empty file of this process's own.
    [[nodiscard]] const std::filesystem::path& partial() const noexcept { return partial_; }
    /// What the user called it.
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    /// Throws InputError naming the path.
    void commit();

private:
    std::filesystem::path path_;
    std::filesystem::path target_;
    std::filesystem::path partial_;
    bool isWrittenInPlace_ = false;
};

/// Writes the whole text to the file's partial; does not commit. Throws InputError naming the path.
void writeText(const OutputFile& file, const std::string& text);

/// A path of the command line and what it is for: "the scene", "--report".
struct NamedPath {
    std::string role;
    std::filesystem::path path;
};

/// Throws UsageError where an output is a file that is read or another output's. Empty paths are left out; devices and
/// pipes may stand twice.
void requireApart(std::span<const NamedPath> outputs, std::span<const NamedPath> inputs);

/// Throws UsageError where a path's name ends in something else than ".wav", and says which name would do. Devices,
/// pipes, empty paths and names without an ending pass.
void requireWavName(const NamedPath& output);

}  // namespace haptoflow::cli
