#pragma once

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::headless {

/// An input file is wrong. The message names the file, the line or key, and the expected content.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The words of the command line contradict each other, or an output is a file that it reads.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The one rule for the files of a command: an output is neither a file that the command reads, or looks for, nor
/// another output. Other spellings, links and hard links are the same file; devices and pipes are exempt. The order of
/// the calls does not matter. Main thread.

/// Called for every file before it is read; `role` is its name in messages: "the scene". Throws UsageError if it is an
/// output of this command.
void claimInput(const std::string& role, const std::filesystem::path& path);

/// An output of a command: the path that the user gave, and the files to which it leads.
struct OutputClaim {
    /// "--report".
    std::string role;
    std::filesystem::path path;
    /// The file that is written in the end.
    std::filesystem::path target;
    /// An existing file whose name is that of the target with a suffix; empty if the target is written directly.
    std::filesystem::path partial;
};

/// Called for every output before anything is written to it. Throws UsageError if it is an input or another output.
void claimOutput(const OutputClaim& output);
/// The output is complete or given up.
void releaseOutput(const std::filesystem::path& path) noexcept;

/// The path that stands for standard output: "-".
[[nodiscard]] bool isStandardOutput(const std::filesystem::path& path) noexcept;
/// True while standard output is an output of this command, so that messages go elsewhere.
[[nodiscard]] bool isStandardOutputTaken() noexcept;

/// True for something that exists and is neither a file nor a folder: a device or a pipe.
[[nodiscard]] bool isDevice(const std::filesystem::path& path) noexcept;

/// The final target of a chain of links, whether it exists or not. Throws InputError for a cycle.
[[nodiscard]] std::filesystem::path followLinks(const std::filesystem::path& path);

/// Reads a whole file or pipe, up to 1 GiB. `role` is the file's part in the command, "the scene", `expected` its kind,
/// for errors. Throws InputError that names the path if the file is missing, a folder, unreadable or too large, and
/// UsageError if it is an output (command_files.hpp).
[[nodiscard]] std::string readInputFile(const std::string& role, const std::string& path, const std::string& expected);

/// The `count` candidates nearest to a word, nearest first, by the number of letters to add, remove, change or swap
/// with their neighbour (Damerau-Levenshtein). Case is ignored; `_` and `-` count as a space. Among equally near ones,
/// those that contain the word or are contained in it come first, then the given order decides.
[[nodiscard]] std::vector<std::string> nearestWords(std::string_view word, std::span<const std::string> candidates,
                                                    std::size_t count);

/// "did you mean 'a', 'b' or 'c'?"
[[nodiscard]] std::string didYouMean(std::span<const std::string> words);

/// "did you mean 'wood'?" for a misspelt word; empty if no candidate is near enough.
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string> candidates);

}  // namespace haptoflow::headless
