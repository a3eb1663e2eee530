#include "view/builder.h"

#include "base/clock.h"
#include "base/files.h"
#include "cache/store.h"
#include "emit/compile.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"
#include "materials/declarations.h"
#include "resolve/host.h"
#include "resolve/light.h"

#include <glint/internal/package_modules.h>
#include <glint/measure/settings.h>
#include <glint/measure/target.h>
#include <glint/session/session.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <utility>

namespace glint::view {

namespace {

// Returns the names of all layers that the package may have.
std::vector<std::string> possibleLayers(const compiler::Plan& plan, compiler::CompileSettings settings) {
    std::vector<std::string> names;
    for (const package::LayerInfo& info : package::layerTable()) {
        settings.layers = {std::string(info.name)};
        const Result<std::vector<package::LayerInfo::Entry>> entries =
            compiler::resolveLayers(plan, settings, "");
        for (const package::LayerInfo::Entry& entry :
             entries ? *entries : std::vector<package::LayerInfo::Entry>()) {
            if (entry.layer == info.number) {
                names.push_back(compiler::layerNameOf(entry, *plan.model));
            }
        }
    }
    return names;
}

}  // namespace

bool haveSameFiles(const gltf::Scene& a, const gltf::Scene& b) {
    return a.sceneInFile == b.sceneInFile && a.variant == b.variant &&
           std::ranges::equal(a.files, b.files, [](const auto& x, const auto& y) {
               return x.path == y.path && x.bytes == y.bytes && x.hash == y.hash;
           });
}

Builder::Builder(const Request& request, Context& context)
    : request_(request), context_(context), thread_([this] { work(); }) {}

Builder::~Builder() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    wake_.notify_one();
    thread_.join();
}

void Builder::start(BuildOrder order) {
    {
        const std::lock_guard lock(mutex_);
        Slot& slot = slots_[order.picture];
        if (slot.order) {
            order.rereads = order.rereads || slot.order->rereads;
        }
        slot.order = std::move(order);
        slot.done.reset();
        slot.busy = true;
        slot.canceled = false;
    }
    wake_.notify_one();
}

void Builder::cancel(std::size_t picture) {
    const std::lock_guard lock(mutex_);
    slots_[picture].order.reset();
    slots_[picture].done.reset();
    slots_[picture].canceled = true;
}

std::optional<Result<Build>> Builder::poll(std::size_t picture) {
    const std::lock_guard lock(mutex_);
    return std::exchange(slots_[picture].done, std::nullopt);
}

bool Builder::isBusy(std::size_t picture) const {
    const std::lock_guard lock(mutex_);
    return slots_[picture].busy || slots_[picture].done;
}

std::string Builder::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

std::vector<Diagnostic> Builder::takeMessages() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
}

void Builder::say(std::string text) {
    const std::lock_guard lock(mutex_);
    progress_ = std::move(text);
}

void Builder::work() {
    const auto isOrdered = [](const Slot& slot) { return slot.order.has_value(); };
    while (true) {
        BuildOrder order;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return ends_ || std::ranges::any_of(slots_, isOrdered); });
            if (ends_) {
                return;
            }
            order = *std::exchange(std::ranges::find_if(slots_, isOrdered)->order, std::nullopt);
        }
        Result<Build> made = build(order);
        const std::lock_guard lock(mutex_);
        progress_.clear();
        Slot& slot = slots_[order.picture];
        if (slot.order) {
            continue;  // the order has changed meanwhile
        }
        slot.busy = false;
        if (!slot.canceled) {
            slot.done = std::move(made);
        }
    }
}

Result<Build> Builder::build(const BuildOrder& asked) {
    Build build;
    BuildOrder order = asked;
    if (session::needShaders(order.edits)) {
        // Other primitives than those of the file may show a texture.
        order.settings.compile.trustTextures = false;
    }
    GLINT_TRY(auto given, session::givenPackage(order.settings));
    GLINT_TRY_DO(readScene(order, given.get(), build));
    GLINT_TRY_DO(readEdits(order, given.get(), build));
    GLINT_TRY_DO(makePackage(order.settings, std::move(given), build));
    GLINT_TRY_DO(readTextures(build));
    return build;
}

Status Builder::readScene(const BuildOrder& order, const Package* package, Build& build) {
    const base::Clock::time_point start = base::Clock::now();
    const compiler::Settings& settings = order.settings;
    GLINT_TRY(const auto import,
              session::importOptions(settings, session::ImageReading::Files, request_.store, package));
    const std::string key =
        fmt::format("{}|{}|{}|{}|{}|{}", order.scene, settings.sceneInFile, settings.variant,
                    settings.strictPaths, import.trustTextures, fmt::join(settings.materials, "|"));
    if (order.rereads || key != sceneKey_) {
        files_.clear();
        fileTextures_.clear();
        say("reading " + order.scene);
        GLINT_TRY(auto scene, importScene(order.scene, import));
        // The contents of pictures depend on their files alone.
        if (!scene_ || !haveSameFiles(*scene_, scene)) {
            textures_.reset();
        }
        const std::lock_guard lock(mutex_);
        messages_.insert(messages_.end(), scene.warnings.begin(), scene.warnings.end());
        scene_ = std::make_shared<const gltf::Scene>(std::move(scene));
        sceneKey_ = key;
    }
    list_ = std::make_shared<const gltf::SceneList>(std::span(scene_.get(), 1));
    build.scene = scene_;
    for (const gltf::SourceFile& file : scene_->files) {
        build.inputs.push_back({file.path, file.hash});
    }
    for (const auto& files :
         {materials::packFiles(settings.materials), compiler::hostFiles(settings.compile.host)}) {
        for (const std::filesystem::path& file : files ? *files : std::vector<std::filesystem::path>()) {
            const Result<base::FileDigest> digest = base::digestFile(file);
            build.inputs.push_back({file.string(), digest ? std::optional(digest->hash) : std::nullopt});
        }
    }
    build.readMs = base::millisecondsSince(start);
    return okStatus();
}

