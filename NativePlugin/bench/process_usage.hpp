#pragma once

namespace haptoflow::bench {

/// Processor time that all threads of this process have spent, in seconds.
[[nodiscard]] double processCpuSeconds();

/// Memory that this process holds in RAM now, in MiB; 0 where the system does not tell.
[[nodiscard]] double residentMebibytes();

}  // namespace haptoflow::bench
