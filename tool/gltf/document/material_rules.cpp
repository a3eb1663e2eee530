#include "gltf/document/material_rules.h"

#include "gltf/document/rules.h"

#include <array>
#include <cmath>
#include <limits>

namespace glint::gltf {

namespace {

constexpr std::array kTransformRules{rules::numbers("offset", 2), rules::number("rotation"),
                                     rules::numbers("scale", 2),
                                     rules::integer("texCoord", 0.0, rules::kMaxInt)};
constexpr std::array kTextureInfoExtensions{rules::object("KHR_texture_transform", kTransformRules)};

Rule parameterRule(const materials::Parameter& parameter, std::string_view name) {
    Rule rule = parameter.channels == 1 ? rules::number(name)
                                        : rules::numbers(name, static_cast<std::size_t>(parameter.channels));
    if (std::isinf(parameter.high)) {
        // Exporters write the largest number they know for an infinite one. A float need not be able to hold
        // it.
        rule.min = std::numeric_limits<double>::lowest();
        rule.max = std::numeric_limits<double>::max();
    }
    return rule;
}

}  // namespace

MaterialRules::MaterialRules(const materials::MaterialModel& model) {
    std::vector<Rule> extensions;
    material_ = rulesOf(model, 0);
    for (std::size_t i = 1; i < model.objects.size(); ++i) {
        const materials::MaterialObject& object = model.objects[i];
        nested_.push_back(rulesOf(model, static_cast<int>(i)));
        (object.isExtension ? extensions : material_).push_back(rules::object(object.name, nested_.back()));
    }
    nested_.push_back(std::move(extensions));
    for (const Rule& rule : {rules::text("name"), rules::text("alphaMode"), rules::boolean("doubleSided"),
                             rules::object("extensions", nested_.back())}) {
        material_.push_back(rule);
    }
}

std::vector<Rule> MaterialRules::rulesOf(const materials::MaterialModel& model, int object) {
    std::vector<Rule> found;
    for (const materials::Parameter& parameter : model.parameters) {
        if (parameter.object == object && parameter.place.find('/') == std::string::npos) {
            found.push_back(parameterRule(parameter, parameter.place));
        }
    }
    for (const materials::MaterialTexture& texture : model.textures) {
        for (const materials::MaterialTexture::Place& place : texture.places) {
            if (place.object != object) {
                continue;
            }
            std::vector<Rule>& info = nested_.emplace_back();
            info = {rules::index("index", "/textures", true), rules::integer("texCoord", 0.0, rules::kMaxInt),
                    rules::object("extensions", kTextureInfoExtensions)};
            for (const materials::Parameter& parameter : model.parameters) {
                // A parameter beside a texture: "normalTexture/scale".
                const std::string_view where = parameter.place;
                if (parameter.object == object && where.starts_with(place.member + "/")) {
                    info.push_back(parameterRule(parameter, where.substr(place.member.size() + 1)));
                }
            }
            found.push_back(rules::object(place.member, info));
        }
    }
    return found;
}

}  // namespace glint::gltf
