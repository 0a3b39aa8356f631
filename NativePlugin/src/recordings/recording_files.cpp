#include "recordings/recording_files.hpp"

#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

namespace haptoflow::recordings {
namespace {

namespace fs = std::filesystem;

std::string lowerCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return text;
}

}  // namespace

std::string utf8Of(const fs::path& path) {
    const std::u8string text = path.u8string();
    return {text.begin(), text.end()};
}

std::string endingOf(const fs::path& path) {
    return lowerCase(utf8Of(path.extension()));
}

std::string readWholeFile(const fs::path& path, const std::string& expected) {
    const std::string name = utf8Of(path);
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        throw RecordingUnusable(name + ": is a folder; expected " + expected);
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw RecordingUnusable(name + ": cannot be opened; expected " + expected);
    }
    constexpr std::size_t maximumBytes = std::size_t{1} << 30U;
    std::string bytes;
    std::array<char, 1U << 16U> part{};
    while (bytes.size() <= maximumBytes && (file.read(part.data(), part.size()) || file.gcount() > 0)) {
        bytes.append(part.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (bytes.size() > maximumBytes) {
        throw RecordingUnusable(name + ": is larger than 1 GiB; expected " + expected);
    }
    if (file.bad()) {
        throw RecordingUnusable(name + ": cannot be read to its end; expected " + expected);
    }
    return bytes;
}

std::optional<std::string> DiskFiles::read(const std::string& role, const fs::path& path) {
    if (onInput_) {
        onInput_(role, path);
    }
    std::error_code ignored;
    if (!fs::exists(path, ignored)) {
        return std::nullopt;
    }
    return readWholeFile(path, "a recording or a file beside it that you may read");
}

bool DiskFiles::contains(const fs::path& path) const {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

fs::path DiskFiles::beside(const fs::path& file, const std::string& name) const {
    fs::path wanted = file.parent_path() / fs::path(std::u8string(name.begin(), name.end()));
    if (contains(wanted)) {
        return wanted;
    }
    std::error_code ignored;
    const fs::path folder = wanted.parent_path().empty() ? fs::path(".") : wanted.parent_path();
    const std::string searched = lowerCase(utf8Of(wanted.filename()));
    fs::path found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        const fs::path& candidate = entry.path().filename();
        if (lowerCase(utf8Of(candidate)) == searched && entry.is_regular_file(ignored) &&
            (found.empty() || candidate < found)) {
            found = candidate;
        }
    }
    return found.empty() ? wanted : wanted.parent_path() / found;
}

bool DiskFiles::isBeside(const fs::path& origin, const fs::path& path) const {
    std::error_code ignored;
    const fs::path folder = fs::weakly_canonical(fs::absolute(origin).parent_path(), ignored);
    const fs::path inside = fs::weakly_canonical(fs::absolute(path), ignored).lexically_relative(folder);
    return !inside.empty() && *inside.begin() != "..";
}

std::optional<std::string> GivenFiles::read(const std::string& /*role*/, const fs::path& path) {
    const auto found = files_.find(utf8Of(path));
    return found == files_.end() ? std::nullopt
                                 : std::optional(std::string(found->second.begin(), found->second.end()));
}

bool GivenFiles::contains(const fs::path& path) const {
    return files_.contains(utf8Of(path));
}

fs::path GivenFiles::beside(const fs::path& /*file*/, const std::string& name) const {
    const auto found =
        std::ranges::find_if(files_, [&](const auto& entry) { return lowerCase(entry.first) == lowerCase(name); });
    const std::string& chosen = files_.contains(name) || found == files_.end() ? name : found->first;
    return {std::u8string(chosen.begin(), chosen.end())};
}

bool GivenFiles::isBeside(const fs::path& /*origin*/, const fs::path& path) const {
    return path == path.filename();
}

}  // namespace haptoflow::recordings
