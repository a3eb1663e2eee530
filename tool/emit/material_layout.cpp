#include "emit/material_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <interop/scene.h>

namespace glint::compiler {

namespace {

constexpr std::uint32_t kFloatBytes = 4;
// Frames of features without a texture are those of its coordinates.
constexpr std::string_view kFrameTexture = "normalTexture";

bool isUsed(const materials::MaterialModel& model, int feature, materials::FeatureMask used) {
    return feature < 0 || used.has(model.features[static_cast<std::size_t>(feature)].bit);
}

std::string noteOf(const std::string& unit, const std::string& about) {
    return unit.empty() || about.empty() ? unit + about : unit + "; " + about;
}

// "clearcoatRoughnessFactor" becomes "CLEARCOAT_ROUGHNESS_FACTOR".
std::string upperSnake(std::string_view name) {
    std::string text;
    for (const char c : name) {
        const bool isUpper = c >= 'A' && c <= 'Z';
        text += isUpper ? "_" : "";
        text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    return text;
}

std::string textureConstant(std::string_view name) {
    std::string text = "k";
    text += static_cast<char>(name[0] - 'a' + 'A');
    text += name.substr(1);
    return text;
}

gpu::TextureRecord transformed(const materials::TextureTransform& transform) {
    const auto rowOf = [](const std::array<double, 3>& row) {
        return gpu::vec3{static_cast<float>(row[0]), static_cast<float>(row[1]), static_cast<float>(row[2])};
    };
    const materials::TransformRows rows = rowsOf(transform);
    gpu::TextureRecord record{};
    record.rowU = rowOf(rows[0]);
    record.rowV = rowOf(rows[1]);
    return record;
}

// Evaluates expressions at the values of a material, whatever its textures and animations do.
double derivedValue(const materials::MaterialFacts& facts, const materials::DerivedField& field,
                    int channel) {
    const std::size_t row = field.channels.size() == 1 ? 0 : static_cast<std::size_t>(channel);
    const materials::Channels number = field.channels[row].number(facts);
    const bool shared = number.count == 1 || field.channels.size() > 1;
    return number.of[shared ? 0 : static_cast<std::size_t>(channel)].low;
}

// The macros that read a field of a record, and of the record of a hit's material.
std::string fieldMacros(std::string_view name, std::string_view value) {
    const std::string macro = upperSnake(name);
    return fmt::format(
        "#define GLINT_RECORD_{0}(record) {1}\n#define GLINT_MATERIAL_{0}(hit) "
        "GLINT_RECORD_{0}(GLINT_MATERIAL(hit))\n",
        macro, value);
}

std::string literalOf(const std::string& type, std::span<const float> values) {
    std::string text = type == "float" ? "" : type + "(";
    for (std::size_t i = 0; i < values.size(); ++i) {
        text += fmt::format("{}{:#.9g}", i == 0 ? "" : ", ", std::isinf(values[i]) ? 0.0F : values[i]);
    }
    return text + (type == "float" ? "" : ")");
}

// The expression that reads a field. Those of models lie over each other, as floats.
std::string readOf(const MaterialLayout& layout, const RecordField& field) {
    if (field.model < 0) {
        return fmt::format("(record).{}", field.name);
    }
    const std::uint32_t first = (field.offset - layout.ownOffset) / kFloatBytes;
    std::string text = field.channels == 1 ? "" : field.type + "(";
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(field.channels); ++i) {
        text += fmt::format("{}(record).own[{}]", i == 0 ? "" : ", ", first + i);
    }
    return text + (field.channels == 1 ? "" : ")");
}

// Whether a frame may be that of a texture's coordinates though no key reads the texture.
bool takesFrameOf(const materials::MaterialModel& model, int texture, materials::FeatureMask used) {
    const materials::FeatureMask sets = model.mask("texCoord0") | model.mask("texCoord1");
    const bool matters = (used & sets) == sets || (used & model.mask("turnedFrames")) != 0;
    return matters && model.textures[static_cast<std::size_t>(texture)].name == kFrameTexture &&
           std::ranges::any_of(model.features, [&](const materials::Feature& feature) {
               return feature.needsTangents && feature.texture < 0 && used.has(feature.bit);
           });
}

}  // namespace

int MaterialLayout::slotOf(int texture) const {
    const auto found = std::ranges::find(textures, texture, &TextureSlot::texture);
    return found == textures.end() ? -1 : found->slot;
}

MaterialLayout makeMaterialLayout(const materials::MaterialModel& model, materials::FeatureMask used) {
    MaterialLayout layout;
    layout.model = &model;
    layout.turnsFrames = (used & model.mask("turnedFrames")) != 0;
    const auto modelOf = [&](int feature) {
        return feature < 0 ? -1 : model.features[static_cast<std::size_t>(feature)].model;
    };
    // What all models may have comes first. The fields of each model follow, all of them in the same place.
    const auto addFields = [&](int owner) {
        std::uint32_t end = layout.ownOffset;
        const auto append = [&](RecordField field, int feature) {
            if (isUsed(model, feature, used) && modelOf(feature) == owner) {
                field.model = owner;
                field.offset = end;
                end += kFloatBytes * static_cast<std::uint32_t>(field.channels);
                layout.fields.push_back(std::move(field));
            }
        };
        for (std::size_t i = 0; i < model.parameters.size(); ++i) {
            const materials::Parameter& parameter = model.parameters[i];
            if (parameter.inRecord) {
                append({parameter.name, parameter.type, noteOf(parameter.unit, parameter.about),
                        parameter.channels, 0, static_cast<int>(i), -1},
                       parameter.feature);
            }
        }
        for (std::size_t i = 0; i < model.derived.size(); ++i) {
            const materials::DerivedField& field = model.derived[i];
            append({field.name, field.type, noteOf(field.unit, field.about), field.count, 0, -1,
                    static_cast<int>(i)},
                   field.feature);
        }
        return end;
    };
    int slots = 0;
    const auto addTextures = [&](int owner) {
        int slot = layout.sharedTextures;
        for (std::size_t i = 0; i < model.textures.size(); ++i) {
            const int feature = model.textures[i].feature;
            if (modelOf(feature) == owner &&
                (isUsed(model, feature, used) || takesFrameOf(model, static_cast<int>(i), used))) {
                layout.textures.push_back({static_cast<int>(i), slot++, owner});
            }
        }
        slots = std::max(slots, slot);
        return slot;
    };
    layout.ownOffset = addFields(-1);
    layout.sharedTextures = addTextures(-1);
    layout.textureOffset = layout.ownOffset;
    for (int owner = 0; owner < static_cast<int>(model.models.size()); ++owner) {
        layout.textureOffset = std::max(layout.textureOffset, addFields(owner));
        addTextures(owner);
    }
    layout.textureCount = static_cast<std::uint32_t>(slots);
    layout.bytes =
        layout.textureOffset + layout.textureCount * static_cast<std::uint32_t>(sizeof(gpu::TextureRecord));
    return layout;
}

MaterialLayout materialLayoutOf(const Plan& plan) {
    return makeMaterialLayout(*plan.model, plan.primaryAlways | plan.primarySometimes);
}

bool isOfModel(const materials::Material& material, int model) {
    const materials::MaterialModel& all = material.model();
    return model < 0 ||
           material.reads(
               all.features[static_cast<std::size_t>(all.models[static_cast<std::size_t>(model)].feature)]
                   .object);
}

std::vector<std::uint8_t> makeMaterialRecord(const materials::Material& material,
                                             const MaterialLayout& layout) {
    std::vector<std::uint8_t> record(layout.bytes);
    materials::Material plain = material;
    plain.ranges.clear();
    const materials::PrimitiveInputs primitive;
    const materials::KeyOptions options;
    const materials::FeatureMask key = 0;
    const materials::MaterialFacts facts(plain, primitive, options, key,
                                         materials::MaterialFacts::Textures::Ignored);
    for (const RecordField& field : layout.fields) {
        if (!isOfModel(material, field.model)) {
            continue;
        }
        const float* const values =
            field.parameter < 0
                ? nullptr
                : &plain.values[static_cast<std::size_t>(
                      layout.model->parameters[static_cast<std::size_t>(field.parameter)].first)];
        for (int i = 0; i < field.channels; ++i) {
            const float value =
                values != nullptr
                    ? values[i]
                    : static_cast<float>(derivedValue(
                          facts, layout.model->derived[static_cast<std::size_t>(field.derived)], i));
            std::memcpy(&record[field.offset + kFloatBytes * static_cast<std::size_t>(i)], &value,
                        sizeof value);
        }
    }
    for (const TextureSlot& row : layout.textures) {
        const auto index = static_cast<std::size_t>(row.texture);
        const materials::TextureInfo& info = material.textures[index];
        if (isOfModel(material, row.model) &&
            (info.texture >= 0 ||
             (layout.turnsFrames && layout.model->textures[index].name == kFrameTexture))) {
            const gpu::TextureRecord texture = transformed(info.transform);
            std::memcpy(&record[layout.textureOffset + static_cast<std::size_t>(row.slot) * sizeof texture],
                        &texture, sizeof texture);
        }
    }
    return record;
}

std::string recordStruct(const MaterialLayout& layout, std::string_view scope) {
    std::string text = "struct MaterialRecord {\n";
    for (const RecordField& field : layout.fields) {
        if (field.model < 0) {
            text += fmt::format("    {}{} {};{}{}\n", field.channels == 1 ? "" : scope, field.type,
                                field.name, field.note.empty() ? "" : "  // ", field.note);
        }
    }
    if (layout.ownFloats() > 0) {
        text +=
            fmt::format("    float own[{}];  // the fields of the material's model\n", layout.ownFloats());
    }
    if (layout.textureCount > 0) {
        text += fmt::format("    {}TextureRecord textures[{}];\n", scope, layout.textureCount);
    }
    return text + "};\n";
}

std::string recordDeclarations(const MaterialLayout& layout, const materials::FeatureMask& used) {
    const materials::MaterialModel& model = *layout.model;
    // Whether shaders with those features may name what belongs to the feature.
    const auto isNamed = [&](int feature) {
        const int owner = feature < 0 ? -1 : model.features[static_cast<std::size_t>(feature)].model;
        return owner < 0 || used.has(model
                                         .features[static_cast<std::size_t>(
                                             model.models[static_cast<std::size_t>(owner)].feature)]
                                         .bit);
    };
    std::string text =
        "// The values of a material that the scenes of the package need.\n" + recordStruct(layout, "");
    text +=
        "layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MaterialArray { "
        "MaterialRecord "
        "data[]; };\n";
    text += "// The textures of a record.\n";
    for (std::size_t i = 0; i < model.textures.size(); ++i) {
        if (isNamed(model.textures[i].feature)) {
            text += fmt::format("const uint {} = {}u;\n", textureConstant(model.textures[i].name),
                                std::max(0, layout.slotOf(static_cast<int>(i))));
        }
    }
    text += "#define GLINT_TEXTURE(record, slot) ";
    text += layout.textureCount == 0 ? "TextureRecord(0u, 0u, 0u, vec3(0.0), vec3(0.0), vec2(0.0), 0.0)\n"
                                     : "(record).textures[slot]\n";
    text += fmt::format("#define GLINT_TEXTURE_SLOTS {}\n", layout.textureCount);
    text += "// The record of the material of a Hit or a SurfacePoint.\n";
    text += "#define GLINT_MATERIAL(hit) hostMaterials().data[(hit).material]\n";
    text += "// The values of a hit's material. No key of the package reads those that are constants here.\n";
    const auto define = [&](const std::string& name, const std::string& type, int feature,
                            std::span<const float> fallback) {
        const auto field = std::ranges::find(layout.fields, name, &RecordField::name);
        if (isNamed(feature)) {
            text += fieldMacros(
                name, field != layout.fields.end() ? readOf(layout, *field) : literalOf(type, fallback));
        }
    };
    for (const materials::Parameter& parameter : model.parameters) {
        if (parameter.inRecord) {
            define(parameter.name, parameter.type, parameter.feature,
                   std::span(parameter.fallback).first(static_cast<std::size_t>(parameter.channels)));
        }
    }
    for (const materials::DerivedField& field : model.derived) {
        const std::array<float, 4> zero{};
        define(field.name, field.type, field.feature,
               std::span(zero).first(static_cast<std::size_t>(field.count)));
    }
    return text;
}

}  // namespace glint::compiler
