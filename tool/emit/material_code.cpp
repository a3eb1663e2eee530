#include "emit/material_code.h"

#include "emit/context.h"

#include <fmt/format.h>

#include <cctype>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace glint {

namespace {

namespace mustache = kainjow::mustache;

constexpr std::string_view kTemplates[] = {"layers.glsl", "layers_sky.glsl", "layers_traced.glsl",
                                           "material_stages.glsl"};

std::string typeName(std::string name) {
    name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
    return name;
}

std::string hasFeature(const Feature& feature) {
    return fmt::format("{}(features, {})", feature.bit < kFirstInput ? "hasLobe" : "hasInput", feature.macro);
}

// The condition under which code runs; empty if it always runs.
std::string conditionOf(const MaterialModel& model, const FeatureCode& code) {
    const auto feature = [&](int index) { return model.features[static_cast<std::size_t>(index)]; };
    std::string text = code.feature < 0 ? "" : hasFeature(feature(code.feature));
    if (code.unless >= 0) {
        text += fmt::format("{}!{}", text.empty() ? "" : " && ", hasFeature(feature(code.unless)));
    }
    return text;
}

mustache::data stageOf(const MaterialModel& model, const std::vector<const FeatureCode*>& code,
                       std::string FeatureCode::*file) {
    mustache::data list(mustache::data::type::list);
    for (const FeatureCode* const one : code) {
        if ((one->*file).empty()) {
            continue;
        }
        mustache::data entry;
        entry.set("name", one->name);
        const std::string condition = conditionOf(model, *one);
        entry.set("when", condition.empty() ? mustache::data(false) : mustache::data(condition));
        list.push_back(std::move(entry));
    }
    return list;
}

mustache::data includesOf(const std::vector<const FeatureCode*>& code) {
    std::set<std::string> files;
    for (const FeatureCode* const one : code) {
        for (const std::string& file : {one->surface, one->bsdf, one->emission}) {
            if (!file.empty()) {
                files.insert(file);
            }
        }
    }
    mustache::data list(mustache::data::type::list);
    for (const std::string& file : files) {
        mustache::data entry;
        entry.set("file", file);
        list.push_back(std::move(entry));
    }
    return list;
}

// Sets `layers`, from the lowest to the highest, and `mirrors`, those that rays may trace.
void addLayers(mustache::data& context, const MaterialModel& model,
               const std::vector<const FeatureCode*>& code) {
    mustache::data layers(mustache::data::type::list);
    mustache::data mirrors(mustache::data::type::list);
    std::vector<const FeatureCode*> lower;
    int number = 0;
    for (const FeatureCode* const layer : code) {
        if (layer->layer.empty()) {
            continue;
        }
        mustache::data entry;
        entry.set("name", layer->name);
        entry.set("type", typeName(layer->name));
        entry.set("macro", model.features[static_cast<std::size_t>(layer->feature)].macro);
        entry.set("file", layer->layer);
        entry.set("coversEmission", mustache::data(layer->coversEmission));
        entry.set("isMirror", mustache::data(layer->isTraced));
        mustache::data below(mustache::data::type::list);
        mustache::data mirrorsBelow(mustache::data::type::list);
        for (const FeatureCode* const one : lower) {
            mustache::data pair;
            pair.set("name", one->name);
            pair.set("upper", layer->name);
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
        layers.push_back(std::move(entry));
        lower.push_back(layer);
    }
    context.set("layers", layers);
    context.set("mirrors", mirrors);
}

}  // namespace

Status addMaterialCode(const SourceSet& sources, const MaterialModel& model, FeatureMask used,
                       SourceSet& generated) {
    std::vector<const FeatureCode*> code;
    for (const FeatureCode& one : model.code) {
        if (one.feature < 0 || (model.features[static_cast<std::size_t>(one.feature)].mask() & used) != 0) {
            code.push_back(&one);
        }
    }
    mustache::data context;
    addLayers(context, model, code);
    context.set("includes", includesOf(code));
    context.set("surface", stageOf(model, code, &FeatureCode::surface));
    context.set("bsdf", stageOf(model, code, &FeatureCode::bsdf));
    context.set("emission", stageOf(model, code, &FeatureCode::emission));
    for (const std::string_view name : kTemplates) {
        Result<std::string> text = renderTemplate(sources, fmt::format("{}.mustache", name), context);
        if (!text) {
            return text.error();
        }
        generated.add(fmt::format("generated/{}", name), std::move(*text));
    }
    return okStatus();
}

Diagnostic explainGlslError(Diagnostic error, const MaterialModel& model) {
    if (error.id != "glsl" || model.sources.empty()) {
        return error;
    }
    for (const FeatureCode& code : model.code) {
        const std::string folder = code.declaration.substr(0, code.declaration.rfind('/') + 1);
        if (code.isOfPack && !folder.empty() && error.where.starts_with(folder)) {
            error.message += fmt::format("; it is GLSL of the material feature {}", code.name);
            error.hint = "correct the file; docs/material_features.md says what each stage may use";
            return error;
        }
    }
    error.hint =
        "look whether a pack has all functions of its stages (docs/material_features.md); "
        "otherwise this is a defect of Glint";
    return error;
}

Result<const SourceSet*> MaterialCodeOfCases::find(FeatureMask used) {
    FeatureMask withCode = 0;
    for (const FeatureCode& code : model_.code) {
        withCode |= code.feature < 0 ? 0 : model_.features[static_cast<std::size_t>(code.feature)].mask();
    }
    const auto [place, isNew] = made_.try_emplace(used & withCode);
    if (isNew) {
        if (Status status = addMaterialCode(sources_, model_, used, place->second); !status) {
            return status.error();
        }
    }
    return &place->second;
}

}  // namespace glint
