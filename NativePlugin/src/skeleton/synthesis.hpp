#pragma once

#include "skeleton/excitation.hpp"
#include "skeleton/skeleton.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <span>

namespace haptoflow::skeleton {

/// Makes the skeleton's waveform, piece by piece: a filter that continues its own past, driven by noise, which swings
/// with the waves, by the waves' lines and by impulses that ring on. A plain value; allocates nothing.
class Synthesis {
public:
    /// Begins with a past that this filter could have, made of standard normal numbers.
    void begin(const ReflectionFilter& filter, std::span<const float, filterOrder> noise) noexcept;
    /// Begins with this past in unit scale, limited to +-16.
    void begin(std::span<const float, filterOrder> past) noexcept;
    /// The parameters are about to change, and with them the unit, by this factor: what has sounded stays what it was.
    /// The past is limited to +-16, so that it stays bounded for every sequence of filters and levels.
    void rescale(float factor) noexcept;
    /// Writes the next samples in unit scale, limited to +-16; at most 32. `noise` is standard normal and is limited to
    /// +-9, what is not a number counts as 0. `view`: where to write what the refining graph sees.
    void next(const TailImpulses& tails, const SkeletonParameters& parameters,
              const std::array<FamilyPhase, familyCount>& phases, std::span<const float> noise, std::span<float> unit,
              NetworkView view = {}) noexcept;

private:
    std::array<double, filterOrder> past_{};
    TailImpulses::Ringing ringing_{};
};

/// What precedes a segment that no stream continues. The spans must live while it is used.
struct SegmentStart {
    Phases phases{};
    /// The 200 samples before the segment in unit scale, limited to +-16.
    Segment previous;
    Segment noise;
};

/// The segment, in unit scale, with all that the refining graph sees.
[[nodiscard]] NetworkInput synthesiseSegment(const Skeleton& skeleton, const SkeletonParameters& parameters,
                                             const SegmentStart& start) noexcept;

}  // namespace haptoflow::skeleton
