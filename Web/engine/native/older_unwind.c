/*
 * What a WebAssembly module needs of an unwinder, for Clang 14 (Debian's Emscripten) only. That compiler's landing pads
 * exchange data with the unwinder through one global object, while the unwinder in its library has one for each thread:
 * with shared memory no exception would find its handler. Here both use the one object.
 *
 * Two threads that handle exceptions within the same fraction of a microsecond could then disturb each other. The audio
 * thread throws none, page and worker only where a call fails. A newer Emscripten does not compile this file.
 */
#include <stddef.h>
#include <stdint.h>

enum { cleanup_phase = 2, foreign_exception_caught = 1, selector_register = 1 };

struct exception_object {
    uint64_t exception_class;
    void (*cleanup)(int reason, struct exception_object* object);
    uintptr_t private_1;
    uintptr_t private_2;
} __attribute__((aligned(16)));

struct landing_pad {
    uintptr_t index;
    uintptr_t language_data;
    uintptr_t selector;
};

struct landing_pad __wasm_lpad_context;

int __gxx_personality_wasm0(int version, int actions, uint64_t exception_class, struct exception_object* object,
                            struct landing_pad* pad);

int _Unwind_CallPersonality(void* object) {
    struct exception_object* const exception = object;
    __wasm_lpad_context.selector = 0;
    return __gxx_personality_wasm0(1, cleanup_phase, exception->exception_class, exception, &__wasm_lpad_context);
}

int _Unwind_RaiseException(struct exception_object* object) {
    __builtin_wasm_throw(0, object);
}

void _Unwind_DeleteException(struct exception_object* object) {
    if (object->cleanup != NULL) {
        object->cleanup(foreign_exception_caught, object);
    }
}

void _Unwind_SetGR(struct landing_pad* pad, int index, uintptr_t value) {
    if (index == selector_register) {
        pad->selector = value;
    }
}

/* The personality function takes 1 away, and counts from 1. */
uintptr_t _Unwind_GetIP(const struct landing_pad* pad) {
    return pad->index + 2;
}

void _Unwind_SetIP(struct landing_pad* pad, uintptr_t value) {
    (void)pad;
    (void)value;
}

uintptr_t _Unwind_GetLanguageSpecificData(const struct landing_pad* pad) {
    return pad->language_data;
}

uintptr_t _Unwind_GetRegionStart(const struct landing_pad* pad) {
    (void)pad;
    return 0;
}
