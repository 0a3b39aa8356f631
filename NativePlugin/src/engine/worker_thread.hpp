#pragma once

#include <memory>

namespace haptoflow::engine {

/// Wakes one sleeping thread. `post` never waits for anybody, but may enter the kernel: not for an audio callback.
class WakeSignal {
public:
    /// Throws std::system_error where the system has no semaphore left.
    WakeSignal();
    WakeSignal(const WakeSignal&) = delete;
    WakeSignal& operator=(const WakeSignal&) = delete;
    ~WakeSignal();

    void post() noexcept;
    /// Sleeps until a post; any number of posts before it count as one.
    void wait() noexcept;
    /// The same, but at most so long; false when time ran out.
    bool waitFor(double milliseconds) noexcept;

private:
    struct Semaphore;
    std::unique_ptr<Semaphore> semaphore_;
};

/// Asks the system to schedule the calling thread before ordinary ones, as far as the process may; where it may not,
/// nothing changes. Returns whether the system agreed. Takes no real-time priority: inference is long, and a real-time
/// thread that is busy starves the audio thread that it works for.
bool raiseThisThreadsPriority() noexcept;

/// Names the calling thread for debuggers and profilers; at most 15 characters are kept.
void nameThisThread(const char* name) noexcept;

}  // namespace haptoflow::engine
