#include "base/lists.h"
#include "cache/store.h"
#include "emit/compile.h"
#include "gltf/import.h"
#include "resolve/light.h"
#include "scene/deformed.h"

#include <glint/package_shape.h>
#include <glint/session/session.h>
#include <glint/session/textures.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::session {

namespace {

Diagnostic mismatch(const std::filesystem::path& folder, const std::string& message) {
    return makeError(
        "package-mismatch", folder.string(), message,
        "compile the package again, use the --variant that it was compiled with, or leave out --package");
}

Status checkStrategy(const Package& package, const compiler::Settings& settings) {
    if (package.supports(*settings.strategy)) {
        return okStatus();
    }
    const std::vector<std::string> has = compiler::strategyNames(package.shape().strategies);
    const std::string_view wanted = package::nameOf(*settings.strategy);
    return makeError(
        "package-mismatch", settings.package, fmt::format("has {}, not {}", fmt::join(has, ", "), wanted),
        fmt::format("render with --strategy {}, or compile with --strategy {}", has.front(), wanted));
}

Status checkTracer(const Package& package, const compiler::Settings& settings) {
    const std::uint32_t compiled = package::tracersOf(*settings.strategy, package.shape().tracers);
    const std::optional<package::Tracer> tracer = settings.renderer.tracer;
    if (!tracer || (compiled & *tracer) != 0) {
        return okStatus();
    }
    const std::vector<std::string> has = compiler::tracerNames(compiled);
    const std::string_view wanted = package::nameOf(*tracer);
    return makeError(
        "package-tracer", settings.package,
        fmt::format("has {} for {}, not {}", fmt::join(has, ", "), package::nameOf(*settings.strategy),
                    wanted),
        fmt::format("render with --tracer {}, or compile with --tracer {}", has.front(), wanted));
}

Status checkSky(const Package& package, const compiler::Settings& settings) {
    const bool map = !settings.environment.empty();
    if (package.environmentMap() == map) {
        return okStatus();
    }
    return makeError("package-mismatch", settings.package,
                     map ? "was compiled for a gradient sky, not for an environment map"
                         : "was compiled for an environment map, and there is none",
                     map ? "compile it with --environment-map, or leave out --environment"
                         : "give one by --environment, or compile without --environment-map");
}

}  // namespace

Result<gltf::ImportOptions> importOptions(const compiler::Settings& settings, ImageReading images,
                                          base::Memo* texels, const Package* package) {
    GLINT_TRY(auto options, compiler::importOptions(settings, texels));
    options.keepImageFiles = images == ImageReading::Files;
    options.trustTextures = package != nullptr ? package->trustTextures() : options.trustTextures;
    return options;
}

Result<std::shared_ptr<const Package>> givenPackage(const compiler::Settings& settings) {
    std::shared_ptr<const Package> given;
    if (!settings.package.empty()) {
        GLINT_TRY(auto loaded, Package::load(settings.package));
        given = std::make_shared<const Package>(std::move(loaded));
    }
    return given;
}

Result<Opened> open(const std::string& file, const compiler::Settings& settings,
                    compiler::CacheStore* store) {
    Opened opened;
    GLINT_TRY(opened.package, givenPackage(settings));
    GLINT_TRY(const auto import, importOptions(settings, ImageReading::Files, store, opened.package.get()));
    GLINT_TRY(opened.scene, importScene(file, import));
    return opened;
}

std::optional<std::uint32_t> sceneIn(const Package& package, const gltf::Scene& scene) {
    if (package.sceneCount() == 1) {
        return 0;
    }
    return package.findScene(std::filesystem::path(scene.path).stem().string());
}

Status checkPackage(const Package& package, const compiler::Build& build) {
    const compiler::Settings& settings = build.settings;
    const gltf::Scene& scene = build.scenes->scenes().front();
    GLINT_TRY_DO(checkStrategy(package, settings));
    GLINT_TRY_DO(checkTracer(package, settings));
    GLINT_TRY_DO(checkSky(package, settings));
    const std::optional<std::uint32_t> index = sceneIn(package, scene);
    if (!index) {
        return mismatch(settings.package,
                        fmt::format("has {} scenes, none of them named {}", package.sceneCount(),
                                    std::filesystem::path(scene.path).stem().string()));
    }
    const PackageScene known = package.scene(*index);
    if (known.materials.size() != scene.materials.size()) {
        return mismatch(settings.package, fmt::format("has {} materials, but the scene has {}",
                                                      known.materials.size(), scene.materials.size()));
    }
    if (compiler::hasDeformedMesh(scene) && !package.shape().deforms) {
        return mismatch(settings.package,
                        "has no pass for meshes that follow joints or morph targets, as the scene has");
    }
    for (std::size_t i = 0; i < build.scenes->primitives().size(); ++i) {
        const materials::PrimitiveInputs& inputs = build.scenes->primitives()[i];
        const package::PrimitiveEntry* entry = known.findPrimitive(
            static_cast<std::uint32_t>(inputs.mesh), static_cast<std::uint32_t>(inputs.primitive));
        const std::string pointer = fmt::format("/meshes/{}/primitives/{}", inputs.mesh, inputs.primitive);
        if (entry == nullptr) {
            return mismatch(settings.package, "does not know the scene's " + pointer);
        }
        if (entry->materialIndex != static_cast<std::uint32_t>(inputs.material) ||
            build.plan.model->maskOf(entry->key) != build.plan.primaryMaskOfPrimitive[i]) {
            return mismatch(settings.package,
                            "has another material or other features for the scene's " + pointer);
        }
    }
    for (const package::TextureEntry& texture : known.textures) {
        if (texture.image >= scene.images.size()) {
            return mismatch(settings.package, fmt::format("uses image {}, but the scene has {} images",
                                                          texture.image, scene.images.size()));
        }
    }
    return okStatus();
}

