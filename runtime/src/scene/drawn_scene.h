// The part of a scene that those who draw it need: of a GpuScene, or of an engine's own scene.
#pragma once

#include "context/context.h"
#include "data/retired.h"

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace glint {

struct PackageUser;

// The way in which a package draws a scene.
struct PackageFit {
    std::uint32_t scene = 0;               // its index, or kNoPackageScene
    std::uint64_t records = 0;             // recordsHash()
    std::vector<std::uint32_t> shaderIds;  // of the shader binding table
    std::vector<SceneEditor::Report::MissingCase>
        missing{};  // of a scene that is edited: materials that the fallback shades
};

struct DrawnScene {
    explicit DrawnScene(Context::State& contextState) : context(contextState) {}
    DrawnScene(const DrawnScene&) = delete;
    DrawnScene& operator=(const DrawnScene&) = delete;
    virtual ~DrawnScene() = default;

    // Checks that the package can draw the scene. Errors: "scene-package" (it has no such scene, or differs
    // in data that it does not contain), "position-fetch", "half-precision"; of a scene that is edited also
    // those of its materials.
    virtual Result<PackageFit> fit(const std::shared_ptr<const Package>& package) const = 0;
    // Records the copies that bring the scene's records to `package`, which must run before all commands that
    // read them, and makes the scene one of that package. A scene that is edited keeps the package. Values of
    // materials that edits or the host have given stay. Returns the resources that commands use which were
    // recorded until then, or that these commands use. Requires fit(), which gave `index`. With an error
    // nothing changes. Errors: those of buffers, and of content that has changed since fit().
    virtual Result<RetiredLot> recordReplacement(const std::shared_ptr<const Package>& package,
                                                 std::uint32_t index, VkCommandBuffer commands) = 0;

    // Lets the next recording of edits build other BLASes in the place of those that joinedBlases counts.
    virtual void partBlases() {}

    Context::State& context;
    std::uint64_t records = 0;  // recordsHash()
    // The shader IDs of the shader binding table. Its number changes when they do without another package.
    std::vector<std::uint32_t> shaderIds;
    std::uint32_t shaderIdsVersion = 0;
    // How many BLASes have several primitives whose shaders the table does not have beside each other.
    std::uint32_t joinedBlases = 0;
    // Renderers and RaySteps of the scene, which add and remove themselves, also when the scene is gone. They
    // replace its packages together.
    struct Users {
        std::mutex mutex;
        std::vector<PackageUser*> all;
        bool readTables = false;  // some have read the shader binding table, or will
    };
    std::shared_ptr<Users> users = std::make_shared<Users>();
};

}  // namespace glint
