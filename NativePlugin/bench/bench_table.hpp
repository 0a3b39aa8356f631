#pragma once

#include <nlohmann/json.hpp>

#include <iosfwd>

namespace haptoflow::bench {

/// The report of `runBench` for people: one table for each measurement that is in it.
void printTables(std::ostream& stream, const nlohmann::ordered_json& report);

}  // namespace haptoflow::bench
