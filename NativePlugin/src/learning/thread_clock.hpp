#pragma once

namespace haptoflow::learning {

/// Seconds that the calling thread has worked since some moment; where the platform does not count them, seconds that
/// have gone by. For differences on one thread.
[[nodiscard]] double threadSeconds() noexcept;

}  // namespace haptoflow::learning
