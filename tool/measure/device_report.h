// The report of `glint bench --device-report` about a device: its compiler's statistics of Glint's pipelines,
// and the times of strategies. It has no personal data: no names of hosts, users or files.
#pragma once

#include "base/json.h"
#include "gltf/scene.h"
#include "settings/settings.h"

#include <glint/measure/observer.h>
#include <glint/result.h>

#include <cstdint>

namespace glint::compiler {
class CacheStore;
class ModuleCache;
}  // namespace glint::compiler

namespace glint::measure {

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
