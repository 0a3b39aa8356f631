#pragma once

#include <memory>

namespace haptoflow::engine {

#if defined(__EMSCRIPTEN__)
/// A page starts its threads itself: one of them is the worker and calls LiveEngine::turn.
inline constexpr bool startsThreads = false;
#else
inline constexpr bool startsThreads = true;
#endif

/// Wakes one sleeping thread. `post` does not wait but may enter the kernel: not on the audio thread.
class WakeSignal {
public:
    /// Throws std::system_error if the system has no semaphore left.
    WakeSignal();
    WakeSignal(const WakeSignal&) = delete;
    WakeSignal& operator=(const WakeSignal&) = delete;
    ~WakeSignal();

    void post() noexcept;
    /// Sleeps until a post. Several posts before the call count as one.
    void wait() noexcept;
    /// Like `wait`, but for at most this time. Returns false if there was no post.
    bool waitFor(double milliseconds) noexcept;

private:
    struct Semaphore;
    std::unique_ptr<Semaphore> semaphore_;
};

/// Raises the calling thread's priority above that of ordinary threads, if the process has permission. Returns whether
/// the system allowed it. Does not use a real-time priority, because inference takes long and a busy real-time thread
/// would delay the audio thread.
bool raiseThisThreadsPriority() noexcept;

/// Names the calling thread for debuggers and profilers. At most 15 characters are kept.
void nameThisThread(const char* name) noexcept;

}  // namespace haptoflow::engine
