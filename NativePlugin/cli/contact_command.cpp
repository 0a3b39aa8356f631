#include "commands.hpp"
#include "headless/contact_tracker.hpp"
#include "headless/scene_file.hpp"
#include "headless/scene_materials.hpp"
#include "headless/stroke_file.hpp"
#include "messages.hpp"
#include "option_values.hpp"
#include "output_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

constexpr int significantDigits = 12;

struct ContactOptions {
    std::string scenePath;
    std::string strokePath;
    std::string outputPath;
    std::string modelPath;
    std::vector<std::string> materials;
    std::optional<double> defaultStiffnessNewtonsPerMetre;
    bool asRecorded = false;
};

/// Writes twelve significant digits with a decimal point, in every locale; never "-0".
void writeNumber(std::ostream& output, double value) {
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value + 0.0,
                                            std::chars_format::general, significantDigits);
    output.write(digits.data(), end - digits.data());
}

void writeName(std::ostream& output, const std::string& name) {
    if (name.find_first_of(",\"\r\n") == std::string::npos) {
        output << name;
        return;
    }
    output << '"';
    for (const char letter : name) {
        output << (letter == '"' ? "\"\"" : std::string(1, letter));
    }
    output << '"';
}

bool asksForStiffness(const headless::Scene& scene) {
    return std::ranges::any_of(scene.surfaces, [](const headless::SceneSurface& surface) {
        return !surface.stiffnessNewtonsPerMetre.has_value();
    });
}

void runContact(const ContactOptions& options) {
    headless::Scene scene = headless::readSceneFile(options.scenePath);
    const headless::Stroke stroke = headless::readStrokeFile(options.strokePath);
    noteLateKeyframes(scene, stroke, options.scenePath);
    headless::ContactSettings settings;
    std::optional<model::ModelFile> model;
    std::optional<headless::SceneMaterials> materials;
    if (options.defaultStiffnessNewtonsPerMetre) {
        settings.defaultStiffnessNewtonsPerMetre = *options.defaultStiffnessNewtonsPerMetre;
    } else if (asksForStiffness(scene) || !options.modelPath.empty() || !options.materials.empty()) {
        const std::filesystem::path modelPath = findModel(options.modelPath);
        model = readModel(modelPath);
        materials.emplace(*model, modelPath, options.scenePath);
        std::ranges::for_each(options.materials, [&materials](const std::string& path) { materials->add(path); });
        materials->require(scene);
        headless::useStiffnessOfMaterials(settings, *materials);
    }
    if (options.outputPath.empty()) {
        writeContactStates(std::cout, scene, stroke, options.strokePath, settings, options.asRecorded);
        return;
    }
    OutputFile output("-o", options.outputPath);
    std::ofstream file(output.partial(), std::ios::binary);
    writeContactStates(file, scene, stroke, options.strokePath, settings, options.asRecorded);
    file.close();
    if (!file) {
        throw InputError(options.outputPath + ": could not be written to its end; is the disk full?");
    }
    output.commit();
}

}  // namespace

void writeContactStates(std::ostream& output, const headless::Scene& scene, const headless::Stroke& stroke,
                        const std::string& strokeName, const headless::ContactSettings& settings, bool asRecorded) {
    headless::ContactTracker tracker(scene, settings);
    const std::size_t frames =
        asRecorded ? stroke.samples.size() : headless::frameCount(stroke, scene.updateRateHz, strokeName);
    output << "t,surface,touching,touch_counter,px,py,pz,nx,ny,nz,penetration_m,vx_mps,vy_mps,approach_mps,force_n,"
              "landing_counter,edge_counter,edge_height_m\n";
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const headless::ContactReading reading =
            tracker.update(asRecorded ? stroke.samples[frame] : headless::frameAt(stroke, scene.updateRateHz, frame));
        writeNumber(output, reading.timeSeconds);
        output << ',';
        if (reading.touching) {
            writeName(output, scene.surfaces[static_cast<std::size_t>(reading.surfaceIndex)].name);
        }
        output << ',' << (reading.touching ? 1 : 0) << ',' << reading.touchCounter;
        for (const double value :
             {reading.pointMetres.x, reading.pointMetres.y, reading.pointMetres.z, reading.normal.x, reading.normal.y,
              reading.normal.z, reading.penetrationMetres, reading.tangentialVelocityMps.x,
              reading.tangentialVelocityMps.y, reading.approachSpeedMps, reading.forceNewtons}) {
            output << ',';
            writeNumber(output, value);
        }
        output << ',' << reading.landingCounter << ',' << reading.edgeCounter << ',';
        writeNumber(output, reading.edgeHeightMetres);
        output << '\n';
    }
}

void addContactCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("contact", "Print what a stroke touches, frame by frame, as CSV");
    const auto options = std::make_shared<ContactOptions>();
    command->add_option("scene", options->scenePath, "SCENE.json: surfaces, their materials and motions")
        ->required()
        ->type_name("SCENE.json");
    command->add_option("--stroke", options->strokePath, "The tip's path: t,x,y,z[,force][,qx,qy,qz,qw]")
        ->required()
        ->type_name("STROKE.csv");
    command->add_option("-o,--output", options->outputPath, "Write to this file instead of standard output")
        ->type_name("FILE");
    command->add_flag("--as-recorded", options->asRecorded,
                      "A frame for each sample of the stroke, at its time, instead of the scene's update_rate: for a "
                      "recording of the tracker's own frames");
    CLI::Option* model = command
                             ->add_option("--model", options->modelPath,
                                          "Model file whose labels give the stiffness of surfaces without their own "
                                          "(default: the one shipped)")
                             ->type_name("FILE");
    CLI::Option* material = command
                                ->add_option("--material", options->materials,
                                             "A .haptomaterial file whose name the scene can use like a label; may "
                                             "be given several times")
                                ->allow_extra_args(false)
                                ->type_name("FILE");
    command
        ->add_option("--default-stiffness", options->defaultStiffnessNewtonsPerMetre,
                     "N/m of surfaces without a stiffness of their own, instead of their labels'; no model is read")
        ->check(decimalBetween(1e-3, 1e7, "N/m"))
        ->excludes(model)
        ->excludes(material);
    command->footer(
        "One line per frame of the scene's update_rate (90 Hz by default): time, the touched surface (empty without\n"
        "touch), the number of touch-downs so far, the contact point, the outward normal of the surface, the\n"
        "penetration depth, the tip's velocity along the surface's two tangent axes, the speed of this touch's newest\n"
        "landing, the force (the stroke's own if it has one, otherwise the depth times the stiffness of the surface or "
        "of\n"
        "its labels), the number of landings on another surface or face within touches so far, and the number of "
        "edges\n"
        "crossed so far with the height of the newest.\n"
        "Metres, seconds, newtons; Unity's left-handed frame with y up.\n"
        "Example:\n"
        "  haptoflow contact scene.json --stroke stroke.csv -o states.csv\n"
        "Both files are explained in Documentation~/scene-and-stroke.md.");
    command->callback([options] { runContact(*options); });
}

}  // namespace haptoflow::cli
