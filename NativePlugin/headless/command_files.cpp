#include "headless/command_files.hpp"

#include "recordings/recording.hpp"
#include "recordings/recording_files.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <tuple>
#include <utility>

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

namespace {

std::string plain(std::string_view word) {
    std::string text(word);
    for (char& letter : text) {
        if (letter >= 'A' && letter <= 'Z') {
            letter = static_cast<char>(letter - 'A' + 'a');
        } else if (letter == '_' || letter == '-') {
            letter = ' ';
        }
    }
    return text;
}

/// The number of letters to change, by which `suggestion` finds what a misspelt word meant. Written here, because CLI11
/// suggests nothing.
std::size_t lettersApart(std::string_view one, std::string_view other) {
    const std::string a = plain(one);
    const std::string b = plain(other);
    // Rows of the dynamic-programming table: [0] two letters before, [1] the previous letter, [2] the present one.
    std::array<std::vector<std::size_t>, 3> rows;
    rows.fill(std::vector<std::size_t>(b.size() + 1));
    for (std::size_t j = 0; j <= b.size(); ++j) {
        rows[1][j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        rows[2][0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = rows[1][j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
            rows[2][j] = std::min({rows[1][j] + 1, rows[2][j - 1] + 1, changed});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                rows[2][j] = std::min(rows[2][j], rows[0][j - 2] + 1);
            }
        }
        std::swap(rows[0], rows[1]);
        std::swap(rows[1], rows[2]);
    }
    return rows[1][b.size()];
}

}  // namespace

std::vector<std::string> nearestWords(std::string_view word, std::span<const std::string> candidates,
                                      std::size_t count) {
    const std::string wanted = plain(word);
    std::vector<std::tuple<std::size_t, bool, std::size_t>> ranked;
    for (std::size_t index = 0; index < candidates.size(); ++index) {
        const std::string candidate = plain(candidates[index]);
        const bool holds = candidate.find(wanted) != std::string::npos || wanted.find(candidate) != std::string::npos;
        ranked.emplace_back(lettersApart(wanted, candidate), !holds, index);
    }
    std::ranges::sort(ranked);
    std::vector<std::string> nearest;
    for (std::size_t rank = 0; rank < std::min(count, ranked.size()); ++rank) {
        nearest.push_back(candidates[std::get<2>(ranked[rank])]);
    }
    return nearest;
}

std::string didYouMean(std::span<const std::string> words) {
    std::string text = "did you mean ";
    for (std::size_t index = 0; index < words.size(); ++index) {
        const bool isLast = index + 1 == words.size();
        text += (index == 0 ? "'" : isLast ? " or '" : ", '") + words[index] + "'";
    }
    return text + "?";
}

std::string suggestion(std::string_view word, std::span<const std::string> candidates) {
    const std::vector<std::string> nearest = nearestWords(word, candidates, 1);
    const bool isNear =
        !nearest.empty() && lettersApart(word, nearest.front()) <= std::max<std::size_t>(1, word.size() / 3);
    return isNear ? didYouMean(nearest) : std::string();
}

}  // namespace haptoflow::headless
