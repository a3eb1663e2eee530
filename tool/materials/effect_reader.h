// Reads the declarations of effects.
#pragma once

#include "materials/declaration_json.h"
#include "materials/effect_declaration.h"

#include <string_view>
#include <vector>

namespace glint::materials {

// The members that a declaration may have.
std::vector<std::string_view> effectMembers();
// Reads the declaration in `file`. Throws DeclarationFault.
EffectDeclaration readEffect(const Members& members, std::string_view file, bool isOfPack);
// Orders the effects: their place is the number of their bit. Throws DeclarationFault.
void numberEffects(std::vector<EffectDeclaration>& effects);

}  // namespace glint::materials
