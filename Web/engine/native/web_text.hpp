#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace haptoflow::web {

/// Statuses of functions that return an index or a handle: 0 or more on success, this minus a haptoflow_status
/// otherwise.
inline constexpr int failure = -1;

/// A call of the C interface failed, or an input is wrong.
class WebError : public std::runtime_error {
public:
    /// `code`: what HaptoFlowError.code is, see haptoflow.d.ts.
    WebError(std::string code, const std::string& message) : std::runtime_error(message), code_(std::move(code)) {}
    [[nodiscard]] const std::string& code() const noexcept { return code_; }

private:
    std::string code_;
};

/// Throws WebError with the message of the C interface unless the status is HAPTOFLOW_OK.
void require(int status);

/// Keeps a text for the script that called, until the next text of this thread; returns its address.
[[nodiscard]] const char* keep(std::string text);

/// Reports the exception that is being handled: hapto_error_code and hapto_error_message return it. Returns `failure`.
int reportException() noexcept;

/// Runs the body of an exported function that returns an index or 0.
template <typename Action>
[[nodiscard]] int guarded(Action&& action) noexcept {
    try {
        return action();
    } catch (...) {
        return reportException();
    }
}

/// Runs the body of an exported function that returns JSON; null on failure.
template <typename Action>
[[nodiscard]] const char* guardedText(Action&& action) noexcept {
    try {
        return keep(action());
    } catch (...) {
        (void)reportException();
        return nullptr;
    }
}

/// JSON of any text, invalid UTF-8 replaced.
[[nodiscard]] inline std::string dumped(const nlohmann::json& value) {
    return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace haptoflow::web