// Reads the files that edits add. Where edits need shaders, the package is made for the scene and for all
// that they make of it.
Status Builder::readEdits(const BuildOrder& order, const Package* package, Build& build) {
    if (order.edits.empty()) {
        return okStatus();
    }
    GLINT_TRY(auto import,
              session::importOptions(order.settings, session::ImageReading::Files, request_.store, package));
    import.materialModel =
        scene_->materials.empty() ? import.materialModel : &scene_->materials.front().model();
    GLINT_TRY_DO(session::readFiles(order.edits, import, files_));
    for (const auto& [name, scene] : files_) {
        for (const gltf::SourceFile& file : scene->files) {
            build.inputs.push_back({file.path, file.hash});
        }
    }
    build.files = files_;
    build.edits = order.edits.size();
    if (package != nullptr || !session::needShaders(order.edits)) {
        return okStatus();
    }
    struct Scenes {
        std::vector<gltf::Scene> scenes;
        std::optional<gltf::SceneList> list;
    };
    const auto made = std::make_shared<Scenes>();
    made->scenes.push_back(*scene_);
    GLINT_TRY(made->scenes.emplace_back(), session::plannedScene(*scene_, order.edits, files_));
    made->list.emplace(made->scenes);
    list_ = std::shared_ptr<const gltf::SceneList>(made, &*made->list);
    return okStatus();
}

Status Builder::makePackage(compiler::Settings asked, std::shared_ptr<const Package> given, Build& build) {
    const base::Clock::time_point start = base::Clock::now();
    // The package also has the strategies that were asked for before, so that a renderer of one of them can
    // switch to it.
    asked.furtherStrategies = sceneKey_ == strategiesKey_ ? strategies_ : 0;
    asked.renderer.backgroundPipelines = true;
    asked.compile.progress = [this](std::size_t done, std::size_t all) {
        say(fmt::format("compiling {} of {}", done, all));
    };
    GLINT_TRY(const auto target, measure::targetOf(asked, context_, given.get(), *build.scene));
    GLINT_TRY(auto decided, compiler::resolve(list_, asked, target));
    build.resolved = std::make_shared<const compiler::Build>(std::move(decided));
    const compiler::Build& resolved = *build.resolved;
    if (given) {
        GLINT_TRY_DO(session::checkPackage(*given, resolved));
        build.package = std::move(given);
        for (const package::PackageLayer& layer : build.package->layers()) {
            build.layers.push_back(layer.name);
        }
    } else {
        say("compiling " + build.scene->path);
        strategies_ = resolved.settings.compile.strategies;
        strategiesKey_ = sceneKey_;
        const Result<compiler::CompiledPackage> compiled = compilePackage(resolved, request_.modules, &warm_);
        warm_.endRun();
        if (!compiled) {
            return compiled.error();
        }
        GLINT_TRY(build.package, session::loadPackage(*compiled));
        build.instructions.resize(compiled->plan.cases.size());
        for (const compiler::CompiledModule& module : compiled->modules) {
            (module.compiled ? build.modulesCompiled : build.modulesKept) += 1;
            if (package::findRole(module.key.role)->repeated == package::Repeated::ByCase) {
                build.instructions[module.key.index] =
                    static_cast<std::uint32_t>(module.statistics.instructions);
            }
        }
        build.layers = possibleLayers(resolved.plan, resolved.settings.compile);
    }
    build.compileMs = base::millisecondsSince(start);
    build.facts = measure::factsOf(resolved);
    const std::lock_guard lock(mutex_);
    messages_.insert(messages_.end(), resolved.messages.begin(), resolved.messages.end());
    return okStatus();
}

Status Builder::readTextures(Build& build) {
    session::TextureOptions options =
        session::textureOptions(build.settings(), context_, *build.package, request_.store);
    options.fit.allLevels = true;  // so that the coarse ones can be there first
    const std::string key = fmt::format("{} {}", options.fit.compress, options.fit.decodeEmission);
    if (!textures_ || key != texturesKey_) {
        say("reading textures");
        GLINT_TRY(textures_, session::loadTextures(*build.scene, options));
        texturesKey_ = key;
        fileTextures_.clear();
        build.texturesMs = textures_->milliseconds;
        const std::lock_guard lock(mutex_);
        messages_.insert(messages_.end(), textures_->notes.begin(), textures_->notes.end());
    }
    build.textures = textures_;
    for (const auto& [name, scene] : build.files) {
        if (!fileTextures_.contains(name)) {
            GLINT_TRY(auto read, session::loadTextures(*scene, options));
            fileTextures_.emplace(name, std::move(read));
        }
    }
    build.fileTextures = fileTextures_;
    return okStatus();
}

}  // namespace glint::view
