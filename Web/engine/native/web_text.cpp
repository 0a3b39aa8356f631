#include "web_text.hpp"

#include "haptoflow/haptoflow.h"
#include "input_file.hpp"
#include "web_imports.hpp"

#include <new>

namespace haptoflow::web {
namespace {

thread_local std::string theText;
thread_local std::string theCode;
thread_local std::string theMessage;

}  // namespace

void require(int status) {
    if (status != HAPTOFLOW_OK) {
        constexpr std::size_t prefix = sizeof("HAPTOFLOW_") - 1;
        throw WebError(std::string(haptoflow_status_name(status)).substr(prefix), haptoflow_last_message());
    }
}

const char* keep(std::string text) {
    theText = std::move(text);
    return theText.c_str();
}

int reportException() noexcept {
    try {
        try {
            throw;
        } catch (const WebError& error) {
            theCode = error.code();
            theMessage = error.what();
        } catch (const cli::InputError& error) {
            theCode = "input";
            theMessage = error.what();
        } catch (const std::invalid_argument& error) {
            theCode = "invalid-argument";
            theMessage = error.what();
        } catch (const std::bad_alloc&) {
            theCode = "OUT_OF_MEMORY";
            theMessage = "out of memory";
        } catch (const std::exception& error) {
            theCode = "INTERNAL_ERROR";
            theMessage = error.what();
        }
    } catch (...) {
        // Without memory for the text there is none.
    }
    return failure;
}

}  // namespace haptoflow::web

HAPTO_EXPORT HAPTO_NAMED("hapto_error_code") const char* hapto_error_code() {
    return haptoflow::web::theCode.c_str();
}

HAPTO_EXPORT HAPTO_NAMED("hapto_error_message") const char* hapto_error_message() {
    return haptoflow::web::theMessage.c_str();
}

HAPTO_EXPORT HAPTO_NAMED("hapto_version") const char* hapto_version() {
    return haptoflow_version();
}
