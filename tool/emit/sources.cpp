#include "emit/sources.h"

#include "emit/embedded.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glint {

namespace {

constexpr std::string_view kInteropFolder = "interop/";

std::string sceneDefines(const Scene& scene, const Plan& plan, AlphaPolicy alpha) {
    const auto low = [](FeatureMask mask) { return mask & kLobeMask; };
    const auto high = [](FeatureMask mask) { return mask >> 32U; };
    const bool hasMasked = std::ranges::any_of(
        scene.materials, [](const Material& material) { return material.alphaMode == AlphaMode::Mask; });
    std::string text = "// The scene as a whole: features of every key, and of some.\n";
    text += fmt::format("#define GLINT_ALWAYS_LOBES {:#x}u\n", low(plan.always));
    text += fmt::format("#define GLINT_ALWAYS_INPUTS {:#x}u\n", high(plan.always));
    text += fmt::format("#define GLINT_SOMETIMES_LOBES {:#x}u\n", low(plan.sometimes));
    text += fmt::format("#define GLINT_SOMETIMES_INPUTS {:#x}u\n", high(plan.sometimes));
    text += fmt::format("#define GLINT_ALPHA_TESTED {}\n", alpha == AlphaPolicy::Tested ? 1 : 0);
    text += fmt::format("#define GLINT_CASE_COUNT {}\n", plan.cases.size());
    text += fmt::format("#define GLINT_HAS_MASKED {}\n", hasMasked ? 1 : 0);
    return text;
}

std::optional<std::string_view> findEmbedded(std::string_view name) {
    for (const EmbeddedFile& file : embeddedFiles()) {
        if (file.name == name) {
            return file.text;
        }
    }
    return std::nullopt;
}

}  // namespace

void SourceSet::add(std::string name, std::string text) {
    files_.insert_or_assign(std::move(name), std::move(text));
}

std::optional<std::string_view> SourceSet::find(std::string_view name) const {
    const auto place = files_.find(name);
    return place == files_.end() ? std::nullopt : std::optional<std::string_view>(place->second);
}

SourceLookup SourceSet::lookup() const {
    return [this](std::string_view name) { return find(name); };
}

SourceSet makeSourceSet(const Scene& scene, const Plan& plan, AlphaPolicy alpha) {
    SourceSet sources;
    for (const EmbeddedFile& file : embeddedFiles()) {
        sources.add(std::string(file.name), std::string(file.text));
    }
    sources.add("generated/features.glsl", featureDefines());
    sources.add("generated/scene.glsl", sceneDefines(scene, plan, alpha));
    return sources;
}

Result<std::string> interopDeclarations() {
    std::string root;
    for (const EmbeddedFile& file : embeddedFiles()) {
        if (file.name.starts_with(kInteropFolder)) {
            root += fmt::format("#include \"{}\"\n", file.name);
        }
    }
    return flatten("interop", root, findEmbedded, FlattenSide::Cpp);
}

std::uint64_t interopHash() {
    std::string all;
    for (const EmbeddedFile& file : embeddedFiles()) {
        if (file.name.starts_with(kInteropFolder)) {
            all += file.name;
            all += '\n';
            all += file.text;
        }
    }
    return hashBytes(all);
}

}  // namespace glint
