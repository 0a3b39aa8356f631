#include "realtime/forbidden_calls.hpp"

#include <dlfcn.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>

// glibc's internal names of its allocator. The interposed functions call them directly, because looking up the
// originals with the loader would allocate.
extern "C" {
void* __libc_malloc(std::size_t size);
void __libc_free(void* memory);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace haptoflow::realtime {
namespace {

thread_local int watching = 0;
std::atomic<std::uint64_t> calls{0};
std::atomic<const char*> lastCall{""};

void note(const char* name) noexcept {
    if (watching > 0) {
        calls.fetch_add(1, std::memory_order_relaxed);
        lastCall.store(name, std::memory_order_relaxed);
    }
}

/// Notes a call and forwards it to the C library's function of this name, which `Own` stands before.
template <auto Own, typename... Arguments>
int forward(const char* name, Arguments... arguments) {
    note(name);
    static const auto original = reinterpret_cast<int (*)(Arguments...)>(dlsym(RTLD_NEXT, name));
    return original(arguments...);
}

}  // namespace

WatchedSection::WatchedSection() noexcept {
    ++watching;
}

WatchedSection::~WatchedSection() {
    --watching;
}

std::uint64_t forbiddenCalls() noexcept {
    return calls.load();
}

const char* lastForbiddenCall() noexcept {
    return lastCall.load();
}

}  // namespace haptoflow::realtime

using haptoflow::realtime::forward;
using haptoflow::realtime::note;

extern "C" {

void* malloc(std::size_t size) {
    note("malloc");
    return __libc_malloc(size);
}

void free(void* memory) {
    note("free");
    __libc_free(memory);
}

void* calloc(std::size_t count, std::size_t size) {
    note("calloc");
    return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
    note("realloc");
    return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
    note("aligned_alloc");
    return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
    note("posix_memalign");
    *memory = __libc_memalign(alignment, size);
    return *memory == nullptr ? ENOMEM : 0;
}

void* memalign(std::size_t alignment, std::size_t size) {
    note("memalign");
    return __libc_memalign(alignment, size);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    return forward<pthread_mutex_lock>("pthread_mutex_lock", mutex);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
    return forward<pthread_mutex_trylock>("pthread_mutex_trylock", mutex);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
    return forward<pthread_rwlock_rdlock>("pthread_rwlock_rdlock", lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
    return forward<pthread_rwlock_wrlock>("pthread_rwlock_wrlock", lock);
}

int pthread_once(pthread_once_t* control, void (*routine)()) {
    return forward<pthread_once>("pthread_once", control, routine);
}

int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
    return forward<pthread_cond_wait>("pthread_cond_wait", condition, mutex);
}

int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
    return forward<pthread_cond_broadcast>("pthread_cond_broadcast", condition);
}

int pthread_cond_signal(pthread_cond_t* condition) noexcept {
    return forward<pthread_cond_signal>("pthread_cond_signal", condition);
}

int sem_post(sem_t* semaphore) noexcept {
    return forward<sem_post>("sem_post", semaphore);
}

int sem_wait(sem_t* semaphore) {
    return forward<sem_wait>("sem_wait", semaphore);
}

int sem_trywait(sem_t* semaphore) noexcept {
    return forward<sem_trywait>("sem_trywait", semaphore);
}

}  // extern "C"

namespace haptoflow::realtime {
namespace {

std::atomic<std::uint64_t> trapped{0};
std::atomic<long> lastTrapped{-1};

void onTrap(int, siginfo_t* information, void* context) {
    trapped.fetch_add(1);
    lastTrapped.store(information->si_syscall);
    static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RAX] = -ENOSYS;
}

}  // namespace

bool trapSystemCalls() noexcept {
    struct sigaction action {};
    action.sa_sigaction = onTrap;
    action.sa_flags = SA_SIGINFO | SA_NODEFER;
    if (sigaction(SIGSYS, &action, nullptr) != 0 || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
        return false;
    }
    // The filter allows the end of the thread and the return from the trap's signal handler.
    std::array<sock_filter, 5> filter{{
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit, 2, 0),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_rt_sigreturn, 1, 0),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    }};
    const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
    return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

std::uint64_t trappedSystemCalls() noexcept {
    return trapped.load();
}

long lastTrappedSystemCall() noexcept {
    return lastTrapped.load();
}

void leaveThread() noexcept {
    syscall(SYS_exit, 0);
    __builtin_unreachable();
}

}  // namespace haptoflow::realtime
