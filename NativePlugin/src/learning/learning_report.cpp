#include "learning/learning_report.hpp"

#include "learning/rounded_numbers.hpp"

namespace haptoflow::learning {

using Json = nlohmann::ordered_json;

std::string reportJson(const LearningReport& report) {
    Json vectors = Json::array();
    for (const WaveVector& each : report.waveVectors) {
        vectors.push_back({{"x_cycles_per_mm", rounded(each.x, 1e5)}, {"y_cycles_per_mm", rounded(each.y, 1e5)}});
    }
    Json tiers = Json::array();
    for (const TierDistance& each : report.otherTiers) {
        tiers.push_back({{"tier", each.tier},
                         {"spectral_distance_db", rounded(each.spectralDistanceDb, 1e3)},
                         {"further_off", each.isFurtherOff}});
    }
    const auto curveJson = [](const SpeedComparison::Curve& curve) {
        return Json{{"rms_mps2", rounded(curve.rmsMps2, 1e5)}, {"decibels", roundedNumbers(curve.decibels, 1e1)}};
    };
    Json comparisons = Json::array();
    for (const SpeedComparison& each : report.comparisons) {
        comparisons.push_back({{"speed_mps", rounded(each.speedMps, 1e5)},
                               {"seconds", rounded(each.seconds, 1e2)},
                               {"recorded", curveJson(each.recorded)},
                               {"learnt", curveJson(each.learnt)},
                               {"nearest_label", curveJson(each.nearestLabel)}});
    }
    const Json noise{{"mps2", rounded(report.noiseMps2, 1e5)}, {"from", recordings::nameOf(report.noiseSource)}};
    const Json json{{"start_label", report.startLabel},
                    {"start_distance_db", rounded(report.startDistanceDb, 1e3)},
                    {"nearest_label", report.nearestLabel},
                    {"fitted_distance_db", rounded(report.fittedDistanceDb, 1e3)},
                    {"spectral_distance_db", rounded(report.spectralDistanceDb, 1e3)},
                    {"other_tiers", tiers},
                    {"level_error_db", rounded(report.levelErrorDb, 1e3)},
                    {"spectra", {{"frequencies_hz", roundedNumbers(report.comparedHz, 1e1)}, {"speeds", comparisons}}},
                    {"sliding_seconds", rounded(report.slidingSeconds, 1e2)},
                    {"sensor_noise", noise},
                    {"speed_mps", roundedNumbers(report.speedMps, 1e5)},
                    {"force_newtons", roundedNumbers(report.forceNewtons, 1e4)},
                    {"level_exponents",
                     {{"speed", rounded(report.speedExponent, 1e4)}, {"force", rounded(report.forceExponent, 1e4)}}},
                    {"wave_vectors", vectors},
                    {"turn_degrees", rounded(report.turnDegrees, 1e3)},
                    {"tone_speeds", report.toneSpeeds},
                    {"segments", report.segments},
                    {"generations", report.generations},
                    {"seconds", rounded(report.seconds, 1e2)},
                    {"stopped_early", report.stoppedEarly},
                    {"record_next", report.recordNext},
                    {"warnings", report.warnings}};
    return json.dump(2) + "\n";
}

}  // namespace haptoflow::learning
