#include "view/pick.h"

#include "gltf/import.h"
#include "gltf/scene_list.h"
#include "image/tone.h"
#include "plan/plan_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace glint::view {

namespace {

std::string describePath(PixelPath path) {
    switch (path) {
        case PixelPath::NoSurface:
            return "no surface";
        case PixelPath::NoRay:
            return "no ray: rough, unlit, or the sample would bring no light";
        case PixelPath::Screen:
            return "found on the screen, without a ray";
        case PixelPath::Hit:
            return "a ray, which hit";
        case PixelPath::Miss:
            return "a ray, which left the scene";
    }
    return "";
}

void addRays(Picture& picture, std::size_t pixel, std::vector<Field>& fields) {
    for (const package::EffectInfo& effect : picture.build().package->effects()) {
        if (effect.kind != package::EffectKind::Rays) {
            continue;
        }
        const Result<std::vector<PixelPath>> paths = picture.renderer().readCoverage(effect.effect);
        fields.push_back({"rays of " + std::string(effect.name),
                          paths ? describePath((*paths)[pixel]) : paths.error().message});
    }
}

// Adds the case's cost by the model, and the length of its code.
void addCost(const Picture& picture, std::uint32_t shaderId, std::vector<Field>& fields) {
    const compiler::Build& build = *picture.build().resolved;
    const compiler::PlanCost cost = costPlan(build.plan, build.settings.compile.plan);
    const auto found =
        std::ranges::find(cost.cases, static_cast<int>(shaderId), &compiler::CaseCost::shaderId);
    if (found != cost.cases.end()) {
        fields.push_back({"cost by the model",
                          fmt::format("{:.0f} instructions, {:.0f} fetches; {:.2f} of an average hit in vain",
                                      found->code.instructions, found->code.fetches, found->inVain)});
    }
    const std::vector<std::uint32_t>& counts = picture.build().instructions;
    if (shaderId < counts.size() && counts[shaderId] > 0) {
        fields.push_back({"SPIR-V of the case", fmt::format("{} instructions", counts[shaderId])});
    }
}

}  // namespace

Result<Pick> pickPixel(const Request& request, Picture& picture, std::uint32_t x, std::uint32_t y,
                       double exposure) {
    Pick pick{x, y, {}, -1};
    GLINT_TRY(const auto place, picture.renderer().readPlace(x, y));
    const Result<LinearImage> image = picture.renderer().readOutput();
    if (!image) {
        return image.error();
    }
    const std::size_t pixel = std::size_t{y} * image->width + x;
    const std::array<float, 4>& value = image->pixels[pixel];
    const std::array<std::uint8_t, 3> shown = image::toDisplay({value[0], value[1], value[2]}, exposure);
    pick.fields.push_back({"radiance", fmt::format("{:.5g} {:.5g} {:.5g}", value[0], value[1], value[2])});
    pick.fields.push_back({"shown as", fmt::format("{} {} {}", shown[0], shown[1], shown[2])});
    if (!place) {
        pick.fields.push_back({"surface", "none: the pixel sees the sky"});
        addRays(picture, pixel, pick.fields);
        return pick;
    }
    const gltf::Scene& scene = picture.scene();
    const SurfacePlace& surface = *place;
    const std::size_t node = picture.data().sources[surface.instance].node;
    pick.fields.push_back({"instance", fmt::format("{} (/nodes/{})", surface.instance, node)});
    pick.fields.push_back(
        {"primitive", fmt::format("/meshes/{}/primitives/{}", surface.mesh, surface.primitive)});
    for (const materials::PrimitiveInputs& inputs : planningInputs(scene)) {
        if (static_cast<std::uint32_t>(inputs.mesh) == surface.mesh &&
            static_cast<std::uint32_t>(inputs.primitive) == surface.primitive) {
            pick.material = inputs.material;
        }
    }
    if (pick.material >= 0) {
        const compiler::Build& build = *picture.build().resolved;
        pick.fields.push_back(
            {"material", fmt::format("{}: {}", pick.material, build.scenes->materialName(pick.material))});
        const std::vector<Field> why = request.explain(build, pick.material);
        pick.fields.insert(pick.fields.end(), why.begin(), why.end());
    }
    const std::span<const package::CaseEntry> cases = picture.build().package->cases();
    pick.fields.push_back(
        {"bucket", surface.shaderId < cases.size()
                       ? fmt::format("{}: hits of case {} {}", surface.shaderId + 1, surface.shaderId,
                                     picture.build().package->string(cases[surface.shaderId].name))
                       : fmt::format("{}: no case", surface.shaderId + 1)});
    addRays(picture, pixel, pick.fields);
    addCost(picture, surface.shaderId, pick.fields);
    return pick;
}

}  // namespace glint::view
