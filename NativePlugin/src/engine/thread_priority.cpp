#include "engine/thread_priority.hpp"

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
#elif defined(__APPLE__)
#include <pthread.h>
#include <pthread/qos.h>
#elif defined(__linux__)
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace haptoflow::engine {

#if defined(_WIN32)

bool raiseThisThreadsPriority() noexcept {
    return SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_ABOVE_NORMAL) != 0;
}

void nameThisThread(const char*) noexcept {}

#elif defined(__APPLE__)

bool raiseThisThreadsPriority() noexcept {
    return pthread_set_qos_class_self_np(QOS_CLASS_USER_INTERACTIVE, 0) == 0;
}

void nameThisThread(const char* name) noexcept {
    pthread_setname_np(name);
}

#elif defined(__linux__)

bool raiseThisThreadsPriority() noexcept {
    // On Linux and Android niceness belongs to the thread; -10 is what Android calls urgent display.
    constexpr int urgent = -10;
    const auto thread = static_cast<id_t>(syscall(SYS_gettid));
    return setpriority(PRIO_PROCESS, thread, urgent) == 0;
}

void nameThisThread(const char* name) noexcept {
    pthread_setname_np(pthread_self(), name);
}

#else

bool raiseThisThreadsPriority() noexcept {
    return false;
}

void nameThisThread(const char*) noexcept {}

#endif

}  // namespace haptoflow::engine
