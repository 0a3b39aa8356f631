#pragma once

#include <span>
#include <string>

namespace haptoflow::cli {

/// Recognises times in milliseconds, microseconds or nanoseconds that are given as seconds: returns what was found and
/// what is expected, or nothing where they are plausible seconds. `steps` are the differences of the times; `metres` is
/// the length of the path, because the speed tells a slow stroke of few samples from a fast one in another unit.
[[nodiscard]] std::string unitOfTimes(std::span<const double> steps, double metres);

}  // namespace haptoflow::cli
