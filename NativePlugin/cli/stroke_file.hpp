#pragma once

#include "headless/contact_types.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

/// A recorded movement of the tip: one or more samples, their times never decreasing.
struct Stroke {
    std::vector<headless::TipSample> samples;
};

/// Reads STROKE.csv (Documentation~/scene-and-stroke.md). Throws InputError naming file, line and column.
[[nodiscard]] Stroke readStrokeFile(const std::string& path);

/// The same from text already read; `fileName` is what errors call it.
[[nodiscard]] Stroke parseStroke(std::string_view text, const std::string& fileName);

/// The tip at a time: position and force on a straight line between the samples around it, orientation turned the
/// short way, the ends held outside. Of samples at the same time the last counts from then on. The stroke must have
/// a sample.
[[nodiscard]] headless::TipSample sampleStroke(const Stroke& stroke, double timeSeconds);

/// How many frames 1 / updateRateHz apart fit from the first sample to the last. Throws InputError above ten
/// million.
[[nodiscard]] std::size_t frameCount(const Stroke& stroke, double updateRateHz, const std::string& fileName);

/// The tip at frame `index`, at index / updateRateHz after the first sample.
[[nodiscard]] headless::TipSample frameAt(const Stroke& stroke, double updateRateHz, std::size_t index);

}  // namespace haptoflow::cli
