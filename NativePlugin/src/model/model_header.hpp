#pragma once

#include "dsp/sample_rates.hpp"
#include "model/material_tables.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::model {

inline constexpr std::size_t maximumLabels = 4096;
inline constexpr std::size_t maximumTiers = 64;
inline constexpr std::size_t maximumBlobs = 1024;
inline constexpr std::size_t maximumSeeds = 65'536;
/// Recorded pieces of a label.
inline constexpr std::size_t maximumPieces = 256;
inline constexpr std::size_t embeddingSize = 64;
/// Numbers of an embedding that describe the texture; the last four are the components of two wave vectors.
inline constexpr std::size_t textureSize = 60;
/// A seed holds the segment that sounds and, before it, the segment that counts as its past.
inline constexpr std::size_t seedSamples = 2 * dsp::segmentSamples;
/// Bytes of a text that is not a name, such as a description.
inline constexpr std::size_t maximumTextBytes = 4096;
/// Limits of motions and of the ranges of labels and materials.
inline constexpr double maximumSpeedMps = 100.0;
inline constexpr double maximumForceNewtons = 1000.0;
/// Exponents of the level laws are within +- this.
inline constexpr double maximumLevelExponent = 4.0;
/// Largest gain of a seed.
inline constexpr double maximumSeedGain = 16.0;
/// Largest magnitude of a number in an embedding or a seed.
inline constexpr double maximumMagnitude = 1e6;
/// Dimensions of a tensor, of a blob and of an ONNX graph.
inline constexpr std::size_t maximumTensorRank = 8;

struct Provenance {
    std::string statement;
    std::string recordings;
    std::string licence;
    std::int64_t seed = 0;
    std::string commit;
    /// YYYY-MM-DD, or empty.
    std::string created;
};

/// A trained interval and the 5th, 25th, 50th, 75th and 95th percentile of the training samples in it.
struct TrainedInterval {
    double minimum = 0.0;
    double maximum = 0.0;
    std::array<double, 5> percentiles{};

    /// The value at a share of the interval, 0 to 1.
    [[nodiscard]] double at(double share) const noexcept { return minimum + share * (maximum - minimum); }
};

struct ImpactMode {
    /// 0 for no mode.
    double frequencyHz = 0.0;
    double decayPerSecond = 0.0;
    /// Amplitude in m/s^2 per m/s of approach speed.
    double gainPerSecond = 0.0;
};

/// A material's response to an impact.
struct Impact {
    static constexpr std::size_t maximumModes = 2;
    std::array<ImpactMode, maximumModes> modes{};
    /// Share of the speed that remains after a rebound, 0 to 0.9.
    double restitution = 0.0;
};

/// How far the true phase of ribs wanders from that of an even ruling.
struct RibWander {
    /// Standard deviation.
    double cycles = 0.0;
    /// Distance over which it changes.
    double wavelengthMetres = 0.0;
};

/// A tip that sticks and slips: the slip comes anew after about this distance.
struct StickSlip {
    double lengthMetres = 0.0;
    /// Share by which the distance wanders, and over which distance it does.
    double wander = 0.0;
    double wanderMetres = 0.0;
};

struct Label {
    std::string name;
    std::size_t embeddingRow = 0;
    double speedLevelExponent = 0.0;
    double forceLevelExponent = 0.0;
    double frequencyExponent = 0.0;
    /// Set for a periodic label (woven, ruled): its fundamental is speed / wavelength.
    std::optional<double> wavelengthMetres;
    double stiffnessNewtonsPerMetre = 0.0;
    double frictionCoefficient = 0.0;
    std::optional<Impact> impact;
    std::string category;
    std::optional<LevelTable> level;
    std::optional<ToneTable> tone;
    /// Factor on the impulses that the skeleton makes, relative to its noise.
    float impulseGain = 1.0F;
    /// Added to every level, from the level graph or from a table.
    double levelOffsetDb = 0.0;
    std::optional<StickSlip> stickSlip;
    /// One for each wave vector; empty for even ribs.
    std::vector<RibWander> ribWander;
};

/// What a tier runs: a velocity field with a solver; one with an interval; a graph that returns the segment; the
/// skeleton alone; the skeleton and a graph that corrects it.
enum class TierKind { flow, averageVelocity, direct, skeleton, refine };
enum class SolverKind { euler, midpoint, heun };
enum class TierRepresentation { raw, latent };

