#include "web_text.hpp"

#include "haptoflow/haptoflow.h"
#include "headless/command_files.hpp"
#include "web_imports.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>
#include <string_view>

namespace haptoflow::web {
namespace {

thread_local std::string theText;
// Fixed, so that an error for want of memory has a text, too.
thread_local std::array<char, 64> theCode{};
thread_local std::array<char, 2048> theMessage{};

template <std::size_t Size>
void write(std::array<char, Size>& target, std::string_view text) noexcept {
    const std::size_t kept = std::min(text.size(), Size - 1);
    std::copy_n(text.begin(), kept, target.begin());
    target[kept] = '\0';
}

int report(std::string_view code, std::string_view message) noexcept {
    write(theCode, code);
    write(theMessage, message);
    return failure;
}

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
        throw;
    } catch (const WebError& error) {
        return report(error.code(), error.what());
    } catch (const headless::InputError& error) {
        return report("input", error.what());
    } catch (const std::invalid_argument& error) {
        return report("invalid-argument", error.what());
    } catch (const std::bad_alloc&) {
        return report("OUT_OF_MEMORY", "out of memory");
    } catch (const std::exception& error) {
        return report("INTERNAL_ERROR", error.what());
    } catch (...) {
        return report("INTERNAL_ERROR", "an exception of an unknown type");
    }
}

}  // namespace haptoflow::web

HAPTO_EXPORT HAPTO_NAMED("hapto_error_code") const char* hapto_error_code() {
    return haptoflow::web::theCode.data();
}

HAPTO_EXPORT HAPTO_NAMED("hapto_error_message") const char* hapto_error_message() {
    return haptoflow::web::theMessage.data();
}
