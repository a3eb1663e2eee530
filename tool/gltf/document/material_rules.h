// Rules for the JSON of a material, as the declarations give them. They check only types, because values out
// of range are clamped while reading.
#pragma once

#include "gltf/document/schema.h"
#include "materials/material_model.h"

#include <deque>
#include <span>
#include <vector>

namespace glint::gltf {

// The model must outlive the rules.
class MaterialRules {
public:
    explicit MaterialRules(const materials::MaterialModel& model);
    MaterialRules(const MaterialRules&) = delete;
    MaterialRules& operator=(const MaterialRules&) = delete;

    std::span<const Rule> rules() const {
        return material_;
    }

private:
    std::vector<Rule> rulesOf(const materials::MaterialModel& model, int object);

    std::deque<std::vector<Rule>> nested_;  // Rule::rules point into it.
    std::vector<Rule> material_;
};

}  // namespace glint::gltf
