#include "output_file.hpp"

#include "headless/scenes/command_files.hpp"
#include "messages.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <system_error>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* remedy = ": cannot be written: name a file in an existing folder with write permission";

/// True for something that a rename would replace although it is no file of its own.
bool isSpecial(const fs::path& path) {
    const std::string name = path.generic_string();
    return headless::isStandardOutput(path) || headless::isDevice(path) || name.starts_with("/dev/std") ||
           name.starts_with("/dev/fd/") || name.starts_with("/proc/");
}

/// Creates a new file with a unique name beside `target` (or with its name in `folder`).
fs::path makePartial(const fs::path& target, const fs::path& shown) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
        fs::path partial = target;
        partial += (attempt == 0 ? "" : "." + std::to_string(attempt)) + ".part";
        if (std::FILE* file = std::fopen(partial.string().c_str(), "wxb")) {
            std::fclose(file);
            return partial;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    throw InputError(shown.string() + remedy);
}

/// Partial files of this process, which the signal handler removes: a fixed array, because a handler must not allocate.
/// An entry is valid while its flag is set.
struct Unfinished {
    std::atomic<bool> isUsed = false;
    std::array<char, 4096> path{};
};
std::array<Unfinished, 8> unfinished;

void removeUnfinished(int signal) {
    for (Unfinished& entry : unfinished) {
        if (entry.isUsed) {
            std::remove(entry.path.data());
        }
    }
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

void rememberUnfinished(const fs::path& partial) {
    const std::string path = partial.string();
    for (Unfinished& entry : unfinished) {
        if (!entry.isUsed && path.size() < entry.path.size()) {
            std::copy(path.begin(), path.end(), entry.path.begin());
            entry.path.at(path.size()) = '\0';
            entry.isUsed = true;
            break;
        }
    }
    for (const int signal : {SIGINT, SIGTERM}) {
        // A signal that was ignored before (nohup, a shell's background jobs) stays ignored.
        if (std::signal(signal, removeUnfinished) == SIG_IGN) {
            std::signal(signal, SIG_IGN);
        }
    }
}

void forgetUnfinished(const fs::path& partial) {
    const std::string path = partial.string();
    for (Unfinished& entry : unfinished) {
        if (entry.isUsed && path == entry.path.data()) {
            entry.isUsed = false;
        }
    }
}

void copyToStandardOutput(const fs::path& partial) {
    std::ifstream from(partial, std::ios::binary);
    if (from.peek() != std::ifstream::traits_type::eof()) {
        std::cout << from.rdbuf();
    }
    if (from.bad() || !std::cout.flush()) {
        throw InputError("standard output could not be written to its end");
    }
}

}  // namespace

OutputFile::OutputFile(const std::string& role, const fs::path& path)
    : path_(path), isWrittenInPlace_(isSpecial(path)) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        throw InputError(path.string() + ": is a folder; expected the name of a file");
    }
    target_ = isWrittenInPlace_ ? path : headless::followLinks(path);
    if (!isWrittenInPlace_ && fs::exists(target_, ignored) && !std::ofstream(target_, std::ios::app)) {
        throw InputError(path.string() + remedy);
    }
    partial_ = makePartial(isWrittenInPlace_ ? fs::temp_directory_path() / "haptoflow" : target_, path);
    rememberUnfinished(partial_);
    try {
        headless::claimOutput({role, path_, target_, isWrittenInPlace_ ? fs::path() : partial_});
    } catch (...) {
        removePartial();
        throw;
    }
}

OutputFile::~OutputFile() {
    headless::releaseOutput(path_);
    removePartial();
}

void OutputFile::removePartial() const noexcept {
    std::error_code ignored;
    fs::remove(partial_, ignored);
    forgetUnfinished(partial_);
}

void OutputFile::commit() {
    std::error_code error;
    if (headless::isStandardOutput(path_)) {
        copyToStandardOutput(partial_);
        return;
    }
    if (isWrittenInPlace_) {
        std::ifstream from(partial_, std::ios::binary);
        std::ofstream to(target_, std::ios::binary);
        if (fs::file_size(partial_, error) > 0) {
            to << from.rdbuf();
        }
        if (error || !to.flush()) {
            throw InputError(path_.string() + ": could not be written to its end");
        }
        return;
    }
    if (fs::exists(target_, error)) {
        fs::permissions(partial_, fs::status(target_, error).permissions(), error);
    }
    fs::rename(partial_, target_, error);
    if (error) {
        throw InputError(path_.string() + ": cannot be written (" + error.message() + ")");
    }
}

void writeText(const OutputFile& file, const std::string& text) {
    std::ofstream stream(file.partial(), std::ios::binary);
    stream << text;
    if (!stream.flush()) {
        throw InputError(file.path().string() + ": could not be written to its end; is the disk full?");
    }
}

void requireWavName(const NamedPath& output) {
    const std::string ending = output.path.extension().string();
    std::string small = ending;
    std::ranges::transform(small, small.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter + 32) : letter;
    });
    if (ending.empty() || small == ".wav" || isSpecial(output.path)) {
        return;
    }
    fs::path meant = output.path;
    meant.replace_extension(".wav");
    throw UsageError(output.role + " " + output.path.string() + ": only WAV is written, not '" + ending +
                     "'; did you mean " + meant.string() + "?");
}

}  // namespace haptoflow::cli
