// All pipelines that renderers of a package can have, made at once, with the driver's report about each.
#pragma once

#include <glint/internal/package_modules.h>
#include <glint/renderer.h>
#include <glint/result.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace glint {

// A pipeline that renderers of a package make.
struct PackagePipeline {
    // Without executables if the device reports none, or if the pipeline could not be made.
    Renderer::PipelineStatistics statistics;
    // Its modules: first the one that it is named after, with the cases that share its code.
    std::vector<package::ModuleKey> modules;
    std::uint32_t strategies = 0;       // package::Strategy bits of the renderers that have it
    std::optional<Diagnostic> failure;  // the driver's error; no value if it made the pipeline
};

// Makes each pipeline that renderers of the package can have on the device, with every strategy, tracer and
// ordering of both, and destroys it again. May be called from any thread; it takes as long as the driver
// needs. Needs no scene, and submits nothing. A package with the steps of a host gets a layout with the
// descriptors that its modules declare. `threads` is as RendererOptions::pipelineThreads. Errors:
// "device-tracer" and others of Renderer::create() if the device runs no strategy of the package,
// "vulkan-call".
Result<std::vector<PackagePipeline>> makePackagePipelines(Context& context, const Package& package,
                                                          std::uint32_t threads = 0);

}  // namespace glint
