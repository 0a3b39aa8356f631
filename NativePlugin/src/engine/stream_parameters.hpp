#pragma once

#include "engine/contact_messages.hpp"
#include "engine/material.hpp"
#include "engine/material_library.hpp"
#include "model/model_header.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "skeleton/stream.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace haptoflow::engine {

/// A smooth random field at one point of a path: its value, and its change over the way of one sample.
struct WanderPoint {
    double value = 0.0;
    double changePerSample = 0.0;
};

/// A smooth random field of RMS 1 over a surface, where `path` begins. The same place has the same value; fields of
/// different keys are independent. It is a sum of twelve plane waves in random directions whose lengths lie within half
/// an octave of `wavelengthMetres`, which must be above 0. Any thread; no allocation.
[[nodiscard]] WanderPoint surfaceWander(std::uint64_t key, double wavelengthMetres,
                                        const skeleton::SurfacePath& path) noexcept;

/// Slips in a second for the network's motion (m/s along both axes, N); 0 for a material that does not slip. `wander`:
/// by how many deviations the way from slip to slip differs from its mean.
[[nodiscard]] double slipsHz(const model::StickSlip& slip, const std::array<float, 3>& motion, double wander) noexcept;

/// Samples from the publishing of a contact to one that lies `samples` behind the first sample of a block, which began
/// `sincePublishedSeconds` after the publishing. A tip that has not reported for a quarter of a second is not guessed
/// any further.
[[nodiscard]] double samplesSincePublished(double samples, double readingRate, double sincePublishedSeconds) noexcept;

/// Makes of each contact what the stream plays from then on. Main thread; allocates nothing.
///
/// The place tells the ribs' phase only while that is right until the next state: inside the trained range, where the
/// network's speed is the tip's, and on a flat surface, whose axes do not turn.
class StreamParameterMaker {
public:
    /// `native` is empty for a model without a skeleton. `seed` and `voice` key the surfaces.
    StreamParameterMaker(skeleton::NativeParts native, std::uint64_t seed, std::uint32_t voice) noexcept;

    /// `renderedSeconds`: time that was rendered so far. `seedPhase`: turns of the ribs with which a stream begins
    /// where the place does not tell them.
    [[nodiscard]] skeleton::StreamParameters make(const PublishedContact& contact, const MaterialInputs& material,
                                                  const Ingredients& ingredients, double renderedSeconds,
                                                  const std::array<double, 2>& seedPhase) noexcept;

private:
    [[nodiscard]] std::uint64_t surfaceOf(const PublishedContact& contact) const noexcept;
    [[nodiscard]] skeleton::SurfacePath pathOf(const PublishedContact& contact, double renderedSeconds) noexcept;
    [[nodiscard]] bool isFlat(const PublishedContact& contact) noexcept;
    [[nodiscard]] float levelOf(const PublishedContact& contact, const MaterialInputs& material) const noexcept;
    /// A factor on the level of a blend, which keeps it between those of its materials: the filter of a mean of
    /// embeddings may be 4 dB louder or softer than asked for.
    [[nodiscard]] float balanceOf(const PublishedContact& contact, const Ingredients& ingredients,
                                  double logPower) const noexcept;

    skeleton::NativeParts native_;
    std::uint64_t seed_;
    std::uint32_t voice_;
    // Way so far of a touch without a place, for the waves' wander: the newest contact's and its time.
    std::uint64_t touch_ = 0;
    std::array<double, 3> placeMetres_{};
    std::array<double, 3> velocityMps_{};
    double placeSeconds_ = 0.0;
    /// The surface and the tip's place on it, with the axes there.
    struct Anchor {
        std::uint32_t surfaceSeed = 0;
        std::array<float, 3> placeMetres{};
        std::array<float, 3> firstAxis{};
        std::array<float, 3> secondAxis{};
    };
    // Where the axes last turned; empty before the first place of an onset. The surface counts as flat once the tip has
    // moved far enough from there.
    std::optional<Anchor> anchor_;
    std::uint32_t onset_ = 0;
    bool isFlat_ = false;
};

}  // namespace haptoflow::engine
