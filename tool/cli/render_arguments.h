// The command line of glint render.
#pragma once

#include "cli/effect_options.h"
#include "cli/environment.h"
#include "cli/motion_options.h"
#include "cli/options.h"
#include "cli/pipeline_cache.h"
#include "cli/tracing_options.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint {

constexpr double kMaxExposure = 32.0;  // stops, either way
constexpr double kMaxSky = 1e9;        // times the default sky

struct RenderArguments {
    std::string scene;
    std::string output;
    TracingArguments tracing;
    FrameArguments frame;
    EnvironmentArguments environment;
    MotionArguments motion;
    ReadingArguments reading;
    PlanArguments plan;
    AccuracyArguments accuracy;
    EffectArguments effects;
    EffectFrameArguments effectFrame;
    std::string package;
    std::string settings;  // the file that completeLine() has read
    std::string size = "960x540";
    std::int64_t samples = 1;
    std::int64_t seed = 0;
    std::string camera;
    std::string exposure = "auto";
    std::string sun = "auto";
    std::string sky = "auto";  // or a factor of the radiance of the default sky
    bool validate = false;
    std::string stats;
    bool pipelineStatistics = false;
    std::string coverage;
    std::string profileOutput;  // counts hits by key; plan.profile is the file that planning reads
    std::string device;
    std::string traversalOrder = "auto";
    PipelineArguments pipelines;
    std::string calibration;  // a device file; empty: constants that are built in

    // Returns whether the picture gets a light that the scene lacks.
    bool addsSun(const Scene& given) const {
        const bool isUnlit = given.lights.empty() && environment.file.empty();
        return sun == "on" || (sun == "auto" && isUnlit);
    }
};

TraversalOrder traversalOrderOf(const RenderArguments& arguments);
package::Strategy strategyOf(const RenderArguments& arguments);
// Returns nothing if any tracer will do.
std::optional<package::Tracer> tracerOf(const RenderArguments& arguments);

// Parses "960x540". Returns false unless it is two numbers that checkImageSize() accepts.
bool parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height);

// Declares the options that make a picture, whatever its use: the scene, size, effects, shaders, the device.
// Returns the options that --package decides, --merge first.
std::vector<CLI::Option*> addSceneOptions(CLI::App& command, RenderArguments& arguments);
// Throws a CLI::ParseError if some of them contradict each other.
void checkSceneOptions(const CLI::App& command, const RenderArguments& arguments);

// Declares every option of glint render. Calls `then` once the line is parsed and found valid.
void addRenderOptions(CLI::App& command, const std::shared_ptr<RenderArguments>& arguments,
                      const std::function<void()>& then);

}  // namespace glint
