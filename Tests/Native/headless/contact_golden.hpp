#pragma once

#include "headless/contact_tracker.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace haptoflow::headless::golden {

inline constexpr const char* fileFormat = "haptoflow contact states";
inline constexpr int fileVersion = 2;

/// A case in which the tip takes the same way over a plate in each half, `carriedPlateSeconds` long.
inline constexpr const char* carriedPlateName = "the same way over a plate before and after it was moved and turned";
inline constexpr double carriedPlateSeconds = 0.6;

/// One scene and the stroke played in it, with one update per sample. Tests/Golden/contact/README.md describes the
/// file's format.
struct Case {
    std::string name;
    nlohmann::json scene;
    nlohmann::json settings;
    nlohmann::json labelStiffness = nlohmann::json::object();
    std::vector<TipSample> samples;
};

struct Outcome {
    std::vector<ContactReading> readings;
    ContactStatistics statistics;
};

/// The settings of a case, by the names in the file.
[[nodiscard]] nlohmann::json settingsToJson(const ContactSettings& settings);

[[nodiscard]] Outcome play(const Case& testCase);

/// A reading as one row, in the order of `readingColumns`.
[[nodiscard]] std::vector<std::string> readingColumns();
[[nodiscard]] std::vector<double> rowOf(const ContactReading& reading);

[[nodiscard]] nlohmann::json statisticsToJson(const ContactStatistics& statistics);

/// Reads a case of the file. Throws nlohmann::json::exception or InputError if the file is invalid.
[[nodiscard]] Case caseFromJson(const nlohmann::json& document);

/// The whole file: every case with its readings, one sample or reading per line.
[[nodiscard]] std::string fileText(const std::vector<Case>& cases);

/// The cases that `--write-golden` writes.
[[nodiscard]] std::vector<Case> goldenCases();

}  // namespace haptoflow::headless::golden
