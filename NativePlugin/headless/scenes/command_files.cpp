#include "headless/scenes/command_files.hpp"

#include "recordings/recording.hpp"
#include "recordings/recording_files.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

namespace haptoflow::headless {
namespace {

namespace fs = std::filesystem;

struct NamedFile {
    std::string role;
    fs::path path;
};

std::vector<NamedFile>& inputs() {
    static std::vector<NamedFile> all;
    return all;
}

std::vector<OutputClaim>& outputs() {
    static std::vector<OutputClaim> all;
    return all;
}

/// True if `path` names the file that the output will write, whether that file exists or not.
bool isSameFile(const OutputClaim& output, const fs::path& path) {
    std::error_code ignored;
    if (isStandardOutput(output.path) || isStandardOutput(path)) {
        return output.path == path;
    }
    if (isDevice(output.target) || isDevice(path)) {
        return false;
    }
    if (fs::equivalent(output.target, path, ignored)) {
        return true;
    }
    if (output.partial.empty()) {
        return false;
    }
    // For names of files that do not exist yet, the file system itself says whether two spellings are one: the partial
    // file beside the target is found by the other spelling, too.
    fs::path probe = followLinks(path);
    probe += output.partial.native().substr(output.target.native().size());
    return fs::equivalent(output.partial, probe, ignored);
}

[[noreturn]] void refuse(const OutputClaim& output, const std::string& role, const fs::path& path) {
    throw UsageError(output.role + " " + output.path.string() + ": is the same file as " + role + " " + path.string() +
                     "; name another file for " + output.role);
}

}  // namespace

bool isDevice(const fs::path& path) noexcept {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

void claimInput(const std::string& role, const fs::path& path) {
    for (const OutputClaim& output : outputs()) {
        if (isSameFile(output, path)) {
            refuse(output, role, path);
        }
    }
    inputs().push_back({role, path});
}

void claimOutput(const OutputClaim& output) {
    for (const NamedFile& input : inputs()) {
        if (isSameFile(output, input.path)) {
            refuse(output, input.role, input.path);
        }
    }
    for (const OutputClaim& other : outputs()) {
        if (isSameFile(other, output.path)) {
            refuse(output, other.role, other.path);
        }
    }
    outputs().push_back(output);
}

bool isStandardOutput(const fs::path& path) noexcept {
    return path == "-";
}

bool isStandardOutputTaken() noexcept {
    return std::ranges::any_of(outputs(), [](const OutputClaim& output) {
        return isStandardOutput(output.path) || output.path == "/dev/stdout";
    });
}

void releaseOutput(const fs::path& path) noexcept {
    std::erase_if(outputs(), [&path](const OutputClaim& output) { return output.path == path; });
}

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

std::string readInputFile(const std::string& role, const std::string& path, const std::string& expected) {
    claimInput(role, path);
    try {
        return recordings::readWholeFile(path, expected);
    } catch (const recordings::RecordingUnusable& error) {
        throw InputError(error.what());
    }
}

}  // namespace haptoflow::headless
