/* Lets a library that is linked on a newer Linux load where the C library is glibc 2.31 (Ubuntu 20.04, Debian 11).
 *
 * A linker binds every function to its newest version, and the loader of an older system refuses a library that wants a
 * version it does not have. The functions below got a new version after 2.31: most of them, unchanged, when glibc 2.34
 * moved them from libpthread and libdl into libc. The definitions here take the place of the C library's for the
 * plugin's own code and for the C++ library in it, and call the version that has been there all along. Only the plugin
 * is linked with this file; its version script keeps the names inside. GlibcTest (Tests/Native/capi/glibc_test.cpp)
 * names a function that is still missing here. */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdint.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#if defined(__x86_64__)
#define FIRST_VERSION "GLIBC_2.2.5"
#define VERSION_OF_THREAD_NAMES "GLIBC_2.12"
#elif defined(__aarch64__)
#define FIRST_VERSION "GLIBC_2.17"
#define VERSION_OF_THREAD_NAMES "GLIBC_2.17"
#else
#error "the first versions of glibc's functions are known for x86-64 and arm64 only"
#endif
#define VERSION_OF_CLOCK_WAITS "GLIBC_2.30"

/* The header says that pthread_setspecific does not read through its pointer, which GCC 12 takes for an unset argument.
 */
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

/* Defines a function that calls an older version of itself. */
#define CALL_VERSION(version, result, name, parameters, arguments) \
    result older_##name parameters;                                \
    __asm__(".symver older_" #name ", " #name "@" version);        \
    result name parameters {                                       \
        return older_##name arguments;                             \
    }

CALL_VERSION(FIRST_VERSION, void*, dlopen, (const char* path, int mode), (path, mode))
CALL_VERSION(FIRST_VERSION, void*, dlsym, (void* restrict library, const char* restrict name), (library, name))
CALL_VERSION(FIRST_VERSION, int, dlclose, (void* library), (library))
CALL_VERSION(FIRST_VERSION, char*, dlerror, (void), ())

CALL_VERSION(FIRST_VERSION, int, sem_init, (sem_t * semaphore, int shared, unsigned int value),
             (semaphore, shared, value))
CALL_VERSION(FIRST_VERSION, int, sem_destroy, (sem_t * semaphore), (semaphore))
CALL_VERSION(FIRST_VERSION, int, sem_post, (sem_t * semaphore), (semaphore))
CALL_VERSION(FIRST_VERSION, int, sem_wait, (sem_t * semaphore), (semaphore))
CALL_VERSION(FIRST_VERSION, int, sem_trywait, (sem_t * semaphore), (semaphore))
CALL_VERSION(VERSION_OF_CLOCK_WAITS, int, sem_clockwait,
             (sem_t* restrict semaphore, clockid_t clock, const struct timespec* restrict until),
             (semaphore, clock, until))

CALL_VERSION(FIRST_VERSION, int, pthread_create,
             (pthread_t* restrict thread, const pthread_attr_t* restrict attributes, void* (*start)(void*),
              void* restrict argument),
             (thread, attributes, start, argument))
CALL_VERSION(FIRST_VERSION, int, pthread_join, (pthread_t thread, void** result), (thread, result))
CALL_VERSION(FIRST_VERSION, int, pthread_detach, (pthread_t thread), (thread))
CALL_VERSION(VERSION_OF_THREAD_NAMES, int, pthread_setname_np, (pthread_t thread, const char* name), (thread, name))
CALL_VERSION(FIRST_VERSION, int, pthread_once, (pthread_once_t * control, void (*routine)(void)), (control, routine))
CALL_VERSION(FIRST_VERSION, int, pthread_key_create, (pthread_key_t * key, void (*destructor)(void*)),
             (key, destructor))
CALL_VERSION(FIRST_VERSION, int, pthread_key_delete, (pthread_key_t key), (key))
CALL_VERSION(FIRST_VERSION, void*, pthread_getspecific, (pthread_key_t key), (key))
CALL_VERSION(FIRST_VERSION, int, pthread_setspecific, (pthread_key_t key, const void* value), (key, value))
CALL_VERSION(FIRST_VERSION, int, pthread_mutex_trylock, (pthread_mutex_t * mutex), (mutex))
CALL_VERSION(FIRST_VERSION, int, pthread_rwlock_rdlock, (pthread_rwlock_t * lock), (lock))
CALL_VERSION(FIRST_VERSION, int, pthread_rwlock_wrlock, (pthread_rwlock_t * lock), (lock))
CALL_VERSION(FIRST_VERSION, int, pthread_rwlock_unlock, (pthread_rwlock_t * lock), (lock))
CALL_VERSION(VERSION_OF_CLOCK_WAITS, int, pthread_cond_clockwait,
             (pthread_cond_t* restrict condition, pthread_mutex_t* restrict mutex, clockid_t clock,
              const struct timespec* restrict until),
             (condition, mutex, clock, until))

CALL_VERSION(FIRST_VERSION, double, hypot, (double x, double y), (x, y))
CALL_VERSION(FIRST_VERSION, float, hypotf, (float x, float y), (x, y))

/* New in 2.32: whether the process has one thread, so that reference counts need no atomic instruction. "No" is always
 * safe. */
char __libc_single_threaded = 0;

/* Functions since 2.33; before, inline functions of the headers. The kernel fills the C library's structure. */
int stat(const char* restrict path, struct stat* restrict result) {
    return (int)syscall(SYS_newfstatat, AT_FDCWD, path, result, 0);
}

int lstat(const char* restrict path, struct stat* restrict result) {
    return (int)syscall(SYS_newfstatat, AT_FDCWD, path, result, AT_SYMLINK_NOFOLLOW);
}

int fstat64(int file, struct stat64* result) {
    return (int)syscall(SYS_fstat, file, result);
}

/* New in 2.36; std::random_device takes it where the C++ library was built with it. */
uint32_t arc4random(void) {
    uint32_t bits = 0;
    while (getrandom(&bits, sizeof bits, 0) != (ssize_t)sizeof bits) {
    }
    return bits;
}
