#pragma once

#include "model/material_file.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::model::testing {

/// A seed with an RMS of 1: a sine.
inline nlohmann::json validSeed(double frequencyHz = 100.0) {
    std::vector<double> samples(seedSamples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        samples[i] =
            std::numbers::sqrt2 * std::sin(2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i) / 2000.0);
    }
    return {{"velocity_mps", {0.1, 0.0}}, {"force_newtons", 1.0}, {"rib_phase", {0.25, 0.0}}, {"samples", samples}};
}

/// A valid material of an embedding space, with all keys.
inline nlohmann::json validMaterial(const std::string& space) {
    nlohmann::json json = {
        {"format", "haptoflow-material"},
        {"version", 1},
        {"space", space},
        {"name", "denim"},
        {"category", "cloth"},
        {"description", "A pair of jeans."},
        {"provenance",
         {{"statement", "learnt"},
          {"recordings", "one"},
          {"licence", "unknown"},
          {"seconds", 10.5},
          {"created", "2026-11-23"}}},
        {"embedding", std::vector<double>(embeddingSize, 0.5)},
        {"range", {{"speed_mps", {0.02, 0.18}}, {"force_newtons", {1.0, 1.0}}}},
        {"level_exponents", {{"speed", 0.5}, {"force", 0.25}}},
        {"frequency_exponent", 0.5},
        {"periodic", true},
        {"wavelength_metres", 0.002},
        {"stiffness_newtons_per_metre", 300.0},
        {"friction_coefficient", 0.4},
        {"impact",
         {{"modes", {{{"frequency_hz", 90.0}, {"decay_per_second", 70.0}, {"gain_per_second", 100.0}}}},
          {"restitution", 0.1}}},
        {"level",
         {{"speeds_mps", {0.05, 0.1, 0.2}},
          {"log_levels", {0.0, 1.0, 1.5}},
          {"force_newtons", 1.0},
          {"force_exponent", 0.5}}},
        {"tone",
         {{"speeds_mps", {0.05, 0.2}}, {"frequencies_hz", {50.0, 500.0}}, {"gains_db", {{-6.0, 6.0}, {0.0, 12.0}}}}},
        {"level_offset_db", 3.0}};
    json["seeds"] = nlohmann::json::array({validSeed()});
    return json;
}

}  // namespace haptoflow::model::testing
