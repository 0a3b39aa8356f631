#ifndef HAPTOFLOW_TESTS_C11_USER_H
#define HAPTOFLOW_TESTS_C11_USER_H

#ifdef __cplusplus
extern "C" {
#endif

/* Opens everything, generates one segment of 200 samples and closes everything; returns the first status that is not
 * HAPTOFLOW_OK. */
int generateOneSegmentFromC(const char* onnxRuntimePath, const char* modelPath, float* segmentMps2);

#ifdef __cplusplus
}
#endif

#endif
