#include "recordings/recording_files.hpp"

#include "model/header_node.hpp"
#include "model/model_error.hpp"
#include "model/model_header.hpp"
#include "model/plain_text.hpp"
#include "recordings/recording.hpp"
#include "recordings/table_rows.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <system_error>

namespace haptoflow::recordings {

namespace fs = std::filesystem;

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

namespace {

using nlohmann::json;

constexpr const char* signs = "1, or -1 where the sensor counts pressing as negative";
constexpr const char* defaultsFile = "recordings.json";
constexpr std::array keys{"label",      "full_scale_mps2",    "speed_mps", "velocity_mps", "force_newtons",
                          "force_sign", "force_rest_newtons", "motion",    "rate_hz",      "licence",
                          "source"};

std::string allKeys() {
    return joined({keys.begin(), keys.end()});
}

[[noreturn]] void fail(const fs::path& file, const std::string& found, const std::string& expected) {
    recordings::fail(utf8Of(file), found, expected);
}

json documentIn(RecordingFiles& files, const std::string& role, const fs::path& file) {
    // Also where it does not exist: a report of that name would be read as the sidecar from then on.
    std::optional<std::string> bytes = files.read(role, file);
    if (!bytes) {
        return json::object();
    }
    std::string& text = *bytes;
    if (text.starts_with("\xEF\xBB\xBF")) {
        text.erase(0, 3);
    }
    json document;
    try {
        document = model::parseBoundedJson(text);
    } catch (const model::ModelError& error) {
        fail(file, std::string("not JSON (") + error.what() + ")", "a JSON object with keys of " + allKeys());
    }
    if (!document.is_object()) {
        fail(file, "JSON that is no object", "a JSON object with keys of " + allKeys());
    }
    for (const auto& [key, unused] : document.items()) {
        if (std::ranges::find(keys, key) == keys.end()) {
            fail(file, "unknown key '" + key + "'", "keys of " + allKeys());
        }
    }
    if (document.contains("speed_mps") && document.contains("velocity_mps")) {
        fail(file, "keys speed_mps and velocity_mps", "one of them");
    }
    return document;
}

/// The values of both files and the file that each comes from.
class Values {
public:
    Values(RecordingFiles& files, const fs::path& recording, const fs::path& own) : files_(files) {
        const fs::path defaults = files.beside(recording, defaultsFile);
        add("the folder's defaults", defaults);
        if (own.filename() != defaults.filename()) {
            add("the recording's sidecar", own);
        }
    }

    [[nodiscard]] std::string text(const std::string& key) const {
        const json* value = find(key);
        if (value == nullptr) {
            return {};
        }
        if (!value->is_string()) {
            refuse(key, "a text in quotes");
        }
        std::string text(trimmed(value->get_ref<const std::string&>(), " \t\r\n"));
        if (text.size() > model::maximumTextBytes || model::hasControlCharacter(text)) {
            refuse(key, "one line of text without control characters, of " + std::to_string(model::maximumTextBytes) +
                            " bytes at most");
        }
        return text;
    }

    [[nodiscard]] std::optional<double> number(const std::string& key, double lowest, double highest,
                                               const std::string& expected) const {
        const json* value = find(key);
        if (value == nullptr) {
            return std::nullopt;
        }
        if (!value->is_number() || !(value->get<double>() >= lowest && value->get<double>() <= highest)) {
            refuse(key, expected);
        }
        return value->get<double>();
    }

    [[nodiscard]] std::optional<std::array<double, 2>> velocity() const {
        if (const auto speed =
                number("speed_mps", 0.0, maximumHandSpeedMps, "metres a second, 0 to 10 (a thousandth of mm/s)")) {
            return std::array{*speed, 0.0};
        }
        const json* value = find("velocity_mps");
        if (value == nullptr) {
            return std::nullopt;
        }
        const bool isPair =
            value->is_array() && value->size() == 2 && (*value)[0].is_number() && (*value)[1].is_number();
        if (!isPair || !(std::hypot((*value)[0].get<double>(), (*value)[1].get<double>()) <= maximumHandSpeedMps)) {
            refuse("velocity_mps", "[vx, vy] in metres a second, 10 at most (a thousandth of mm/s)");
        }
        return std::array{(*value)[0].get<double>(), (*value)[1].get<double>()};
    }

    [[nodiscard]] std::optional<fs::path> motion() const {
        const std::string name = text("motion");
        if (name.empty()) {
            return std::nullopt;
        }
        const fs::path& origin = origins_.at("motion");
        const fs::path path = files_.beside(origin, name);
        // A name in a file leads no further than its own folder.
        if (!files_.isBeside(origin, path)) {
            fail(origin, "key 'motion' names " + name + ", which is outside the folder of " + utf8Of(origin.filename()),
                 "a table beside the recording: copy it there");
        }
        if (!files_.contains(path)) {
            fail(origin, "key 'motion' names " + name + ", which is not there", "a table beside the recording");
        }
        return path;
    }

    [[noreturn]] void refuse(const std::string& key, const std::string& expected) const {
        fail(origins_.at(key), "key '" + key + "' is " + std::string(model::shortened(values_.at(key).dump(), 60)),
             expected);
    }

private:
    void add(const std::string& role, const fs::path& file) {
        const json document = documentIn(files_, role, file);
        for (const auto& [key, value] : document.items()) {
            // A file gives either the speed or the velocity; that of the later file replaces both.
            if (key == "speed_mps") {
                values_.erase("velocity_mps");
            } else if (key == "velocity_mps") {
                values_.erase("speed_mps");
            }
            values_[key] = value;
            origins_[key] = file;
        }
    }

    [[nodiscard]] const json* find(const std::string& key) const {
        const auto found = values_.find(key);
        return found == values_.end() ? nullptr : &found->second;
    }

    RecordingFiles& files_;
    std::map<std::string, json> values_;
    std::map<std::string, fs::path> origins_;
};

}  // namespace

RecordingSidecar readRecordingSidecar(RecordingFiles& files, const fs::path& recording) {
    RecordingSidecar sidecar;
    sidecar.path = files.beside(recording, utf8Of(recording.stem()) + ".json");
    const Values values(files, recording, sidecar.path);
    sidecar.label = values.text("label");
    sidecar.fullScaleMps2 = values.number("full_scale_mps2", 0.01, 1e5, "m/s^2 at +-1, 0.01 to 100000");
    sidecar.velocityMps = values.velocity();
    sidecar.forceNewtons = values.number("force_newtons", 0.0, 100.0, "newtons, 0 to 100 (a thousandth of mN)");
    sidecar.forceSign = values.number("force_sign", -1.0, 1.0, signs);
    if (sidecar.forceSign && std::abs(*sidecar.forceSign) != 1.0) {
        values.refuse("force_sign", signs);
    }
    sidecar.forceRestNewtons = values.number("force_rest_newtons", -100.0, 100.0, "newtons, -100 to 100");
    sidecar.motion = values.motion();
    sidecar.rateHz = values.number("rate_hz", lowestRateHz, highestRateHz, "samples a second, 1000 to 192000");
    sidecar.licence = values.text("licence");
    sidecar.source = values.text("source");
    return sidecar;
}

}  // namespace haptoflow::recordings
