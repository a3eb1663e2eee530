#include "materials/material_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <functional>
#include <interop/models.h>
#include <limits>
#include <numbers>

namespace glint::materials {

namespace {

// Searches from the row `first` on.
template <typename Rows>
int indexOf(const Rows& rows, std::string_view name, std::size_t first = 0) {
    for (std::size_t i = first; i < rows.size(); ++i) {
        if (rows[i].name == name) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

}  // namespace

std::uint64_t FeatureMask::wordAt(int place) const {
    if (place == 0) {
        return shared_;
    }
    const auto found = std::ranges::lower_bound(own_, place, {}, &Word::place);
    return found != own_.end() && found->place == place ? found->bits : fill_;
}

FeatureMask FeatureMask::ofBit(int bit) {
    const Word word{bit / kWordBits, std::uint64_t{1} << static_cast<unsigned>(bit % kWordBits)};
    FeatureMask mask;
    if (word.place == 0) {
        mask.shared_ = word.bits;
    } else {
        mask.own_.push_back(word);
    }
    return mask;
}

int FeatureMask::count() const {
    int sum = 0;
    forEach([&sum](int) { ++sum; });
    return sum;
}

// Sets each word to combine(own, other's).
template <typename Combine>
void FeatureMask::combine(const FeatureMask& other, const Combine& combine) {
    const std::uint64_t fill = combine(fill_, other.fill_);
    if (!own_.empty() || !other.own_.empty()) {
        std::vector<Word> combined;
        combined.reserve(own_.size() + other.own_.size());
        auto mine = own_.begin();
        auto theirs = other.own_.begin();
        while (mine != own_.end() || theirs != other.own_.end()) {
            const bool isMine =
                mine != own_.end() && (theirs == other.own_.end() || mine->place <= theirs->place);
            const bool isTheirs =
                theirs != other.own_.end() && (mine == own_.end() || theirs->place <= mine->place);
            const Word word{isMine ? mine->place : theirs->place,
                            combine(isMine ? mine->bits : fill_, isTheirs ? theirs->bits : other.fill_)};
            if (word.bits != fill) {
                combined.push_back(word);
            }
            mine += isMine ? 1 : 0;
            theirs += isTheirs ? 1 : 0;
        }
        own_ = std::move(combined);
    }
    shared_ = combine(shared_, other.shared_);
    fill_ = fill;
}

FeatureMask& FeatureMask::operator&=(const FeatureMask& other) {
    combine(other, std::bit_and<>());
    return *this;
}

FeatureMask& FeatureMask::operator|=(const FeatureMask& other) {
    combine(other, std::bit_or<>());
    return *this;
}

FeatureMask FeatureMask::operator~() const {
    FeatureMask result = *this;
    result.combine({}, [](std::uint64_t word, std::uint64_t) { return ~word; });
    return result;
}

std::strong_ordering operator<=>(const FeatureMask& a, const FeatureMask& b) {
    if (a.fill_ != b.fill_) {
        return a.fill_ <=> b.fill_;
    }
    // From the highest word that either lists.
    auto ofA = a.own_.rbegin();
    auto ofB = b.own_.rbegin();
    while (ofA != a.own_.rend() || ofB != b.own_.rend()) {
        const int place =
            std::max(ofA != a.own_.rend() ? ofA->place : 0, ofB != b.own_.rend() ? ofB->place : 0);
        const bool isOfA = ofA != a.own_.rend() && ofA->place == place;
        const bool isOfB = ofB != b.own_.rend() && ofB->place == place;
        const std::uint64_t left = isOfA ? ofA->bits : a.fill_;
        const std::uint64_t right = isOfB ? ofB->bits : b.fill_;
        if (left != right) {
            return left <=> right;
        }
        ofA += isOfA ? 1 : 0;
        ofB += isOfB ? 1 : 0;
    }
    return a.shared_ <=> b.shared_;
}

std::string toHex(const FeatureMask& mask) {
    assert(mask.fill_ == 0);
    if (mask.own_.empty()) {
        return fmt::format("0x{:016x}", mask.shared_);
    }
    std::string text = fmt::format("0x{:x}", mask.own_.back().bits);
    for (int place = mask.own_.back().place - 1; place >= 0; --place) {
        text += fmt::format("{:016x}", mask.wordAt(place));
    }
    return text;
}

std::string Feature::neutralText() const {
    std::vector<std::string_view> reasons;
    for (const NeutralReason& reason : neutral) {
        reasons.emplace_back(reason.because);
    }
    return reasons.empty() ? "never" : fmt::format("{}", fmt::join(reasons, "; or "));
}

std::string Parameter::typeText() const {
    const std::string one =
        names.empty() ? std::string(type->name) : fmt::format("{} ({})", type->name, fmt::join(names, ", "));
    return isArray() ? fmt::format("{}[{}]", one, count) : one;
}

bool Parameter::isValid(double value) const {
    return value == also || (value >= low && value <= high);
}

double Parameter::hold(double value) const {
    if (type->kind != NumberKind::Real) {
        return value == also ? value : std::round(std::clamp(value, low, high));
    }
    if (value == also) {
        return static_cast<float>(value);
    }
    if (isAngle) {
        // Sine and cosine keep their digits if the angle is reduced in double precision.
        return static_cast<float>(std::remainder(value, 2.0 * std::numbers::pi));
    }
    // A value beyond the range of floats is infinite where that is allowed.
    const bool overflows = std::isinf(high) && value >= std::numeric_limits<float>::max();
    return static_cast<float>(overflows ? kUnlimited : std::clamp(value, low, high));
}

template <typename Rows>
int MaterialModel::NameIndex::find(const Rows& rows, std::string_view name) const {
    const auto found = places.find(name);
    return found != places.end() ? found->second : indexOf(rows, name, count);
}

template <typename Rows>
void MaterialModel::NameIndex::extend(const Rows& rows) {
    for (; count < rows.size(); ++count) {
        places.try_emplace(rows[count].name, static_cast<int>(count));
    }
}

void MaterialModel::indexNames() {
    parameterIndex_.extend(parameters);
    textureIndex_.extend(textures);
    featureIndex_.extend(features);
    objectIndex_.extend(objects);
}

void MaterialModel::indexAllNames() {
    parameterIndex_ = textureIndex_ = featureIndex_ = objectIndex_ = {};
    indexNames();
}

int MaterialModel::findParameter(std::string_view name) const {
    return parameterIndex_.find(parameters, name);
}

int MaterialModel::findTexture(std::string_view name) const {
    return textureIndex_.find(textures, name);
}

int MaterialModel::findFeature(std::string_view name) const {
    return featureIndex_.find(features, name);
}

int MaterialModel::findObject(std::string_view name) const {
    return objectIndex_.find(objects, name);
}

int MaterialModel::findAttribute(std::string_view name) const {
    return indexOf(attributes, name);
}

int MaterialModel::parameterOf(package::Role role) const {
    const auto found = std::ranges::find(parameters, role, &Parameter::role);
    return found == parameters.end() ? -1 : static_cast<int>(found - parameters.begin());
}

int MaterialModel::textureOf(package::Role role) const {
    const auto found = std::ranges::find(textures, role, &MaterialTexture::role);
    return found == textures.end() ? -1 : static_cast<int>(found - textures.begin());
}

FeatureMask MaterialModel::mask(package::Role role) const {
    const auto found = std::ranges::find(features, role, &Feature::role);
    return found == features.end() ? 0 : found->mask();
}

FeatureMask MaterialModel::textureMask(package::Role role) const {
    const int texture = textureOf(role);
    return texture < 0
               ? 0
               : features[static_cast<std::size_t>(textures[static_cast<std::size_t>(texture)].feature)]
                     .mask();
}

FeatureMask MaterialModel::featuresFor(package::Role role) const {
    using enum package::Role;
    const int parameter = parameterOf(role);
    const int reader = parameter < 0 ? -1 : parameters[static_cast<std::size_t>(parameter)].feature;
    const FeatureMask ofParameter = reader < 0 ? 0 : features[static_cast<std::size_t>(reader)].mask();
    const FeatureMask ofTexture = textureMask(role);
    return ofParameter | ofTexture |
           (ofTexture == 0 ? 0 : mask(TexCoord0) | mask(TexCoord1) | mask(TextureTransform));
}

int MaterialModel::findParameter(std::string_view name, int model) const {
    const int own =
        model < 0 ? -1 : findParameter(fullName(models[static_cast<std::size_t>(model)].name, name));
    return own >= 0 ? own : findParameter(name);
}

int MaterialModel::findTexture(std::string_view name, int model) const {
    const int own =
        model < 0 ? -1 : findTexture(fullName(models[static_cast<std::size_t>(model)].name, name));
    return own >= 0 ? own : findTexture(name);
}

FeatureMask MaterialModel::withBases(const FeatureMask& mask) const {
    FeatureMask whole = mask;
    mask.forEach([&](int bit) {
        if (bit >= kFirstOfModels) {
            whole |= FeatureMask::ofBit(models[static_cast<std::size_t>(modelOfBit(bit))].firstBit - 1);
        }
    });
    return whole;
}

FeatureMask MaterialModel::mask(std::string_view feature) const {
    const int index = findFeature(feature);
    return index < 0 ? 0 : features[static_cast<std::size_t>(index)].mask();
}

void MaterialModel::indexBits() {
    for (std::size_t i = 0; i < features.size() && features[i].bit < kFirstOfModels; ++i) {
        ofSharedBit_[static_cast<std::size_t>(features[i].bit)] = static_cast<int>(i);
    }
}

void MaterialModel::indexBehaviours() {
    for (std::size_t i = 0; i < behaviours.size(); ++i) {
        // Without the object, the material reads the one that it replaces.
        MaterialObject& object = objects[static_cast<std::size_t>(behaviours[i].object)];
        (object.replaces < 0 ? commonBehaviours : object.behaviours).push_back(static_cast<int>(i));
    }
}

bool haveSameDeclarations(const MaterialModel& a, const MaterialModel& b) {
    const auto declarationsOf = [](const MaterialModel& model) {
        std::vector<const PackFile*> files;
        for (const PackFile& file : model.files) {
            if (file.isDeclaration) {
                files.push_back(&file);
            }
        }
        return files;
    };
    return &a == &b ||
           std::ranges::equal(declarationsOf(a), declarationsOf(b),
                              [](const PackFile* one, const PackFile* other) { return *one == *other; });
}

std::vector<int> MaterialModel::indicesOf(const FeatureMask& mask) const {
    std::vector<int> indices;
    mask.forEach([&](int bit) {
        // Features of models have ascending bits, and come after all others.
        const int first = models.empty() ? 0 : models.front().feature;
        const int index =
            bit < kFirstOfModels ? ofSharedBit_[static_cast<std::size_t>(bit)] : first + bit - kFirstOfModels;
        // The set may be one of another model, with more features.
        if (static_cast<std::size_t>(index) < features.size() &&
            features[static_cast<std::size_t>(index)].bit == bit) {
            indices.push_back(index);
        }
    });
    std::ranges::sort(indices);
    return indices;
}

std::vector<std::string> MaterialModel::names(const FeatureMask& mask) const {
    std::vector<std::string> names;
    for (const int index : indicesOf(mask)) {
        names.emplace_back(features[static_cast<std::size_t>(index)].name);
    }
    return names;
}

int MaterialModel::modelOfBit(int bit) const {
    // The base of a model comes before its first bit.
    const auto after = std::ranges::upper_bound(models, bit + 1, {}, &BaseModel::firstBit);
    return static_cast<int>(after - models.begin()) - 1;
}

int MaterialModel::modelOf(const FeatureMask& key) const {
    int found = -1;
    key.forEach([&](int bit) {
        const int model = found < 0 && bit >= kFirstOfModels ? modelOfBit(bit) : -1;
        found = model >= 0 && bit == models[static_cast<std::size_t>(model)].firstBit - 1 ? model : found;
    });
    return found;
}

FeatureMask MaterialModel::featuresOf(int model) const {
    FeatureMask mask = FeatureMask(~std::uint64_t{0});
    if (model < 0) {
        return mask;
    }
    const BaseModel& row = models[static_cast<std::size_t>(model)];
    for (const int exclusion : features[static_cast<std::size_t>(row.feature)].exclusions) {
        mask &= ~exclusions[static_cast<std::size_t>(exclusion)].excluded;
    }
    for (int bit = row.firstBit - 1; bit < row.firstBit + row.bits; ++bit) {
        mask |= FeatureMask::ofBit(bit);
    }
    return mask;
}

bool MaterialModel::hasParameter(int model, int parameter) const {
    const int base = model < 0 ? -1 : models[static_cast<std::size_t>(model)].feature;
    const int its = base < 0 ? -1 : features[static_cast<std::size_t>(base)].object;
    if (its < 0) {
        return true;
    }
    const MaterialObject& object = objects[static_cast<std::size_t>(its)];
    return std::ranges::binary_search(object.fills, parameter) ||
           object.replaces != parameters[static_cast<std::size_t>(parameter)].object;
}

package::KeyWords MaterialModel::words(const FeatureMask& mask) const {
    package::KeyWords words{static_cast<std::uint32_t>(mask.shared()),
                            static_cast<std::uint32_t>(mask.shared() >> 32U)};
    mask.forEach([&](int bit) {
        if (bit < kFirstOfModels) {
            return;
        }
        const int model = modelOfBit(bit);
        package::KeyWords one{0, 0, modelWord(model)};
        if (const int own = bit - models[static_cast<std::size_t>(model)].firstBit; own >= 0) {
            one.own.add(own);
        }
        words |= one;
    });
    return words;
}

FeatureMask MaterialModel::maskOf(const package::KeyWords& words) const {
    FeatureMask mask = words.lobes | std::uint64_t{words.inputs} << 32U;
    const std::uint32_t number = words.model & gpu::kModelNumber;
    if (number > 0 && number <= models.size()) {
        const BaseModel& model = models[number - 1];
        mask |= FeatureMask::ofBit(model.firstBit - 1);
        for (int i = 0; i < model.bits; ++i) {
            mask |= words.own.has(i) ? FeatureMask::ofBit(model.firstBit + i) : FeatureMask();
        }
    }
    return mask;
}

std::pair<package::KeyWords, package::KeyWords> MaterialModel::caseWords(const FeatureMask& always,
                                                                         const FeatureMask& sometimes) const {
    package::KeyWords least = words(always);
    package::KeyWords some = words(sometimes);
    const std::uint32_t any = words(always | sometimes).model;
    const bool isKnown = any == 0 || (any != gpu::kAnyModel && (always & bases) != 0 &&
                                      maskOf({0, 0, any}) == (maskOf({0, 0, any}) & always));
    least.model = isKnown ? any : gpu::kAnyModel;
    least.own = isKnown ? least.own : package::KeyWords::Own{};
    some.model = least.model;
    some.own = isKnown ? some.own : package::KeyWords::Own::all();
    return {least, some};
}

int MaterialModel::ownWordCount(const FeatureMask& used) const {
    int bits = 1;
    for (const BaseModel& model : models) {
        bits = used.has(model.firstBit - 1) ? std::max(bits, model.bits) : bits;
    }
    return (bits + 31) / 32;
}

std::string capitalized(std::string_view name) {
    std::string text(name);
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

std::string fullName(std::string_view scope, std::string_view name) {
    const std::string_view rest = name.substr(std::min(scope.size(), name.size()));
    const bool isFull = name.starts_with(scope) &&
                        (rest.empty() || std::islower(static_cast<unsigned char>(rest.front())) == 0);
    return scope.empty() || isFull ? std::string(name) : std::string(scope) + capitalized(name);
}

std::string Feature::macroEnd() const {
    return macro.substr(macro.starts_with("GLINT_PACK_") ? 11 : 6);
}

std::string MaterialModel::featureDefines(const FeatureMask& used) const {
    std::string text = fmt::format(
        "#define GLINT_LOBES 0x{:x}u\n#define GLINT_UNLIT_LOBES 0x{:x}u\n"
        "#define GLINT_BOTH_SIDES_LOBES 0x{:x}u\n",
        lobes.shared(), unlit.shared(), bothSides.shared());
    for (const Feature& feature : features) {
        if (feature.model >= 0) {
            break;  // These come last.
        }
        const std::string name = feature.macroEnd();
        const std::string bit = fmt::format("0x{:x}u\n", 1U << (static_cast<unsigned>(feature.bit) % 32U));
        text += fmt::format("#define {} {}", feature.macro, bit);
        const package::Role ofTexture = feature.texture < 0
                                            ? package::Role::None
                                            : textures[static_cast<std::size_t>(feature.texture)].role;
        if (feature.role != package::Role::None) {
            text += fmt::format("#define {} {}", roleMacro(feature.role), bit);
        }
        if (ofTexture != package::Role::None) {
            text += fmt::format("#define {}_TEXTURE {}", roleMacro(ofTexture), bit);
        }
        text += fmt::format("#define GLINT_HAS_{}(features) {}(features, {})\n", name,
                            feature.bit < kFirstInput ? "hasLobe" : "hasInput", feature.macro);
        text += fmt::format("#define GLINT_KEY_HAS_{}(features) {}(features, {})\n", name,
                            feature.bit < kFirstInput ? "lobeOfKey" : "inputOfKey", feature.macro);
    }
    for (const BaseModel& model : models) {
        for (int i = 0; i <= model.bits && used.has(model.firstBit - 1); ++i) {
            const Feature& feature =
                features[static_cast<std::size_t>(model.feature) + static_cast<std::size_t>(i)];
            const int bit = feature.bit - model.firstBit;
            const std::string rest =
                fmt::format("{}u, {}, 0x{:x}u)", feature.model + 1, std::max(bit, 0) / 32,
                            bit < 0 ? 0U : 1U << static_cast<unsigned>(bit % 32));
            text += fmt::format(
                "#define GLINT_HAS_{0}(features) hasOwn(features, {1}\n"
                "#define GLINT_KEY_HAS_{0}(features) ownOfKey(features, {1}\n",
                feature.macroEnd(), rest);
        }
    }
    return text;
}

int MaterialModel::symbolOf(Fact fact) const {
    return static_cast<int>(parameters.size()) + static_cast<int>(fact);
}

int MaterialModel::symbolOfFeature(int feature) const {
    return symbolOf(Fact::Count) + feature;
}

int MaterialModel::symbolOfTexture(int texture) const {
    return symbolOfFeature(static_cast<int>(features.size())) + texture;
}

int MaterialModel::symbolOfTexel(int texture) const {
    return symbolOfTexture(static_cast<int>(textures.size())) + texture;
}

int MaterialModel::symbolOfAttribute(int attribute) const {
    return symbolOfTexel(static_cast<int>(textures.size())) + attribute;
}

int MaterialModel::symbolOfPair(int pair) const {
    return symbolOfAttribute(static_cast<int>(attributes.size())) + pair;
}

std::string fieldMacro(std::string_view name) {
    std::string text;
    for (const char c : name) {
        text += std::isupper(static_cast<unsigned char>(c)) != 0 ? "_" : "";
        text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return text;
}

std::string roleMacro(package::Role role) {
    return "GLINT_ROLE_" + fieldMacro(nameOf(role));
}

}  // namespace glint::materials
