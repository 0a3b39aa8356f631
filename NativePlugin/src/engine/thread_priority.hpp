#pragma once

namespace haptoflow::engine {

/// Asks the system to schedule the calling thread before ordinary ones, as far as the process may; where it may not,
/// nothing changes. Returns whether the system agreed. Takes no real-time priority: inference is long, and a real-time
/// thread that is busy starves the audio thread that it works for.
bool raiseThisThreadsPriority() noexcept;

/// Names the calling thread for debuggers and profilers; at most 15 characters are kept.
void nameThisThread(const char* name) noexcept;

}  // namespace haptoflow::engine
