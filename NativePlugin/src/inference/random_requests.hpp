#pragma once

#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::bench {

/// Requests for which one segment is timed, natively and in browsers: the same number in both, so that they are the
/// same.
inline constexpr std::size_t requestCount = 64;

/// Random requests as live voices make them. Labels and motions lie within the recorded range; the previous waveform
/// and the noise are standard normal.
class RandomRequests {
public:
    RandomRequests(const model::ModelFile& model, std::size_t count, std::uint64_t seed);

    /// The next `count` requests, starting again after the last one; `count` is at most their number.
    [[nodiscard]] std::span<const inference::SegmentRequest> next(std::size_t count);

private:
    std::vector<float> waves_;
    std::vector<inference::SegmentRequest> requests_;
    std::size_t at_ = 0;
};

}  // namespace haptoflow::bench
