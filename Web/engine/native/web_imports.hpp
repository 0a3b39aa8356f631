#pragma once

#include <array>
#include <cstdint>

// What the scripts of Web/engine/js give to the module: see runtime.mjs and module.mjs there.

/// A tensor of a run; the layout is read by runtime.mjs.
struct HaptoTensor {
    const char* name;
    float* data;
    std::int32_t count;
    std::int32_t rank;
    std::array<std::int32_t, 6> shape;
};

#define HAPTO_IMPORT(name) __attribute__((import_module("env"), import_name(name)))

extern "C" {

/// ONNX Runtime for the web, in the worker's thread. A handle of 0 or more, or -1.
HAPTO_IMPORT("hapto_ort_load") int hapto_ort_load(const void* bytes, int count);
HAPTO_IMPORT("hapto_ort_input_count") int hapto_ort_input_count(int graph);
HAPTO_IMPORT("hapto_ort_has_input") int hapto_ort_has_input(int graph, const char* name);
HAPTO_IMPORT("hapto_ort_has_output") int hapto_ort_has_output(int graph, const char* name);
/// The last tensor is the output. 0 on success.
HAPTO_IMPORT("hapto_ort_run") int hapto_ort_run(int graph, const HaptoTensor* tensors, int count);
HAPTO_IMPORT("hapto_ort_release") void hapto_ort_release(int graph);
/// Writes what the last failure was, with a final zero byte.
HAPTO_IMPORT("hapto_ort_error") void hapto_ort_error(char* text, int capacity);

/// A long call reports its share, 0 to 1, and what it does now.
HAPTO_IMPORT("hapto_progress") void hapto_progress(double share, const char* doing);
}

/// Functions that the scripts call.
#define HAPTO_EXPORT extern "C" __attribute__((used, visibility("default")))
#define HAPTO_NAMED(name) __attribute__((export_name(name)))
