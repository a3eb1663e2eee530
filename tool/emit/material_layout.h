// The record of a material on the device: which fields it has, and where. A package's records have the fields
// that some key of its scenes needs. Fields of different models lie over each other, because a material has
// one model.
#pragma once

#include "plan/plan.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

struct RecordField {
    std::string name;  // the full name of a parameter or derived field
    const materials::ValueType* type = &materials::kTypes[0];
    int count = 0;              // elements of an array; 0: a single value
    std::string note{};         // unit and meaning, for comments
    std::uint32_t offset = 0;   // bytes
    int parameter = -1;         // index into MaterialModel::parameters, or
    int derived = -1;           // into MaterialModel::derived
    std::vector<int> models{};  // whose records have it, as RecordUse::models

    std::uint32_t numbers() const {
        return static_cast<std::uint32_t>(type->channels * (count > 0 ? count : 1));
    }
    std::uint32_t bytes() const {
        return materials::kNumberBytes * numbers();
    }
};

// A texture of records.
struct TextureSlot {
    int texture = 0;            // index into MaterialModel::textures
    int slot = 0;               // that textures of different models share
    std::vector<int> models{};  // as RecordField::models
};

struct MaterialLayout {
    const materials::MaterialModel* model = nullptr;
    std::size_t modelCount = 0;  // of the materials of the package
    std::vector<RecordField> fields;
    std::vector<TextureSlot> textures;
    std::uint32_t ownOffset = 0;  // bytes: where the fields begin that only some models have
    std::uint32_t textureOffset = 0;
    std::uint32_t textureCount = 0;
    std::uint32_t bytes = 0;
    bool turnsFrames = false;  // Some key has turnedFrames.
    // makeIndex() makes the rest, once `fields` and `textures` are there.
    void makeIndex();
    std::map<std::string, std::size_t, std::less<>> byName{};  // indices into `fields`
    // By model: ascending indices into `fields` and into `textures` of what its records have.
    struct Rows {
        std::vector<std::size_t> fields{};
        std::vector<std::size_t> textures{};
    };
    std::map<int, Rows> byModel{};

    std::uint32_t ownFloats() const {
        return (textureOffset - ownOffset) / 4;
    }
    // Returns whether the records of all models have the field.
    bool isShared(const RecordField& field) const {
        return field.models.size() == modelCount;
    }
    // Returns the field of the parameter that has the role, or null.
    const RecordField* fieldOf(package::Role role) const;
    // Returns the field of that name, or null.
    const RecordField* fieldNamed(std::string_view name) const;
    // Returns the place of a texture in the record, or -1.
    int slotOf(int texture) const;
    // Returns that place, or -1 if records of the model lack the texture.
    int slotOf(int texture, int model) const;
};

MaterialLayout makeMaterialLayout(const materials::MaterialModel& model, std::span<const RecordUse> uses);

// The layout of a plan's package.
MaterialLayout materialLayoutOf(const Plan& plan);

// Returns the bytes of a record: the values of the material and the transforms of its textures. Which
// textures these are is for makeMaterialTables() to settle.
std::vector<std::uint8_t> makeMaterialRecord(const materials::Material& material,
                                             const MaterialLayout& layout);

// Returns the GLSL of the record: the struct MaterialRecord, a constant for each texture and each value of an
// enum, and for each declared field a macro GLINT_MATERIAL_<FIELD>(hit), which is a constant where no record
// has the field; those of arrays take an index, too. Of what belongs to models of packs, it has that of the
// models of `used`.
std::string recordDeclarations(const MaterialLayout& layout, const materials::FeatureMask& used);
// Returns the struct alone, in GLSL or, with the types of interop/types.h, in C++. Its comments list the
// fields of the models of `used`.
enum class RecordLanguage : std::uint8_t { Glsl, Cpp };
std::string recordStruct(const MaterialLayout& layout, RecordLanguage language,
                         const materials::FeatureMask& used = materials::kAllFeatures);
// Returns the constant of a value of an enum: "kToonEdgeSoft".
std::string nameConstant(const materials::Parameter& parameter, std::size_t value);

}  // namespace glint::compiler
