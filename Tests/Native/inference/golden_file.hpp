#pragma once

#include <nlohmann/json.hpp>

#include <fstream>
#include <stdexcept>
#include <string>

namespace haptoflow::testing {

/// Reads a golden JSON file from Tests/Golden. Throws, which fails the test, if it is missing, invalid or empty.
inline nlohmann::json readGolden(const std::string& name) {
    const std::string path = std::string(HAPTOFLOW_TEST_GOLDEN_DIR "/") + name;
    std::ifstream stream(path);
    if (!stream) {
        throw std::runtime_error("the golden file " + path + " is missing");
    }
    nlohmann::json golden = nlohmann::json::parse(stream);
    if (golden.empty()) {
        throw std::runtime_error("the golden file " + path + " is empty");
    }
    return golden;
}

/// The member `key` of a golden object, which must be a non-empty array.
inline const nlohmann::json& goldenRows(const nlohmann::json& golden, const char* key) {
    const nlohmann::json& rows = golden.at(key);
    if (!rows.is_array() || rows.empty()) {
        throw std::runtime_error(std::string("the golden array \"") + key + "\" is empty");
    }
    return rows;
}

}  // namespace haptoflow::testing
