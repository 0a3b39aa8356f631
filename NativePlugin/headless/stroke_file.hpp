#pragma once

#include "headless/contact_types.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::headless {

/// A recorded path of the tip: one or more samples with non-decreasing times.
struct Stroke {
    std::vector<TipSample> samples;
};

/// Reads STROKE.csv (Documentation~/scene-and-stroke.md). Throws InputError that names file, line and column.
[[nodiscard]] Stroke readStrokeFile(const std::string& path);

/// Reads a stroke from text; `fileName` is its name in errors.
[[nodiscard]] Stroke parseStroke(std::string_view text, const std::string& fileName);

/// The tip at a time: position and force are interpolated linearly between the neighbouring samples, the orientation
/// turns the shorter way; outside the stroke the first or last sample is used. Of several samples at the same time the
/// last one is valid from then on. The stroke must have a sample.
[[nodiscard]] TipSample sampleStroke(const Stroke& stroke, double timeSeconds);

/// The number of frames at the update rate from the first sample to the last. Throws InputError above ten million.
[[nodiscard]] std::size_t frameCount(const Stroke& stroke, double updateRateHz, const std::string& fileName);

/// The tip at frame `index`, index / updateRateHz seconds after the first sample.
[[nodiscard]] TipSample frameAt(const Stroke& stroke, double updateRateHz, std::size_t index);

/// Recognises times in milliseconds, microseconds or nanoseconds that are given as seconds: returns what was found and
/// what is expected, or nothing where they are plausible seconds. `steps` are the differences of the times; `metres` is
/// the length of the path, because the speed tells a slow stroke of few samples from a fast one in another unit.
[[nodiscard]] std::string unitOfTimes(std::span<const double> steps, double metres);

}  // namespace haptoflow::headless
