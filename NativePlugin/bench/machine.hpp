#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace haptoflow::bench {

/// Processor, cores, system and build, in words: times mean nothing without them. Nothing that names the machine.
[[nodiscard]] nlohmann::ordered_json machineWords(const std::string& onnxRuntimeVersion);

/// Programs that wanted a core over the last minute, this one included; null where the system does not tell.
[[nodiscard]] nlohmann::ordered_json loadAverage();

/// YYYY-MM-DD, of the universal time.
[[nodiscard]] std::string today();

}  // namespace haptoflow::bench
