#include "emit/material_code.h"

#include "emit/context.h"
#include "resolve/host.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

namespace mustache = kainjow::mustache;

constexpr std::string_view kTemplates[] = {"layers.glsl", "layers_sky.glsl", "layers_traced.glsl",
                                           "material_stages.glsl"};
constexpr std::string_view kMaskTemplate = "mask_stages.glsl";

// The keys that the code runs for: those of the module's cases, or any.
enum class Asked : std::uint8_t { OfModule, OfAnyKey };

// The macro that asks whether a key has the feature.
std::string hasMacro(const materials::Feature& feature, Asked asked) {
    return (asked == Asked::OfModule ? "GLINT_HAS_" : "GLINT_KEY_HAS_") + feature.macroEnd();
}

std::string hasFeature(const materials::Feature& feature, Asked asked) {
    return hasMacro(feature, asked) + "(features)";
}

// The condition under which code runs; empty if it always runs.
std::string conditionOf(const materials::MaterialModel& model, const materials::FeatureMask& used,
                        const materials::FeatureCode& code, Asked asked) {
    const auto has = [&](int feature) {
        return hasFeature(model.features[static_cast<std::size_t>(feature)], asked);
    };
    std::string text = code.feature < 0 ? "" : has(code.feature);
    for (const int other : model.indicesOf(code.unless & used)) {
        text += fmt::format("{}!{}", text.empty() ? "" : " && ", has(other));
    }
    return text;
}

mustache::data stageOf(const materials::MaterialModel& model, const materials::FeatureMask& used,
                       const std::vector<const materials::FeatureCode*>& code,
                       std::string materials::FeatureCode::*file, Asked asked = Asked::OfModule) {
    mustache::data list(mustache::data::type::list);
    for (const materials::FeatureCode* const one : code) {
        if ((one->*file).empty()) {
            continue;
        }
        const std::string condition = conditionOf(model, used, *one, asked);
        list.push_back(mustache::object{
            {"name", one->name},
            {"when", condition.empty() ? mustache::data(false) : mustache::data(condition)}});
    }
    return list;
}

using CodeFile = std::string materials::FeatureCode::*;

mustache::data includesOf(const std::vector<const materials::FeatureCode*>& code,
                          std::span<const CodeFile> stages) {
    std::set<std::string> files;
    for (const materials::FeatureCode* const one : code) {
        for (const CodeFile stage : stages) {
            if (!(one->*stage).empty()) {
                files.insert(one->*stage);
            }
        }
    }
    mustache::data list(mustache::data::type::list);
    for (const std::string& file : files) {
        list.push_back(mustache::object{{"file", file}});
    }
    return list;
}

// Sets `layers`, from the lowest to the highest, and `mirrors`, those that rays may trace.
void addLayers(mustache::data& context, const materials::MaterialModel& model,
               const materials::FeatureMask& used, const std::vector<const materials::FeatureCode*>& code) {
    mustache::data layers(mustache::data::type::list);
    mustache::data mirrors(mustache::data::type::list);
    std::vector<const materials::FeatureCode*> lower;
    int number = 0;
    for (const materials::FeatureCode* const layer : code) {
        if (layer->layer.empty()) {
            continue;
        }
        mustache::data entry(mustache::object{
            {"name", layer->name},
            {"type", materials::capitalized(layer->name)},
            {"has", hasMacro(model.features[static_cast<std::size_t>(layer->feature)], Asked::OfModule)},
            {"file", layer->layer},
            {"coversEmission", layer->coversEmission},
            {"isMirror", layer->isTraced}});
        mustache::data below(mustache::data::type::list);
        mustache::data mirrorsBelow(mustache::data::type::list);
        for (const materials::FeatureCode* const one : lower) {
            const mustache::object pair{{"name", one->name}, {"upper", layer->name}};
            below.push_back(pair);
            if (one->isTraced) {
                mirrorsBelow.push_back(pair);
            }
        }
        entry.set("lower", below);
        entry.set("lowerMirrors", mirrorsBelow);
        if (layer->isTraced) {
            entry.set("comma", number > 0 ? ", " : "");
            entry.set("number", std::to_string(++number));
            mirrors.push_back(entry);
        }
        layers.push_back(entry);
        lower.push_back(layer);
    }
    mustache::data diffuse(mustache::data::type::list);
    for (const materials::FeatureCode* const one : code) {
        if (!one->diffuse.empty()) {
            diffuse.push_back(mustache::object{{"name", one->name},
                                               {"type", materials::capitalized(one->name)},
                                               {"file", one->diffuse},
                                               {"when", conditionOf(model, used, *one, Asked::OfModule)}});
        }
    }
    mustache::data models(mustache::data::type::list);
    bool anyShadesAll = false;
    for (const materials::FeatureCode* const one : code) {
        if (!one->model.empty()) {
            models.push_back(mustache::object{
                {"name", one->name},
                {"type", materials::capitalized(one->name)},
                {"file", one->model},
                {"has", hasMacro(model.features[static_cast<std::size_t>(one->feature)], Asked::OfModule)},
                {"isSampled", mustache::data(one->isSampled)},
                {"shadesAll", mustache::data(one->shadesAll)}});
            anyShadesAll = anyShadesAll || one->shadesAll;
        }
    }
    context.set("anyShadesAll", mustache::data(anyShadesAll));
    context.set("models", models);
    context.set("diffuse", diffuse);
    context.set("layers", layers);
    context.set("mirrors", mirrors);
}

