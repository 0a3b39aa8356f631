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
    /// Begins with this past in unit scale, limited to +-64.
    void begin(std::span<const float, filterOrder> past) noexcept;
    /// Scales a past beyond +-64 down to it. Before each change of the filter, it keeps the past bounded for every
    /// sequence of filters. All its samples are scaled alike, because limiting each by itself gives another past, whose
    /// response may grow to the limit again and never end.
    void limitPast() noexcept;
    /// Whether the past can go on in another filter. One that it would make ring 3 dB louder than the filter of before
    /// (a label's beside that of a rougher one) needs a past of its own.
    [[nodiscard]] bool fits(const ReflectionFilter& before, const ReflectionFilter& now) const noexcept;
    /// Begins anew with another filter, across a splice of 4 samples with what rings in the one of before.
    void replace(const ReflectionFilter& before, const ReflectionFilter& now,
                 std::span<const float, filterOrder> noise) noexcept;
    /// Writes the next samples in unit scale, limited to +-64; at most 32. `noise` is standard normal, limited to +-9;
    /// a NaN counts as 0. `view`: where to write what the refining graph sees.
    void next(const TailImpulses& tails, const SkeletonParameters& parameters,
              const std::array<FamilyPhase, familyCount>& phases, std::span<const float> noise, std::span<float> unit,
              NetworkView view = {}) noexcept;

private:
    static constexpr std::size_t ringOutSamples = 8;
    static constexpr std::size_t leavingSamples = 4;

    /// What the past makes of a filter that nothing drives.
    [[nodiscard]] std::array<float, ringOutSamples> ringOut(const ReflectionFilter& filter) const noexcept;
    void spliceInto(std::span<float> unit) noexcept;

    std::array<double, filterOrder> past_{};
    std::array<float, leavingSamples> leaving_{};
    std::size_t leavingLeft_ = 0;
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