Result<std::shared_ptr<const Package>> loadPackage(const compiler::CompiledPackage& compiled) {
    const auto files =
        base::mapped<package::EmbeddedFile>(compiled.files, [](const compiler::PackageFile& file) {
            return package::EmbeddedFile{file.name, file.bytes};
        });
    GLINT_TRY(auto loaded, Package::load(files));
    return std::make_shared<const Package>(std::move(loaded));
}

Result<std::shared_ptr<const Package>> compileAndLoad(const compiler::Build& build,
                                                      compiler::ModuleCache* cache) {
    GLINT_TRY(const auto compiled, compilePackage(build, cache));
    return loadPackage(compiled);
}

Result<std::shared_ptr<const Package>> packageFor(const compiler::Build& build,
                                                  std::shared_ptr<const Package> given,
                                                  compiler::ModuleCache* cache) {
    if (given == nullptr) {
        return compileAndLoad(build, cache);
    }
    GLINT_TRY_DO(checkPackage(*given, build));
    return given;
}

HeadlessOptions deviceOptions(const compiler::Settings& settings) {
    HeadlessOptions options;
    options.validation = settings.validate ? Validation::Synchronization : Validation::Off;
    options.deviceName = settings.device;
    options.pipelineStatistics = settings.gpu == compiler::kThisDevice;
    options.positionFetch = settings.compile.positionFetch;
    const auto has = [](const std::vector<std::string>& layers) {
        return std::ranges::find(layers, "clocks") != layers.end();
    };
    options.shaderClock =
        has(settings.compile.layers) || (settings.package.empty() && has(settings.readLayers));
    options.shaderFloat16 = settings.compile.precision == package::ShadingPrecision::Half;
    return options;
}

TextureOptions textureOptions(const compiler::Settings& settings, const Context& context,
                              const Package& package, compiler::CacheStore* cache) {
    TextureOptions options;
    options.fit.formats = context.texelFormats();
    options.fit.compress = settings.compressTextures;
    options.fit.decodeEmission = package.emission() != nullptr;
    options.cache = cache;
    options.threads = static_cast<std::uint32_t>(settings.compile.jobs);
    return options;
}

RendererOptions rendererOptions(const compiler::Settings& settings) {
    RendererOptions options = settings.renderer;
    options.strategy = settings.strategy.value_or(options.strategy);
    options.bounces = settings.compile.maxBounces;
    options.checkOrder = settings.validate;
    options.screenMarch = settings.frame.screenSteps > 0;
    // Pipelines of cases swap in one after the other where the package can do without them for a while.
    options.backgroundPipelines = options.backgroundPipelines && settings.compile.plan.fallback;
    if (options.pipelineThreads == 0) {
        options.pipelineThreads = static_cast<std::uint32_t>(settings.compile.jobs);
    }
    return options;
}

SkyChoice chooseSky(const compiler::Settings& settings, const gltf::Scene& scene, const SceneViewData& view) {
    SkyChoice choice;
    choice.automatic = !settings.sky;
    if (settings.sky) {
        choice.scale = *settings.sky;
        return choice;
    }
    if (scene.lights.empty() || !settings.environment.empty()) {
        return choice;
    }
    return skyForLights(litPatches(scene, view, view.lights));
}

FrameOptions frameOptions(const compiler::Settings& settings, const CameraView& camera, const SkyChoice& sky,
                          const Environment* environment) {
    FrameOptions options = settings.frame;
    options.camera = camera;
    options.sky = sky.sky();
    options.averagedSamples = settings.samples;
    options.environment = environment;
    options.environmentRotation = static_cast<float>(settings.environmentRotation / 180.0 * std::numbers::pi);
    return options;
}

SceneViewData sceneView(const compiler::Settings& settings, const gltf::Scene& scene) {
    SceneViewData data = makeSceneView(scene);
    if (compiler::addsSun(settings, scene)) {
        data.lights.push_back(sunLight());
    }
    data.directionalSize = static_cast<float>(0.5 * settings.sunAngle * std::numbers::pi / 180.0);
    data.placedSize = static_cast<float>(settings.lightRadius);
    for (LightView& light : data.lights) {
        light.size = light.type == LightView::Type::Directional ? data.directionalSize : data.placedSize;
    }
    data.traversalOrder = settings.traversalOrder;
    data.opacity = settings.opacity;
    data.vertices = settings.vertices;
    return data;
}

void usePackage(const Package& package, const gltf::Scene& scene, std::shared_ptr<const TextureSet> textures,
                SceneViewData& data) {
    data.packageScene = sceneIn(package, scene).value_or(0);
    useLayoutOf(package, scene, data);
    if (textures != nullptr) {
        useTextures(std::move(textures), data);
    }
}

Result<DeviceScene> DeviceScene::upload(Context& context, std::shared_ptr<const Package> package,
                                        SceneViewData data) {
    DeviceScene made{std::move(package), std::move(data), nullptr};
    GLINT_TRY(made.gpu, GpuScene::upload(context, *made.package, made.data.view()));
    return made;
}

Result<DeviceScene> DeviceScene::record(Context& context, std::shared_ptr<const Package> package,
                                        SceneViewData data, VkCommandBuffer commands) {
    DeviceScene made{std::move(package), std::move(data), nullptr};
    SceneView view = made.data.view();
    view.streamsTextures = true;
    GLINT_TRY(made.gpu, GpuScene::record(context, *made.package, view, commands, 0));
    return made;
}

Result<std::unique_ptr<Renderer>> DeviceScene::makeRenderer(Context& context,
                                                            const RendererOptions& options) const {
    return Renderer::create(context, *package, *gpu, options);
}

}  // namespace glint::session