std::vector<const materials::FeatureCode*> codeOf(const materials::MaterialModel& model,
                                                  const materials::FeatureMask& used) {
    std::vector<const materials::FeatureCode*> code;
    for (const materials::FeatureCode& one : model.code) {
        if (one.feature < 0 || used.has(model.features[static_cast<std::size_t>(one.feature)].bit)) {
            code.push_back(&one);
        }
    }
    return code;
}

// Returns the attributes that code of the used features reads, in the order of their values.
std::vector<const materials::VertexAttribute*> attributesOf(const materials::MaterialModel& model,
                                                            const materials::FeatureMask& used) {
    std::vector<const materials::VertexAttribute*> attributes;
    for (const materials::VertexAttribute& attribute : model.attributes) {
        if (used.has(model.features[static_cast<std::size_t>(attribute.feature)].bit)) {
            attributes.push_back(&attribute);
        }
    }
    return attributes;
}

// The channels of a value: "{a}" for each, separated by ", ".
std::string channelsOf(const materials::VertexAttribute& attribute) {
    std::string text;
    for (int i = 0; i < attribute.type->channels; ++i) {
        const float value = attribute.fallback ? (*attribute.fallback)[static_cast<std::size_t>(i)] : 0.0F;
        text += fmt::format("{}{:#.9g}", i == 0 ? "" : ", ", value);
    }
    return text;
}

}  // namespace

std::string vertexAttributeCode(const materials::MaterialModel& model, const materials::FeatureMask& used) {
    const std::vector<const materials::VertexAttribute*> attributes = attributesOf(model, used);
    if (attributes.empty()) {
        return "#define GLINT_VERTEX_ATTRIBUTES 0\n";
    }
    std::string members;
    std::string fallbacks;
    std::string reads;
    int stride = 0;
    for (const materials::VertexAttribute* const attribute : attributes) {
        stride += attribute->type->channels;
    }
    int offset = 0;
    constexpr const char* kChannels[] = {"x", "y", "z", "w"};
    for (const materials::VertexAttribute* const attribute : attributes) {
        members += fmt::format("    {} {};\n", attribute->type->glsl, attribute->name);
        fallbacks += fmt::format("    values.{} = {}({});\n", attribute->name, attribute->type->glsl,
                                 channelsOf(*attribute));
        reads += fmt::format(
            "    if ({}) {{\n",
            hasFeature(model.features[static_cast<std::size_t>(attribute->feature)], Asked::OfAnyKey));
        for (int i = 0; i < attribute->type->channels; ++i) {
            reads += fmt::format(
                "        values.{}{} = vertexAttribute(geometry, corner, weights, {}u);\n", attribute->name,
                attribute->type->channels == 1 ? "" : fmt::format(".{}", kChannels[i]), offset++);
        }
        reads += "    }\n";
    }
    return fmt::format(
        "// The attributes of vertices that features of the package read beside those of glTF's core. Each "
        "vertex has "
        "the\n// values of all of them, one after the other.\n"
        "#define GLINT_VERTEX_ATTRIBUTES 1\n"
        "const uint kVertexAttributeStride = {}u;\n"
        "struct VertexAttributes {{\n{}}};\n\n"
        "float vertexAttribute(HostGeometry geometry, uvec3 corner, vec3 weights, uint channel) {{\n"
        "    return dot(weights, vec3(hostAttribute(geometry, corner.x, channel, kVertexAttributeStride),\n"
        "                             hostAttribute(geometry, corner.y, channel, kVertexAttributeStride),\n"
        "                             hostAttribute(geometry, corner.z, channel, kVertexAttributeStride)));\n"
        "}}\n\n"
        "VertexAttributes fetchAttributes(HostGeometry geometry, uvec3 corner, vec3 weights, Features "
        "features) {{\n"
        "    VertexAttributes values;\n{}{}    return values;\n}}\n",
        stride, members, fallbacks, reads);
}

Status addMaskCode(const SourceSet& sources, const materials::MaterialModel& model,
                   const materials::FeatureMask& used, SourceSet& generated) {
    const std::vector<const materials::FeatureCode*> code = codeOf(model, used);
    constexpr CodeFile kStages[] = {&materials::FeatureCode::coordinates, &materials::FeatureCode::opacity};
    mustache::data context;
    context.set("includes", includesOf(code, kStages));
    context.set("coordinates",
                stageOf(model, used, code, &materials::FeatureCode::coordinates, Asked::OfAnyKey));
    context.set("opacity", stageOf(model, used, code, &materials::FeatureCode::opacity, Asked::OfAnyKey));
    GLINT_TRY(auto text, renderTemplate(sources, fmt::format("{}.mustache", kMaskTemplate), context));
    generated.add(fmt::format("generated/{}", kMaskTemplate), std::move(text));
    return okStatus();
}

