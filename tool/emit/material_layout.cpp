#include "emit/material_layout.h"

#include "materials/declarations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <interop/scene.h>
#include <map>
#include <numeric>
#include <optional>

namespace glint::compiler {

namespace {

using package::Role;

constexpr std::uint32_t kNumberBytes = materials::kNumberBytes;

bool has(const std::vector<int>& models, int model) {
    return std::ranges::binary_search(models, model);
}

bool isUsed(const materials::MaterialModel& model, int feature, const materials::FeatureMask& used) {
    return feature < 0 || used.has(model.features[static_cast<std::size_t>(feature)].bit);
}

std::string noteOf(const std::string& unit, const std::string& about) {
    return unit.empty() || about.empty() ? unit + about : unit + "; " + about;
}

std::string textureConstant(std::string_view name) {
    return "k" + materials::capitalized(name);
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

// The macros that read a field of a record, and of the record of a hit's material. Their arguments have names
// that no field has.
std::string fieldMacros(std::string_view name, bool isArray, std::string_view value) {
    const std::string macro = materials::fieldMacro(name);
    const std::string_view index = isArray ? ", index_" : "";
    return fmt::format(
        "#define GLINT_RECORD_{0}(record_{1}) {2}\n#define GLINT_MATERIAL_{0}(hit{1}) "
        "GLINT_RECORD_{0}(GLINT_MATERIAL(hit){1})\n",
        macro, index, value);
}

// The constant that stands for a field which no record has.
std::string constantOf(const materials::ValueType& type, int count, std::span<const double> numbers) {
    if (count == 0) {
        return literalOf(type, numbers);
    }
    const auto channels = static_cast<std::size_t>(type.channels);
    std::string text = fmt::format("{}[{}](", type.glsl, count);
    for (std::size_t first = 0; first < numbers.size(); first += channels) {
        text += (first == 0 ? "" : ", ") + literalOf(type, numbers.subspan(first, channels));
    }
    return text + ")[index_]";
}

std::uint32_t ownIndex(const MaterialLayout& layout, const RecordField& field) {
    return (field.offset - layout.ownOffset) / kNumberBytes;
}

// The expression that reads a field. Fields that only some models have lie over each other, as floats, and
// matrices are arrays of floats.
std::string readOf(const MaterialLayout& layout, const RecordField& field) {
    const bool isArray = field.count > 0;
    const bool isShared = layout.isShared(field);
    if (isShared && !field.type->isMatrix()) {
        return valueOfField(*field.type,
                            fmt::format("(record_).{}{}", field.name, isArray ? "[index_]" : ""));
    }
    const std::string_view array = isShared ? std::string_view(field.name) : "own";
    const std::string stride = !isArray ? "" : fmt::format(" + {} * int(index_)", field.type->channels);
    std::vector<std::string> floats;
    for (int i = 0; i < field.type->channels; ++i) {
        const std::uint32_t place = (isShared ? 0U : ownIndex(layout, field)) + static_cast<std::uint32_t>(i);
        floats.push_back(fmt::format("(record_).{}[{}{}]", array, place, stride));
    }
    return valueOfFloats(*field.type, floats);
}

// The type and the name of a member of records.
std::string memberOf(const RecordField& field, RecordLanguage language) {
    const std::uint32_t elements =
        field.type->isMatrix() ? field.numbers() : static_cast<std::uint32_t>(field.count);
    return fmt::format("{} {}{}", language == RecordLanguage::Glsl ? field.type->field : field.type->cpp,
                       field.name, elements > 0 ? fmt::format("[{}]", elements) : "");
}

// Whether a frame may be that of a texture's coordinates though no key reads the texture.
bool takesFrameOf(const materials::MaterialModel& model, int texture, const materials::FeatureMask& used) {
    if (texture != model.textureOf(Role::TangentFrame)) {
        return false;
    }
    const materials::FeatureMask sets = model.mask(Role::TexCoord0) | model.mask(Role::TexCoord1);
    const bool matters = (used & sets) == sets || (used & model.mask(Role::TurnedFrames)) != 0;
    return matters && std::ranges::any_of(model.features, [&](const materials::Feature& feature) {
               return feature.needsTangents && feature.texture < 0 && used.has(feature.bit);
           });
}

// Decides which fields and textures the records of each use have.
class RecordNeeds {
public:
    RecordNeeds(const materials::MaterialModel& model, std::span<const RecordUse> uses)
        : model_(model),
          uses_(uses),
          emission_(model.mask(Role::Emits)),
          strength_(model.featuresFor(Role::EmissionStrength)) {
        hasStrength_ =
            std::ranges::any_of(uses, [this](const RecordUse& use) { return (use.used & strength_) != 0; });
        for (std::size_t i = 0; i < uses.size(); ++i) {
            for (const int one : uses[i].models) {
                useOf_[one] = i;
            }
        }
    }

    // Each returns which of the uses have it, ascending.
    std::vector<std::size_t> ofParameter(int parameter) const {
        return which(model_.parameters[static_cast<std::size_t>(parameter)].feature,
                     [&](const RecordUse& use) { return hasParameter(use, parameter); });
    }
    std::vector<std::size_t> ofDerived(const materials::DerivedField& field) const {
        return which(field.feature,
                     [&](const RecordUse& use) { return isUsed(model_, field.feature, use.used); });
    }
    std::vector<std::size_t> ofTexture(int texture) const {
        const int feature = model_.textures[static_cast<std::size_t>(texture)].feature;
        return which(feature, [&](const RecordUse& use) {
            return isUsed(model_, feature, use.used) || takesFrameOf(model_, texture, use.used);
        });
    }

private:
    // What belongs to a feature of a model is in no records but those of the model.
    template <typename Has>
    std::vector<std::size_t> which(int feature, const Has& has) const {
        std::vector<std::size_t> uses;
        const int owner = feature < 0 ? -1 : model_.features[static_cast<std::size_t>(feature)].model;
        const auto only = useOf_.find(owner);
        const std::size_t first = owner < 0 ? 0 : only != useOf_.end() ? only->second : uses_.size();
        const std::size_t end = owner < 0 ? uses_.size() : std::min(first + 1, uses_.size());
        for (std::size_t i = first; i < end; ++i) {
            if (has(uses_[i])) {
                uses.push_back(i);
            }
        }
        return uses;
    }

    bool hasParameter(const RecordUse& use, int index) const {
        const materials::Parameter& parameter = model_.parameters[static_cast<std::size_t>(index)];
        const bool isOfGltf = use.models.front() < 0;
        if (parameter.feature >= 0) {
            // The runtime reads the strength of whatever emits.
            const bool emits = !isOfGltf && (use.used & emission_) != 0;
            return isUsed(model_, parameter.feature, use.used) ||
                   (emits && hasStrength_ && parameter.role == Role::EmissionStrength);
        }
        if (isOfGltf) {
            return true;
        }
        if (parameter.role == Role::Emission) {
            return (use.used & emission_) != 0;
        }
        if (parameter.role == Role::AlphaCutoff) {
            return use.masks;
        }
        return std::ranges::any_of(use.models, [&](int one) { return model_.hasParameter(one, index); });
    }

    const materials::MaterialModel& model_;
    std::span<const RecordUse> uses_;
    materials::FeatureMask emission_;
    materials::FeatureMask strength_;
    bool hasStrength_ = false;
    std::map<int, std::size_t> useOf_;  // by model
};

// Gives places to what only some uses have. Two things that one use has lie in different places.
class Overlay {
public:
    explicit Overlay(std::size_t uses) : taken_(uses) {}

    // Returns the first place with `count` units that are free in all of `uses`.
    std::size_t place(const std::vector<std::size_t>& uses, std::size_t count) {
        std::size_t first = 0;
        for (std::size_t end = first; end < first + count; ++end) {
            first = isTaken(uses, end) ? end + 1 : first;
        }
        for (const std::size_t use : uses) {
            taken_[use].resize(std::max(taken_[use].size(), first + count));
            std::fill_n(taken_[use].begin() + static_cast<std::ptrdiff_t>(first), count, true);
        }
        end_ = std::max(end_, first + count);
        return first;
    }
    std::size_t end() const {
        return end_;
    }

private:
    bool isTaken(const std::vector<std::size_t>& uses, std::size_t unit) const {
        return std::ranges::any_of(
            uses, [&](std::size_t use) { return unit < taken_[use].size() && taken_[use][unit]; });
    }

    std::vector<std::vector<bool>> taken_;  // by use, then by unit
    std::size_t end_ = 0;
};

std::vector<int> modelsOf(std::span<const RecordUse> uses, const std::vector<std::size_t>& which) {
    std::vector<int> models;
    for (const std::size_t i : which) {
        models.insert(models.end(), uses[i].models.begin(), uses[i].models.end());
    }
    std::ranges::sort(models);
    return models;
}

}  // namespace

const RecordField* MaterialLayout::fieldOf(Role role) const {
    const int parameter = model->parameterOf(role);
    const auto found = std::ranges::find(fields, parameter, &RecordField::parameter);
    return parameter < 0 || found == fields.end() ? nullptr : &*found;
}

const RecordField* MaterialLayout::fieldNamed(std::string_view name) const {
    const auto found = byName.find(name);
    return found == byName.end() ? nullptr : &fields[found->second];
}

int MaterialLayout::slotOf(int texture) const {
    const auto found = std::ranges::lower_bound(textures, texture, {}, &TextureSlot::texture);
    return found == textures.end() || found->texture != texture ? -1 : found->slot;
}

int MaterialLayout::slotOf(int texture, int ofModel) const {
    const auto found = std::ranges::lower_bound(textures, texture, {}, &TextureSlot::texture);
    return found == textures.end() || found->texture != texture || !has(found->models, ofModel) ? -1
                                                                                                : found->slot;
}

void MaterialLayout::makeIndex() {
    for (std::size_t i = 0; i < fields.size(); ++i) {
        byName.emplace(fields[i].name, i);
        for (const int one : fields[i].models) {
            byModel[one].fields.push_back(i);
        }
    }
    for (std::size_t i = 0; i < textures.size(); ++i) {
        for (const int one : textures[i].models) {
            byModel[one].textures.push_back(i);
        }
    }
}

MaterialLayout makeMaterialLayout(const materials::MaterialModel& model, std::span<const RecordUse> uses) {
    MaterialLayout layout;
    layout.model = &model;
    const RecordNeeds needs(model, uses);
    std::vector<std::vector<std::size_t>> usesOfField;
    const auto add = [&](RecordField field, std::vector<std::size_t> which) {
        field.models = modelsOf(uses, which);
        if (!field.models.empty()) {
            layout.fields.push_back(std::move(field));
            usesOfField.push_back(std::move(which));
        }
    };
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        const materials::Parameter& parameter = model.parameters[i];
        if (parameter.inRecord) {
            add({.name = parameter.name,
                 .type = parameter.type,
                 .count = parameter.count,
                 .note = noteOf(parameter.unit, parameter.about),
                 .parameter = static_cast<int>(i)},
                needs.ofParameter(static_cast<int>(i)));
        }
    }
    for (std::size_t i = 0; i < model.derived.size(); ++i) {
        const materials::DerivedField& field = model.derived[i];
        add({.name = field.name,
             .type = field.type,
             .note = noteOf(field.unit, field.about),
             .derived = static_cast<int>(i)},
            needs.ofDerived(field));
    }
    std::vector<std::vector<std::size_t>> usesOfTexture;
    for (std::size_t i = 0; i < model.textures.size(); ++i) {
        std::vector<std::size_t> which = needs.ofTexture(static_cast<int>(i));
        std::vector<int> models = modelsOf(uses, which);
        if (!models.empty()) {
            layout.textures.push_back({static_cast<int>(i), 0, std::move(models)});
            usesOfTexture.push_back(std::move(which));
        }
    }
    layout.makeIndex();
    for (const RecordUse& use : uses) {
        layout.modelCount += use.models.size();
        layout.turnsFrames = layout.turnsFrames || (use.used & model.mask(Role::TurnedFrames)) != 0;
    }
    // What all have comes first, then what most have, so that little room is lost between the rest.
    const auto byUses = [](const std::vector<std::vector<std::size_t>>& which) {
        std::vector<std::size_t> order(which.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, std::ranges::greater(),
                                 [&](std::size_t i) { return which[i].size(); });
        return order;
    };
    Overlay numbers(uses.size());
    for (const std::size_t i : byUses(usesOfField)) {
        RecordField& field = layout.fields[i];
        field.offset =
            kNumberBytes * static_cast<std::uint32_t>(numbers.place(usesOfField[i], field.numbers()));
        if (layout.isShared(field)) {
            layout.ownOffset = kNumberBytes * static_cast<std::uint32_t>(numbers.end());
        }
    }
    Overlay slots(uses.size());
    for (const std::size_t i : byUses(usesOfTexture)) {
        layout.textures[i].slot = static_cast<int>(slots.place(usesOfTexture[i], 1));
    }
    layout.textureOffset = kNumberBytes * static_cast<std::uint32_t>(numbers.end());
    layout.textureCount = static_cast<std::uint32_t>(slots.end());
    layout.bytes =
        layout.textureOffset + layout.textureCount * static_cast<std::uint32_t>(sizeof(gpu::TextureRecord));
    return layout;
}

MaterialLayout materialLayoutOf(const Plan& plan) {
    return makeMaterialLayout(*plan.model, plan.records);
}

std::vector<std::uint8_t> makeMaterialRecord(const materials::Material& material,
                                             const MaterialLayout& layout) {
    std::vector<std::uint8_t> record(layout.bytes);
    std::optional<materials::Material> copy;
    if (!material.ranges.empty()) {
        copy = material;
        copy->ranges.clear();
    }
    const materials::Material& plain = copy ? *copy : material;
    const materials::PrimitiveInputs primitive;
    const materials::KeyOptions options;
    const materials::FeatureMask key = 0;
    const materials::MaterialFacts facts(plain, primitive, options, key,
                                         materials::MaterialFacts::Textures::Ignored);
    const auto known = layout.byModel.find(modelOf(material));
    const MaterialLayout::Rows rows = known != layout.byModel.end() ? known->second : MaterialLayout::Rows();
    for (const std::size_t place : rows.fields) {
        const RecordField& field = layout.fields[place];
        const std::span<const double> values =
            field.parameter < 0
                ? std::span<const double>()
                : plain.values.of(layout.model->parameters[static_cast<std::size_t>(field.parameter)]);
        for (std::uint32_t i = 0; i < field.numbers(); ++i) {
            const double number =
                !values.empty()
                    ? values[i]
                    : derivedValue(facts, layout.model->derived[static_cast<std::size_t>(field.derived)],
                                   static_cast<int>(i));
            const std::uint32_t word = materials::wordOf(field.type->kind, number);
            std::memcpy(&record[field.offset + kNumberBytes * std::size_t{i}], &word, sizeof word);
        }
    }
    for (const std::size_t place : rows.textures) {
        const TextureSlot& row = layout.textures[place];
        const auto index = static_cast<std::size_t>(row.texture);
        const materials::TextureInfo& info = material.textures[index];
        if (info.texture >= 0 ||
            (layout.turnsFrames && row.texture == layout.model->textureOf(Role::TangentFrame))) {
            const gpu::TextureRecord texture = transformed(info.transform);
            std::memcpy(&record[layout.textureOffset + static_cast<std::size_t>(row.slot) * sizeof texture],
                        &texture, sizeof texture);
        }
    }
    return record;
}

std::string nameConstant(const materials::Parameter& parameter, std::size_t value) {
    return "k" + materials::capitalized(parameter.name) + materials::capitalized(parameter.names[value]);
}

namespace {

// Whether shaders with those features may name what belongs to the feature.
bool isNamed(const materials::MaterialModel& model, int feature, const materials::FeatureMask& used) {
    const int owner = feature < 0 ? -1 : model.features[static_cast<std::size_t>(feature)].model;
    return owner < 0 || used.has(model.models[static_cast<std::size_t>(owner)].firstBit - 1);
}

int featureOf(const MaterialLayout& layout, const RecordField& field) {
    return field.parameter >= 0 ? layout.model->parameters[static_cast<std::size_t>(field.parameter)].feature
                                : layout.model->derived[static_cast<std::size_t>(field.derived)].feature;
}

}  // namespace

std::string recordStruct(const MaterialLayout& layout, RecordLanguage language,
                         const materials::FeatureMask& used) {
    std::string text = "struct MaterialRecord {\n";
    for (const RecordField& field : layout.fields) {
        if (layout.isShared(field)) {
            text += fmt::format("    {};{}{}\n", memberOf(field, language), field.note.empty() ? "" : "  // ",
                                field.note);
        }
    }
    if (layout.ownFloats() > 0) {
        text += fmt::format("    float own[{}];  // the fields that only some models have:\n",
                            layout.ownFloats());
        for (const RecordField& field : layout.fields) {
            if (!layout.isShared(field) && isNamed(*layout.model, featureOf(layout, field), used)) {
                text += fmt::format("    //   own[{}]: {}\n", ownIndex(layout, field),
                                    memberOf(field, RecordLanguage::Glsl));
            }
        }
    }
    if (layout.textureCount > 0) {
        text += fmt::format("    {}TextureRecord textures[{}];\n",
                            language == RecordLanguage::Cpp ? "gpu::" : "", layout.textureCount);
    }
    return text + "};\n";
}

std::string recordDeclarations(const MaterialLayout& layout, const materials::FeatureMask& used) {
    const materials::MaterialModel& model = *layout.model;
    std::string text = "// The values of a material that the scenes of the package need.\n" +
                       recordStruct(layout, RecordLanguage::Glsl, used);
    text +=
        "layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MaterialArray { "
        "MaterialRecord "
        "data[]; };\n";
    text += "// The textures of a record.\n";
    for (std::size_t i = 0; i < model.textures.size(); ++i) {
        if (isNamed(model, model.textures[i].feature, used)) {
            text += fmt::format("const uint {} = {}u;\n", textureConstant(model.textures[i].name),
                                std::max(0, layout.slotOf(static_cast<int>(i))));
        }
    }
    for (const materials::MaterialTexture& texture : model.textures) {
        if (texture.role != Role::None) {
            text += fmt::format("#define {}_SLOT {}\n", materials::roleMacro(texture.role),
                                textureConstant(texture.name));
        }
    }
    text += "#define GLINT_TEXTURE(record, slot) ";
    text += layout.textureCount == 0 ? "TextureRecord(0u, 0u, 0u, vec3(0.0), vec3(0.0), vec2(0.0), 0.0)\n"
                                     : "(record).textures[slot]\n";
    text += fmt::format("#define GLINT_TEXTURE_SLOTS {}\n", layout.textureCount);
    text += "// The record of the material of a Hit or a SurfacePoint.\n";
    text += "#define GLINT_MATERIAL(hit) hostMaterials().data[(hit).material]\n";
    text += "// The values of a hit's material. No key of the package reads those that are constants here.\n";
    const auto define = [&](const std::string& name, const std::string& constant, bool isArray) {
        const RecordField* const field = layout.fieldNamed(name);
        text += fieldMacros(name, isArray, field != nullptr ? readOf(layout, *field) : constant);
    };
    for (const materials::Parameter& parameter : model.parameters) {
        if (!parameter.inRecord || !isNamed(model, parameter.feature, used)) {
            continue;
        }
        for (std::size_t i = 0; i < parameter.names.size(); ++i) {
            text += fmt::format("const uint {} = {}u;\n", nameConstant(parameter, i), i);
        }
        define(parameter.name, constantOf(*parameter.type, parameter.count, parameter.fallback),
               parameter.isArray());
        if (parameter.role != Role::None) {
            text += fmt::format("#define {}(record_) GLINT_RECORD_{}(record_)\n",
                                materials::roleMacro(parameter.role), materials::fieldMacro(parameter.name));
        }
    }
    for (const materials::DerivedField& field : model.derived) {
        const std::array<double, 4> zero{};
        if (isNamed(model, field.feature, used)) {
            define(
                field.name,
                literalOf(*field.type, std::span(zero).first(static_cast<std::size_t>(field.type->channels))),
                false);
        }
    }
    return text;
}

}  // namespace glint::compiler
