#include "output_file.hpp"

#include "exit_codes.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <system_error>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* remedy = ": cannot be written: name a file in an existing folder with write permission";

/// True for something that is not a regular file, which a rename would replace.
bool isSpecial(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    const std::string name = path.generic_string();
    return (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) ||
           name.starts_with("/dev/") || name.starts_with("/proc/");
}

/// The final target of a chain of links, whether it exists or not.
fs::path followLinks(const fs::path& path) {
    fs::path target = path;
    std::error_code ignored;
    for (int link = 0; fs::is_symlink(fs::symlink_status(target, ignored)); ++link) {
        constexpr int maximumLinks = 40;
        if (link == maximumLinks) {
            throw InputError(path.string() + ": is a cycle of links");
        }
        const fs::path next = fs::read_symlink(target, ignored);
        target = next.is_absolute() ? next : target.parent_path() / next;
    }
    return target;
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

bool isSameFile(const fs::path& one, const fs::path& other) {
    std::error_code ignored;
    if (isSpecial(one) || isSpecial(other)) {
        return false;
    }
    if (fs::equivalent(one, other, ignored)) {
        return true;
    }
    const auto whole = [](const fs::path& path) {
        std::error_code unused;
        return fs::weakly_canonical(fs::absolute(followLinks(path), unused), unused);
    };
    return whole(one) == whole(other);
}

}  // namespace

OutputFile::OutputFile(const fs::path& path) : path_(path), isWrittenInPlace_(isSpecial(path)) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        throw InputError(path.string() + ": is a folder; expected the name of a file");
    }
    if (isWrittenInPlace_) {
        target_ = path;
        partial_ = makePartial(fs::temp_directory_path() / "haptoflow", path);
        rememberUnfinished(partial_);
        return;
    }
    target_ = followLinks(path);
    if (fs::exists(target_, ignored) && !std::ofstream(target_, std::ios::app)) {
        throw InputError(path.string() + remedy);
    }
    partial_ = makePartial(target_, path);
    rememberUnfinished(partial_);
}

OutputFile::~OutputFile() {
    std::error_code ignored;
    fs::remove(partial_, ignored);
    forgetUnfinished(partial_);
}

void OutputFile::commit() {
    std::error_code error;
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

void requireApart(std::span<const NamedPath> outputs, std::span<const NamedPath> inputs) {
    for (std::size_t index = 0; index < outputs.size(); ++index) {
        const NamedPath& output = outputs[index];
        if (output.path.empty()) {
            continue;
        }
        const auto refuse = [&output](const NamedPath& other) {
            if (!other.path.empty() && isSameFile(output.path, other.path)) {
                throw UsageError(output.role + " " + output.path.string() + ": is the same file as " + other.role +
                                 "; name another");
            }
        };
        std::ranges::for_each(inputs, refuse);
        std::ranges::for_each(outputs.subspan(index + 1), refuse);
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
