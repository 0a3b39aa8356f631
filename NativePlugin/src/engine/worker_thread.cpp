#include "engine/worker_thread.hpp"

#include <cerrno>
#include <system_error>

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

#include <array>
#include <cmath>
#elif defined(__EMSCRIPTEN__)
#include <atomic>
#include <cstdint>
#elif defined(__APPLE__)
#include <dispatch/dispatch.h>
#include <pthread.h>
#include <pthread/qos.h>
#else
#include <semaphore.h>
#include <time.h>
#endif
#if defined(__linux__)
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace haptoflow::engine {

#if defined(_WIN32)

#ifndef CREATE_WAITABLE_TIMER_HIGH_RESOLUTION
#define CREATE_WAITABLE_TIMER_HIGH_RESOLUTION 0x00000002
#endif

struct WakeSignal::Semaphore {
    HANDLE event = CreateEventW(nullptr, FALSE, FALSE, nullptr);
    // Other waits end with a tick of the system's timer, up to 15.6 ms late. Null before Windows 10, version 1803.
    HANDLE timer = CreateWaitableTimerExW(nullptr, nullptr, CREATE_WAITABLE_TIMER_HIGH_RESOLUTION,
                                          SYNCHRONIZE | TIMER_MODIFY_STATE);
};

WakeSignal::WakeSignal() : semaphore_(std::make_unique<Semaphore>()) {
    if (semaphore_->event == nullptr) {
        throw std::system_error(static_cast<int>(GetLastError()), std::system_category(), "wake signal");
    }
}

WakeSignal::~WakeSignal() {
    CloseHandle(semaphore_->event);
    if (semaphore_->timer != nullptr) {
        CloseHandle(semaphore_->timer);
    }
}

void WakeSignal::post() noexcept {
    SetEvent(semaphore_->event);
}

void WakeSignal::wait() noexcept {
    WaitForSingleObject(semaphore_->event, INFINITE);
}

bool WakeSignal::waitFor(double milliseconds) noexcept {
    LARGE_INTEGER due;
    // Negative for a time from now, in units of 100 ns.
    due.QuadPart = -static_cast<LONGLONG>(milliseconds * 1e4);
    if (semaphore_->timer == nullptr || SetWaitableTimer(semaphore_->timer, &due, 0, nullptr, nullptr, FALSE) == 0) {
        return WaitForSingleObject(semaphore_->event, static_cast<DWORD>(std::ceil(milliseconds))) == WAIT_OBJECT_0;
    }
    // Of two that are signalled, the first is reported.
    const std::array<HANDLE, 2> either{semaphore_->event, semaphore_->timer};
    return WaitForMultipleObjects(static_cast<DWORD>(either.size()), either.data(), FALSE, INFINITE) == WAIT_OBJECT_0;
}

#elif defined(__EMSCRIPTEN__)

// Emscripten's semaphores need its own threads. Posting is allowed on a page's main thread, which must not wait.
struct WakeSignal::Semaphore {
    std::atomic<int> isPosted{0};
    static_assert(sizeof(isPosted) == sizeof(int));

    void waitFor(std::int64_t nanoseconds) noexcept {
        (void)__builtin_wasm_memory_atomic_wait32(reinterpret_cast<int*>(&isPosted), 0, nanoseconds);
    }
};

WakeSignal::WakeSignal() : semaphore_(std::make_unique<Semaphore>()) {}

WakeSignal::~WakeSignal() = default;

void WakeSignal::post() noexcept {
    semaphore_->isPosted.store(1);
    (void)__builtin_wasm_memory_atomic_notify(reinterpret_cast<int*>(&semaphore_->isPosted), 1);
}

void WakeSignal::wait() noexcept {
    constexpr std::int64_t forever = -1;
    while (semaphore_->isPosted.exchange(0) == 0) {
        semaphore_->waitFor(forever);
    }
}

bool WakeSignal::waitFor(double milliseconds) noexcept {
    if (semaphore_->isPosted.exchange(0) == 0) {
        semaphore_->waitFor(static_cast<std::int64_t>(milliseconds * 1e6));
        return semaphore_->isPosted.exchange(0) != 0;
    }
    return true;
}

#elif defined(__APPLE__)

struct WakeSignal::Semaphore {
    dispatch_semaphore_t handle = dispatch_semaphore_create(0);
};

WakeSignal::WakeSignal() : semaphore_(std::make_unique<Semaphore>()) {}

WakeSignal::~WakeSignal() {
    dispatch_release(semaphore_->handle);
}

void WakeSignal::post() noexcept {
    dispatch_semaphore_signal(semaphore_->handle);
}

void WakeSignal::wait() noexcept {
    dispatch_semaphore_wait(semaphore_->handle, DISPATCH_TIME_FOREVER);
    while (dispatch_semaphore_wait(semaphore_->handle, DISPATCH_TIME_NOW) == 0) {
    }
}

bool WakeSignal::waitFor(double milliseconds) noexcept {
    const dispatch_time_t until = dispatch_time(DISPATCH_TIME_NOW, static_cast<int64_t>(milliseconds * 1e6));
    if (dispatch_semaphore_wait(semaphore_->handle, until) != 0) {
        return false;
    }
    while (dispatch_semaphore_wait(semaphore_->handle, DISPATCH_TIME_NOW) == 0) {
    }
    return true;
}

#else

namespace {

// Prefer a monotonic clock: with the wall clock, a clock change could turn 2 ms into an hour. Not every C library
// offers the choice.
#if defined(__GLIBC__)
constexpr clockid_t waitClock = CLOCK_MONOTONIC;

int waitUntil(sem_t& semaphore, const timespec& until) noexcept {
    return sem_clockwait(&semaphore, waitClock, &until);
}
#elif defined(__ANDROID_API__) && __ANDROID_API__ >= 28
constexpr clockid_t waitClock = CLOCK_MONOTONIC;

int waitUntil(sem_t& semaphore, const timespec& until) noexcept {
    return sem_timedwait_monotonic_np(&semaphore, &until);
}
#else
constexpr clockid_t waitClock = CLOCK_REALTIME;

int waitUntil(sem_t& semaphore, const timespec& until) noexcept {
    return sem_timedwait(&semaphore, &until);
}
#endif

}  // namespace

struct WakeSignal::Semaphore {
    sem_t handle{};

    /// Further posts count as the one that ended a wait.
    void clear() noexcept {
        while (sem_trywait(&handle) == 0) {
        }
    }
};

WakeSignal::WakeSignal() : semaphore_(std::make_unique<Semaphore>()) {
    if (sem_init(&semaphore_->handle, 0, 0) != 0) {
        throw std::system_error(errno, std::generic_category(), "wake signal");
    }
}

WakeSignal::~WakeSignal() {
    sem_destroy(&semaphore_->handle);
}

void WakeSignal::post() noexcept {
    sem_post(&semaphore_->handle);
}

void WakeSignal::wait() noexcept {
    while (sem_wait(&semaphore_->handle) != 0 && errno == EINTR) {
    }
    semaphore_->clear();
}

bool WakeSignal::waitFor(double milliseconds) noexcept {
    timespec until{};
    clock_gettime(waitClock, &until);
    constexpr long second = 1'000'000'000L;
    const auto nanoseconds = static_cast<long long>(milliseconds * 1e6) + until.tv_nsec;
    until.tv_sec += static_cast<time_t>(nanoseconds / second);
    until.tv_nsec = static_cast<long>(nanoseconds % second);
    while (waitUntil(semaphore_->handle, until) != 0) {
        if (errno != EINTR) {
            return false;
        }
    }
    semaphore_->clear();
    return true;
}

#endif

bool raiseThisThreadsPriority() noexcept {
#if defined(_WIN32)
    return SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_ABOVE_NORMAL) != 0;
#elif defined(__APPLE__)
    return pthread_set_qos_class_self_np(QOS_CLASS_USER_INTERACTIVE, 0) == 0;
#elif defined(__linux__)
    // On Linux and Android, niceness applies to a thread; -10 is Android's "urgent display".
    constexpr int urgent = -10;
    const auto thread = static_cast<id_t>(syscall(SYS_gettid));
    return setpriority(PRIO_PROCESS, thread, urgent) == 0;
#else
    return false;
#endif
}

void nameThisThread([[maybe_unused]] const char* name) noexcept {
#if defined(__APPLE__)
    pthread_setname_np(name);
#elif defined(__linux__)
    pthread_setname_np(pthread_self(), name);
#endif
}

}  // namespace haptoflow::engine
