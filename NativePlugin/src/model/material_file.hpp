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

/// A text is not a material file. The message names the key and what was expected there.
class MaterialError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A material was learnt for other networks than a model has.
class MaterialMismatch : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct MaterialProvenance {
    std::string statement;
    std::string recordings;
    std::string licence;
    /// Of recordings that it was learnt from.
    double seconds = 0.0;
    /// YYYY-MM-DD, or empty.
    std::string created;
};

struct MaterialSeed {
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    /// See SeedEntry.
    std::array<double, 2> ribPhase{};
    /// At 2 kHz, with an RMS of 1, before tone.
    std::array<float, seedSamples> samples{};
};

/// A `.haptomaterial` file of version 1: a label of a model's space with its embedding, kept outside the model.
struct MaterialFile {
    /// See spaceOf.
    std::string space;
    /// Its embedding row means nothing.
    Label label;
    std::string description;
    MaterialProvenance provenance;
    std::array<float, embeddingSize> embedding{};
    /// What it was learnt from: lowest and highest.
    std::array<double, 2> speedMps{};
    std::array<double, 2> forceNewtons{};
    std::vector<MaterialSeed> seeds;
};

/// Reads the text of a material file; no byte of it is trusted. Throws MaterialError.
[[nodiscard]] MaterialFile parseMaterial(std::string_view json);
/// Throws MaterialError, whose message then begins with the path.
[[nodiscard]] MaterialFile readMaterial(const std::filesystem::path& path);

/// Throws MaterialMismatch unless the material sounds under the model.
void requireSpace(const MaterialFile& material, const ModelHeader& header);

}  // namespace haptoflow::model
