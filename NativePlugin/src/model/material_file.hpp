#pragma once

#include "model/model_header.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::model {

inline constexpr std::size_t maximumMaterialBytes = std::size_t{1} << 20U;
inline constexpr std::size_t maximumMaterialSeeds = 16;

/// A text is not a material file. The message names the key and the expected value.
class MaterialError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A material was learnt for another embedding space than the model's.
class MaterialMismatch : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct MaterialProvenance {
    std::string statement;
    std::string recordings;
    std::string licence;
    /// Total duration of the recordings that it was learnt from.
    double seconds = 0.0;
    /// YYYY-MM-DD, or empty.
    std::string created;
};

struct MaterialSeed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    /// See SeedEntry.
    std::array<double, 2> ribPhase{};
    /// At 2 kHz, with an RMS of 1, without the material's tone.
    std::array<float, seedSamples> samples{};
};

/// A `.haptomaterial` file of version 1: a label of a model's embedding space with its embedding, stored outside the
/// model.
struct MaterialFile {
    /// See spaceOf.
    std::string space;
    /// Its embedding row is not used.
    Label label;
    std::string description;
    MaterialProvenance provenance;
    std::array<float, embeddingSize> embedding{};
    /// Lowest and highest speed and force of the recordings.
    std::array<double, 2> speedMps{};
    std::array<double, 2> forceNewtons{};
    std::vector<MaterialSeed> seeds;
};

/// Parses the text of a material file and verifies every value. Throws MaterialError.
[[nodiscard]] MaterialFile parseMaterial(std::string_view json);
/// Reads a file. Throws MaterialError with a message that begins with the path.
[[nodiscard]] MaterialFile readMaterial(const std::filesystem::path& path);

/// Throws MaterialMismatch unless material and model have the same embedding space.
void requireSpace(const MaterialFile& material, const ModelHeader& header);

}  // namespace haptoflow::model
