// Measures the strategies on generated scenes of one number of cases and one cost, which share a package, and
// reports about a device.
#pragma once

#include "base/json.h"
#include "emit/compile.h"
#include "synthetic/cases_scene.h"

#include <glint/measure/device_file.h>
#include <glint/measure/observer.h>
#include <glint/session/session.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace glint::compiler {
class CacheStore;
}  // namespace glint::compiler

namespace glint::measure {

// The time for which a GPU renders before a round, and before each measured time. Its clocks fall while the
// host works between rounds, and take a while to rise again.
inline constexpr std::chrono::milliseconds kRoundWarmUp{250};
inline constexpr std::chrono::milliseconds kWarmUp{10};

// Returns a permutation of [0, count), the order of a round, so that no configuration always follows the same
// other one. The result depends only on the state of `random`, with every standard library.
inline std::vector<std::size_t> shuffled(std::size_t count, std::mt19937_64& random) {
    // The shuffle of Fisher and Yates, because std::shuffle differs between libraries.
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) {
        std::swap(order[i - 1], order[random() % i]);
    }
    return order;
}

// A scene on the device whose rays belong to one effect.
struct CalibrationScene {
    synthetic::CasesOptions options;
    session::DeviceScene scene;
    CameraView camera;
    package::Effect effect{};
};

// The scenes and their package on the host, before the upload.
struct CompiledGroup {
    std::vector<synthetic::CasesOptions> options;  // of each scene
    std::vector<gltf::Scene> scenes;
    compiler::Settings settings;
    compiler::CompiledPackage package;  // of every strategy, with a case a key
};

// The same on the device.
struct CalibrationGroup {
    std::shared_ptr<const Package> package;
    std::vector<CalibrationScene> scenes;
    std::vector<CaseWork> work;  // by shader ID; no shares
};

// Returns the strategies that a device with these Tracer bits can run, uber first.
std::vector<std::string> strategiesFor(std::uint32_t tracers);

// Makes a scene for each of `options`, which differ in coherence alone, and compiles their package with the
// strategies of strategiesFor(). Has the errors of compilePackage().
Result<CompiledGroup> compileGroup(const CalibrationSettings& settings, std::uint32_t tracers,
                                   std::vector<synthetic::CasesOptions> options,
                                   compiler::ModuleCache* cache);

// Has the errors of each step.
Result<CalibrationGroup> uploadGroup(Context& context, const CompiledGroup& compiled);

// Chooses a picture of 2 : 1 in whole tiles of the passes, in which each pixel sends a ray.
void sizeFor(std::uint64_t rays, std::uint32_t& width, std::uint32_t& height);

struct PointOptions {
    std::uint64_t rays = 0;
    std::uint32_t rounds = 1;
    std::uint32_t seed = 1;
    std::string picture{};  // .png of uber's; empty: none
};

// Every strategy first renders once, so that its pipelines are ready and its picture can be compared with
// that of uber. Then it renders in each round, in random order. Before a round, and before each strategy, a
// GPU renders for a while, because its clocks fall while it waits. A strategy that can't run is left out with
// its reason; if that is uber, all others are left out too. Errors: of the device once measuring has begun,
// and of the picture's file.
Result<CalibrationEntry> measurePoint(Context& context, CalibrationGroup& group,
                                      const CalibrationScene& scene, const CalibrationSettings& settings,
                                      const PointOptions& options);

// --- The report about a device ---

struct DeviceReportSettings {
    compiler::Settings render;  // device, validation, size and samples of the scene's picture
    std::uint32_t rounds = 1;
    std::uint32_t seed = 1;
    bool quick = false;  // fewer cases, rays and rounds
};

// Times every strategy on five generated scenes, and on `scene` unless it is null, and makes all pipelines of
// their packages. `cache` and `store` may be null. Errors: of the device, of compiling, "validation".
Result<base::Json> makeDeviceReport(const Observer& observer, const DeviceReportSettings& settings,
                                    const gltf::Scene* scene, compiler::ModuleCache* cache,
                                    compiler::CacheStore* store);

}  // namespace glint::measure