materials::FeatureMask maskCodeFeatures(const materials::MaterialModel& model) {
    materials::FeatureMask mask = 0;
    for (const materials::FeatureCode& code : model.code) {
        mask |= code.coordinates.empty() && code.opacity.empty()
                    ? 0
                    : model.features[static_cast<std::size_t>(code.feature)].mask();
    }
    return mask;
}

Status addMaterialCode(const SourceSet& sources, const materials::MaterialModel& model,
                       const materials::FeatureMask& used, SourceSet& generated) {
    const std::vector<const materials::FeatureCode*> code = codeOf(model, used);
    constexpr CodeFile kStages[] = {&materials::FeatureCode::coordinates, &materials::FeatureCode::surface,
                                    &materials::FeatureCode::bsdf, &materials::FeatureCode::emission};
    mustache::data context;
    addLayers(context, model, used, code);
    context.set("includes", includesOf(code, kStages));
    context.set("coordinates", stageOf(model, used, code, &materials::FeatureCode::coordinates));
    const bool changesCoordinates = std::ranges::any_of(
        code, [](const materials::FeatureCode* one) { return !one->coordinates.empty(); });
    context.set("changesCoordinates", mustache::data(changesCoordinates));
    context.set("surface", stageOf(model, used, code, &materials::FeatureCode::surface));
    context.set("bsdf", stageOf(model, used, code, &materials::FeatureCode::bsdf));
    context.set("emission", stageOf(model, used, code, &materials::FeatureCode::emission));
    for (const std::string_view name : kTemplates) {
        GLINT_TRY(auto text, renderTemplate(sources, fmt::format("{}.mustache", name), context));
        generated.add(fmt::format("generated/{}", name), std::move(text));
    }
    return okStatus();
}

Diagnostic explainGlslError(Diagnostic error, const materials::MaterialModel& model,
                            const std::string& host) {
    if (error.id != "glsl" || (model.sources.empty() && host.empty())) {
        return error;
    }
    if (!host.empty() && isHostPlace(error.where, host)) {
        error.message += "; it is GLSL of --host";
        error.hint = "correct the file; docs/host.md says which functions it must have";
        return error;
    }
    const auto isBeside = [&](const std::string& declaration) {
        const std::string folder = declaration.substr(0, declaration.rfind('/') + 1);
        return !folder.empty() && error.where.starts_with(folder);
    };
    for (const materials::EffectDeclaration& effect : model.effects) {
        if (effect.isOfPack && isBeside(effect.declaration)) {
            error.message += fmt::format("; it is GLSL of the effect {}", effect.name);
            error.hint = "correct the file; docs/effects.md says which functions it must have";
            return error;
        }
    }
    for (const materials::FeatureCode& code : model.code) {
        if (code.isOfPack && isBeside(code.declaration)) {
            error.message += fmt::format("; it is GLSL of the material feature {}", code.name);
            error.hint = "correct the file; docs/material_features.md says what each stage may use";
            return error;
        }
    }
    error.hint =
        host.empty()
            ? "look whether a pack has all functions of its stages and effects (docs/material_features.md, "
              "docs/effects.md); "
              "otherwise this is a defect of Glint"
            : "look whether the files of --host have all functions of those that they replace "
              "(docs/host.md), and packs those of their stages; otherwise this is a defect of Glint";
    return error;
}

MaterialCodeOfCases::MaterialCodeOfCases(const Plan& plan)
    : model_(*plan.model),
      records_(plan.records),
      layout_(materialLayoutOf(plan)),
      ofMasks_(maskCodeFeatures(*plan.model)) {
    for (const materials::FeatureCode& code : model_.code) {
        withCode_ |= code.feature < 0 ? 0 : model_.features[static_cast<std::size_t>(code.feature)].mask();
    }
}

bool MaterialCodeOfCases::isOf(const Plan& plan) const {
    return haveSameDeclarations(model_, *plan.model) && records_ == plan.records;
}

Result<std::shared_ptr<const SourceSet>> MaterialCodeOfCases::find(const SourceSet& sources,
                                                                   const materials::FeatureMask& used) {
    const materials::FeatureMask withCode = used & withCode_;
    if (const auto known = made_.find(withCode); known != made_.end()) {
        return known->second;
    }
    const auto files = std::make_shared<SourceSet>();
    GLINT_TRY_DO(addMaterialCode(sources, model_, used, *files));
    if (!model_.models.empty()) {
        // Whatever the case, rays meet surfaces whose opacity is the code of another one.
        const materials::FeatureMask named = model_.withBases(used | ofMasks_);
        files->add("generated/features.glsl", model_.featureDefines(named));
        files->add("generated/material_record.glsl", recordDeclarations(layout_, named));
    }
    return made_.emplace(withCode, files).first->second;
}

}  // namespace glint::compiler
