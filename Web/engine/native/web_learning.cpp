#include "web_engine.hpp"
#include "web_imports.hpp"
#include "web_text.hpp"

#include <memory>
#include <string>
#include <vector>

using nlohmann::json;
using namespace haptoflow::web;

namespace {

struct CloseRecording {
    void operator()(haptoflow_recording* open) const { (void)haptoflow_recording_close(&open); }
};
struct CloseLearning {
    void operator()(haptoflow_learning* open) const { (void)haptoflow_learning_close(&open); }
};

/// A text of the options, or null where it is missing or empty.
const char* textOrNull(const json& options, const char* key) {
    const auto found = options.find(key);
    if (found == options.end() || !found->is_string() || found->get_ref<const std::string&>().empty()) {
        return nullptr;
    }
    return found->get_ref<const std::string&>().c_str();
}

/// `files`: their names, and for each the address and number of its bytes.
haptoflow_recording* readFiles(const json& options) {
    std::vector<haptoflow_recording_file> files;
    for (const json& file : options.at("files")) {
        files.push_back({file.at("name").get_ref<const std::string&>().c_str(),
                         // NOLINTNEXTLINE(performance-no-int-to-ptr)
                         reinterpret_cast<const void*>(file.at("address").get<std::uintptr_t>()),
                         file.at("count").get<uint64_t>()});
    }
    if (files.empty()) {
        throw WebError("invalid-argument", "recording: expected one file or more");
    }
    haptoflow_recording_options reading{};
    reading.struct_size = sizeof(reading);
    reading.files = files.data();
    reading.file_count = static_cast<uint32_t>(files.size());
    reading.path = files.front().name;
    reading.full_scale_mps2 = options.at("wavFullScaleMps2").get<double>();
    haptoflow_recording* opened = nullptr;
    require(haptoflow_recording_read(&reading, &opened));
    return opened;
}

/// `samples`: addresses of floats, 0 for none.
haptoflow_recording* takeSamples(const json& samples) {
    const auto floats = [&samples](const char* key) {
        // NOLINTNEXTLINE(performance-no-int-to-ptr)
        return reinterpret_cast<const float*>(samples.at(key).get<std::uintptr_t>());
    };
    haptoflow_recording_info info{};
    info.struct_size = sizeof(info);
    info.axis_count = samples.at("axisCount").get<uint32_t>();
    info.sample_rate_hz = samples.at("sampleRateHz").get<double>();
    info.sample_count = samples.at("count").get<uint64_t>();
    info.acceleration_mps2 = floats("acceleration");
    info.velocity_mps = floats("velocity");
    info.force_newtons = floats("force");
    info.constant_velocity_mps[0] = samples.at("constantVelocityMps").at(0).get<double>();
    info.constant_velocity_mps[1] = samples.at("constantVelocityMps").at(1).get<double>();
    info.constant_force_newtons = samples.at("constantForceNewtons").get<double>();
    haptoflow_recording* opened = nullptr;
    require(haptoflow_recording_create(&info, &opened));
    return opened;
}

std::string learn(const json& options) {
    const std::unique_ptr<haptoflow_recording, CloseRecording> recording(
        options.contains("files") ? readFiles(options) : takeSamples(options.at("samples")));
    haptoflow_recording_info info{};
    info.struct_size = sizeof(info);
    require(haptoflow_recording_get_info(recording.get(), &info));

    haptoflow_learning_options given{};
    given.struct_size = sizeof(given);
    given.recording = recording.get();
    given.runtime = theRuntime();
    given.model = theModel();
    given.tier = textOrNull(options, "quality");
    given.name = textOrNull(options, "name");
    given.category = textOrNull(options, "category");
    given.description = textOrNull(options, "description");
    given.licence = textOrNull(options, "licence");
    given.seed = options.at("seed").get<uint64_t>();
    given.seconds_limit = options.at("secondsLimit").get<double>();
    given.progress = [](void* /*context*/, double share, const char* doing) { hapto_progress(share, doing); };
    haptoflow_learning* opened = nullptr;
    require(haptoflow_learn_material(&given, &opened));
    const std::unique_ptr<haptoflow_learning, CloseLearning> learning(opened);
    const char* material = nullptr;
    const char* report = nullptr;
    require(haptoflow_learning_results(learning.get(), &material, &report));
    return dumped({{"name", given.name != nullptr ? given.name : info.material_name},
                   {"material", material},
                   {"report", json::parse(report)},
                   {"notes", info.notes}});
}

}  // namespace

/// Learns by options as JSON (offline.mjs). Returns JSON: name, material, report, notes.
HAPTO_EXPORT HAPTO_NAMED("hapto_learn") const char* hapto_learn(const char* text) {
    return guardedText([&] { return learn(json::parse(text)); });
}
