#pragma once

#include <span>
#include <string>

namespace haptoflow::cli {

/// If the steps between times, in s, are more likely milliseconds, microseconds or nanoseconds, what was found and what
/// is expected; otherwise empty. `metres` is the way that was covered in them: by its speed a slow stroke with few
/// samples differs from a fast one in another unit.
[[nodiscard]] std::string unitOfTimes(std::span<const double> steps, double metres);

}  // namespace haptoflow::cli