struct Tier {
    std::string name;
    TierKind kind = TierKind::flow;
    /// Names of ONNX blobs, empty for graphs that the tier does not have: `encoder` and `decoder` unless the
    /// representation is latent, `level` for tiers that use the skeleton, `field` for kind `skeleton`.
    std::string field;
    std::string level;
    std::string encoder;
    std::string decoder;
    /// Without effect on tiers that are not solved.
    SolverKind solver = SolverKind::euler;
    int steps = 1;
    std::int64_t parameters = 0;
    TierRepresentation representation = TierRepresentation::raw;
    /// Dimensions of a latent without the batch; empty unless the representation is latent.
    std::vector<std::int64_t> latentShape;
    /// Measured figures as compact JSON objects.
    std::string accuracyJson;
    std::string costJson;
    /// The tier's measured error: its spectral distance plus the 90th percentile of its level error. Empty if one of
    /// them was not measured.
    std::optional<double> errorDb;

    /// False for a tier that is evaluated once.
    [[nodiscard]] bool isSolved() const noexcept { return kind == TierKind::flow || kind == TierKind::averageVelocity; }
    /// True for a tier whose level, filter, lines and impulses come from the model's skeleton.
    [[nodiscard]] bool usesSkeleton() const noexcept { return kind == TierKind::skeleton || kind == TierKind::refine; }
    /// True for a tier that has graphs.
    [[nodiscard]] bool needsOnnxRuntime() const noexcept { return kind != TierKind::skeleton; }
};

/// The model's skeleton. The sizes are those of the format.
struct SkeletonHeader {
    /// Coefficients of the filter.
    static constexpr std::size_t order = 24;
    /// Harmonics of the lines and of the swing of the drive's gain.
    static constexpr std::size_t harmonics = 14;
    static constexpr std::size_t swingHarmonics = 5;
    /// Heights in the noise, in standard deviations, beyond which it makes an impulse.
    static constexpr std::array<double, 5> impulseThresholds{2.0, 2.6, 3.1, 3.5, 4.0};

    /// Hidden units of the perceptron, and weights of skeleton and level.
    std::int64_t hidden = 0;
    std::int64_t parameters = 0;
};
/// The tensor of ModelFile::pieceOffsets.
inline constexpr std::string_view piecesTensor = "pieces";
/// The tensor that stands for the skeleton in the model's space.
inline constexpr std::string_view skeletonTensor = "skeleton.4.weight";

/// Indices of the tiers, the least accurate first; equally accurate ones in the file's order. If a tier was not
/// measured, all are in the file's order.
[[nodiscard]] std::vector<std::size_t> tiersByAccuracy(const std::vector<Tier>& tiers);

struct SeedEntry {
    /// Index in ModelHeader::labels.
    std::size_t label = 0;
    std::array<double, 2> velocityMps{};
    double forceNewtons = 0.0;
    /// Phase along each wave vector of the label, in cycles, at the seed's sample 200, the first one that is played; 0
    /// if not given.
    std::array<double, 2> ribPhase{};
    /// RMS of the played seed relative to the level at its motion.
    float gain = 1.0F;
};

enum class BlobType { float32, onnx };

struct Blob {
    std::string name;
    BlobType type = BlobType::float32;
    std::vector<std::int64_t> shape;
    std::size_t offset = 0;
    std::size_t bytes = 0;
    std::uint32_t crc32 = 0;
};

/// The JSON header; all of its values are checked, individually and against each other. The blobs' bytes are not.
struct ModelHeader {
    std::string name;
    std::string description;
    Provenance provenance;
    double peakMps2 = 0.0;
    TrainedInterval speedMps;
    TrainedInterval forceNewtons;
    std::vector<Label> labels;
    std::vector<Tier> tiers;
    /// Index in `tiers`.
    std::size_t defaultTier = 0;
    /// What touches begin with: either a skeleton, or seeds in the tensor of this name.
    std::optional<SkeletonHeader> skeleton;
    std::string seedTensor;
    std::vector<SeedEntry> seeds;
    std::vector<Blob> blobs;
};

/// The root mean square of a seed, and whether it is 1 within 1 %, as the formats require.
[[nodiscard]] double rmsOf(std::span<const float> samples);
[[nodiscard]] bool isUnitRms(std::span<const float> samples);

/// Identifies the embedding space of the model's networks: 8 hexadecimal digits in lower case, the CRC-32 of
/// "name:crc;" for each tier in the file's order, where crc is that of its graph, or for kind `skeleton` of the tensor
/// skeletonTensor.
[[nodiscard]] std::string spaceOf(const ModelHeader& header);

/// Parses the header's text. Throws ModelError that names the key.
[[nodiscard]] ModelHeader readHeader(std::string_view text);

/// The file's names of the values: "flow", "average-velocity", "direct", and so on.
[[nodiscard]] std::string_view kindName(TierKind kind) noexcept;
[[nodiscard]] std::string_view solverName(SolverKind solver) noexcept;

}  // namespace haptoflow::model
