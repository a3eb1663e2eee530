// The members of the declarations of material features, in one table. The reader refuses what the table does
// not have, and docs/schemas/material_feature.json follows from it.
#pragma once

#include "base/json.h"
#include "materials/material_model.h"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>

namespace glint::materials {

// --- The words that members may have ---

struct NamedStage {
    std::string_view name;
    Stage stage;
};
inline constexpr NamedStage kStages[] = {
    {"attributes", Stage::Attributes},
    {"coordinates", Stage::Coordinates},
    {"base", Stage::Base},
    {"surface", Stage::Surface},
    {"layer", Stage::Layer},
    {"emission", Stage::Emission},
    {"opacity", Stage::Opacity},
};

// Where a surface takes light from.
enum class Light : std::uint8_t { None, Front, Both };

struct NamedLight {
    std::string_view name;
    Light light;
};
inline constexpr NamedLight kLights[] = {
    {"none", Light::None}, {"front", Light::Front}, {"both", Light::Both}};

struct NamedBehaviour {
    std::string_view name;
    Behaviour behaviour;
    std::string_view text;  // for explain, where the declaration has none
};
inline constexpr NamedBehaviour kBehaviours[] = {
    {"reflects", Behaviour::Reflects, "has the roughness {}"},
    {"transmits", Behaviour::Transmits, "lets light through"},
    {"scatters", Behaviour::Scatters, "scatters light diffusely"},
    {"emits", Behaviour::Emits, "emits light"},
};

// What a feature may read beyond its own values.
struct NamedNeed {
    std::string_view name;
    int texCoord;  // the UV set; -1: a frame
};
inline constexpr NamedNeed kNeeds[] = {{"tangents", -1}, {"texCoord0", 0}, {"texCoord1", 1}};

// The most elements of an array.
inline constexpr int kMostElements = 256;

// --- The members ---

// The objects of a declaration.
enum class Place : std::uint8_t {
    File,
    Glsl,
    Parameter,
    Texture,
    Attribute,
    Derived,
    Feature,
    Reason,
    Effect,
    Replaces,
    Excludes,
    Cost,
    Count
};

constexpr std::uint32_t placeBit(Place place) {
    return 1U << static_cast<unsigned>(place);
}

// The roles, and the places that may have them. Glint's own code asks for roles, and so knows no name of a
// declaration.
struct NamedRole {
    package::Role role;
    std::uint32_t places;
    std::string_view type = "";  // of the parameter
    std::string_view name = nameOf(role);
};
inline constexpr NamedRole kRoles[] = {
    {package::Role::BaseColor, placeBit(Place::Parameter) | placeBit(Place::Texture), "vec4"},
    {package::Role::AlphaCutoff, placeBit(Place::Parameter), "float"},
    {package::Role::Emission, placeBit(Place::Parameter) | placeBit(Place::Texture), "color"},
    {package::Role::EmissionStrength, placeBit(Place::Parameter), "float"},
    {package::Role::TangentFrame, placeBit(Place::Texture)},
    {package::Role::AlphaTest, placeBit(Place::Feature)},
    {package::Role::Emits, placeBit(Place::Feature)},
    {package::Role::Normals, placeBit(Place::Feature)},
    {package::Role::Tangents, placeBit(Place::Feature)},
    {package::Role::TexCoord0, placeBit(Place::Feature)},
    {package::Role::TexCoord1, placeBit(Place::Feature)},
    {package::Role::TextureTransform, placeBit(Place::Feature)},
    {package::Role::TurnedFrames, placeBit(Place::Feature)},
    {package::Role::VertexColor, placeBit(Place::Feature)},
    {package::Role::DoubleSided, placeBit(Place::Feature)},
};
static_assert(std::size(kRoles) + 1 == static_cast<std::size_t>(package::Role::Count));

struct MemberRow {
    std::string_view name;
    std::uint32_t places;      // where it may stand
    base::Json (*schema)();    // of its value
    std::string_view about;    // a sentence
    std::uint32_t needed = 0;  // the places that must have it

    bool standsAt(Place place) const {
        return (places & placeBit(place)) != 0;
    }
    bool isNeededAt(Place place) const {
        return (needed & placeBit(place)) != 0;
    }
};

// A member that says something only beside others, or only without them.
struct MemberRule {
    Place place;
    std::string_view members;  // words, each of which the rule is for
    // One of the two is empty.
    std::string_view with;     // words, of which one has to be there
    std::string_view without;  // words, of which none may be there
    std::string_view message;
    std::string_view hint;
};

// Returns whether a text of words has the word.
bool hasWord(std::string_view words, std::string_view word);
std::span<const MemberRow> memberRows();
std::span<const MemberRule> memberRules();
// The JSON schema of a declaration.
base::Json declarationSchema();

}  // namespace glint::materials
