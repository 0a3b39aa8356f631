#include "allocation_counter.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAPTOFLOW_TEST_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HAPTOFLOW_TEST_SANITIZED 1
#endif
#endif

namespace {

// The initial-exec model, because reading other thread-local variables may allocate.
__attribute__((tls_model("initial-exec"))) thread_local bool isCounting = false;
__attribute__((tls_model("initial-exec"))) thread_local std::size_t callCount = 0;

void count() {
    if (isCounting) {
        ++callCount;
    }
}

}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming): the names are given by the runtimes.
#if defined(HAPTOFLOW_TEST_SANITIZED)

// A sanitizer has its own allocator, which offers hooks. They are declared here because GCC does not ship the header.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void* memory,
                                                                           std::size_t size),
                                                         void (*freed)(const volatile void* memory));

namespace {
const int installed = __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { count(); },
                                                                [](const volatile void*) { count(); });
}  // namespace

#else

// The program's heap functions take precedence over those of every library; glibc offers its own under these names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);

void* malloc(std::size_t size) {
    count();
    return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
    count();
    return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
    count();
    return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
    count();
    return __libc_memalign(alignment, size);
}
void free(void* memory) {
    count();
    __libc_free(memory);
}
}

#endif
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)

namespace haptoflow::unity::testing {

AllocationCounter::AllocationCounter() {
    callCount = 0;
    isCounting = true;
}

AllocationCounter::~AllocationCounter() {
    isCounting = false;
}

std::size_t AllocationCounter::calls() const {
    return callCount;
}

}  // namespace haptoflow::unity::testing
