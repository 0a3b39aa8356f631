#pragma once

namespace haptoflow::learning {

/// Processor time of the calling thread in seconds; elapsed time on platforms that do not count it. Only differences on
/// one thread are meaningful.
[[nodiscard]] double threadSeconds() noexcept;

}  // namespace haptoflow::learning
