#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace haptoflow::bench {

/// Processor, cores, system and build, which every reported time depends on. Nothing in it identifies the machine.
[[nodiscard]] nlohmann::ordered_json machineWords(const std::string& onnxRuntimeVersion);

/// The system's load average over the last minute, this process included; null where the system does not report one.
[[nodiscard]] nlohmann::ordered_json loadAverage();

/// The date in UTC as YYYY-MM-DD.
[[nodiscard]] std::string today();

/// Processor time that all threads of this process have used, in seconds.
[[nodiscard]] double processCpuSeconds();

/// Memory of this process that is in RAM now, in MiB; 0 where the system does not report it.
[[nodiscard]] double residentMebibytes();

}  // namespace haptoflow::bench
