// The materials that planning reads. Their parameters and textures are declared (materials/material_model.h).
#pragma once

#include "materials/material_model.h"

#include <glint/internal/package_format.h>
#include <glint/result.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::materials {

// KHR_texture_transform: uv' = T(offset) R(rotation) S(scale) uv; rotation in radians, counter-clockwise.
struct TextureTransform {
    std::array<float, 2> offset{0.0F, 0.0F};
    float rotation = 0.0F;
    std::array<float, 2> scale{1.0F, 1.0F};

    bool operator==(const TextureTransform&) const = default;
};

// The rows that give u' and v' of (u, v, 1).
using TransformRows = std::array<std::array<double, 3>, 2>;

// Returns translation * rotation * scale. The rotation is counter-clockwise as seen on the image, where v
// points down; the extension's GLSL listing turns the other way, its text and test models this one
// (KhronosGroup/glTF issue 1563).
TransformRows rowsOf(const TextureTransform& transform);

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// The place of a number in an image. Level -1: nowhere.
struct TexelPlace {
    int level = -1;
    int x = 0;
    int y = 0;
};

// The values that lookups of a texture can give, by channel, as shading reads them.
struct TextureContent {
    // The range of each channel. It is [0, 1] where the texels are unknown.
    std::array<ValueInterval, 4> of{kUnitInterval, kUnitInterval, kUnitInterval, kUnitInterval};
    // The one number that all lookups give, if all texels are equal; NaN if they are not. `of` contains it,
    // and is wider by the rounding of drivers.
    std::array<double, 4> constant{kNoNumber, kNoNumber, kNoNumber, kNoNumber};
    // Texels that have the least and the greatest number.
    std::array<TexelPlace, 4> leastAt{};
    std::array<TexelPlace, 4> greatestAt{};
    std::string image{};  // JSON pointer
};

struct TextureInfo {
    int texture = -1;  // index into Scene::textures; -1 where the slot is empty
    int texCoord = 0;  // the UV set; the extension's override is already applied
    TextureTransform transform;
    bool hasTransform = false;  // The file gives KHR_texture_transform here, even if it is the identity.
    bool moves = false;         // An animation changes the transform.
    bool turns = false;         // An animation changes its rotation, or makes its scale negative.
    TextureContent content{};   // of all texels
    // The texture was constant where the material shows it, and its product is in the parameters that it
    // scales. So the slot is empty.
    bool isFolded = false;
};

// The textures of a material, by index into MaterialModel::textures. A slot that is never named is empty, and
// takes no memory.
class TextureSlots {
public:
    const TextureInfo& operator[](std::size_t slot) const;
    TextureInfo& operator[](std::size_t slot) {
        return slots_[slot];
    }
    // The slots that are not empty, and some that are, as pairs of number and texture, by number.
    auto begin() const {
        return slots_.begin();
    }
    auto end() const {
        return slots_.end();
    }
    auto begin() {
        return slots_.begin();
    }
    auto end() {
        return slots_.end();
    }

private:
    std::map<std::size_t, TextureInfo> slots_;
};

// The objects that a file gives for a material, as indices into MaterialModel::objects: few of many.
class GivenObjects {
public:
    bool has(int object) const {
        return std::ranges::binary_search(objects_, object);
    }
    void add(int object) {
        const auto place = std::ranges::lower_bound(objects_, object);
        if (place == objects_.end() || *place != object) {
            objects_.insert(place, object);
        }
    }
    auto begin() const {
        return objects_.begin();
    }
    auto end() const {
        return objects_.end();
    }

private:
    std::vector<int> objects_;  // ascending
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

// The numbers of one parameter of a material, to which it refers. `Number` is double or const double.
template <typename Number>
class BasicParameterValue {
public:
    explicit BasicParameterValue(std::span<Number> numbers) : numbers_(numbers) {}
    BasicParameterValue(const BasicParameterValue&) = default;
    BasicParameterValue& operator=(const BasicParameterValue&) = delete;
    ~BasicParameterValue() = default;

    // The first number.
    operator float() const {
        return static_cast<float>(numbers_[0]);
    }
    Number& operator[](std::size_t channel) const {
        return numbers_[channel];
    }
    // Sets all numbers to one value, or each to its own. `values` must have as many as the parameter.
    const BasicParameterValue& operator=(double value) const {
        std::ranges::fill(numbers_, value);
        return *this;
    }
    const BasicParameterValue& operator=(std::span<const double> values) const {
        assert(values.size() == numbers_.size());
        std::ranges::copy(values, numbers_.begin());
        return *this;
    }
    const BasicParameterValue& operator=(std::initializer_list<double> values) const {
        return *this = std::span(values.begin(), values.size());
    }
    std::size_t size() const {
        return numbers_.size();
    }
    auto begin() const {
        return numbers_.begin();
    }
    auto end() const {
        return numbers_.end();
    }
    template <std::size_t Count>
    bool operator==(const std::array<float, Count>& values) const {
        return std::ranges::equal(numbers_, values);
    }

private:
    std::span<Number> numbers_;
};
using ParameterValue = BasicParameterValue<double>;
using ConstParameterValue = BasicParameterValue<const double>;

// The numbers of a material: floats and whole numbers of 32 bits. A parameter that nothing has set has the
// declared defaults and takes no memory. The model must outlive them.
class MaterialValues {
public:
    explicit MaterialValues(const MaterialModel& model) : model_(&model) {}

    // `place` counts from Parameter::first.
    double operator[](std::size_t place) const;
    std::span<const double> of(const Parameter& parameter) const;
    // Returns numbers that may be set. They stay where they are until the values are copied.
    std::span<double> of(const Parameter& parameter);
    bool operator==(const MaterialValues& other) const;

private:
    const MaterialModel* model_;
    std::map<std::size_t, std::vector<double>> set_;  // by Parameter::first
};

// The model must outlive the material.
class Material {
public:
    explicit Material(const MaterialModel& model = builtinMaterialModel());

    std::string name;
    AlphaMode alphaMode = AlphaMode::Opaque;
    bool doubleSided = false;
    MaterialValues values;
    TextureSlots textures;
    GivenObjects given;
    // The values that an animation gives each number, by its index in `values`; empty if none changes.
    // Planning reads them in place of the numbers.
    std::vector<ValueInterval> ranges;
    // Material extensions that the file uses for this material and that Glint does not shade.
    std::vector<std::string> unsupportedExtensions;

    const MaterialModel& model() const {
        return *model_;
    }
    // Require a name that the model has, as its declaration or its full name.
    ParameterValue operator[](std::string_view parameter);
    ConstParameterValue operator[](std::string_view parameter) const;
    TextureInfo& texture(std::string_view texture);
    const TextureInfo& texture(std::string_view texture) const;
    // Sets parameters of an extension, and that the file gives it.
    void give(std::string_view object);
    bool gives(std::string_view object) const;
    // Returns whether a texture is colour, in sRGB; its alpha is linear in any case.
    bool isColor(int texture) const;
    // Returns the channels that shading reads of it, in all places that the material reads.
    TextureReads readsOf(int texture) const;

    // Returns whether the material reads an object of its JSON. It does not read the base model that another
    // one replaces.
    bool reads(int object) const;
    // Returns whether no light changes the look of the surface.
    bool isUnlit() const;

private:
    const MaterialModel* model_;
};

// Returns the numbers of a material as Material::ranges.
std::vector<ValueInterval> rangesOf(const Material& material);

// Returns the model of a pack whose base the material names, as an index into MaterialModel::models, or -1:
// one of glTF's. The keys of a material may lack a base that they have a reason to leave out.
int modelOf(const Material& material);

enum class ColorContent : std::uint8_t {
    None,   // no COLOR_0
    White,  // COLOR_0 is (1, 1, 1, 1) everywhere, so it changes nothing.
    Varying
};

// The part of a material's texture that a primitive can see.
struct SeenTexture {
    int slot = 0;  // index into MaterialModel::textures
    TextureContent content;
};

// The facts about a primitive that planning needs: its material and which attributes it has.
struct PrimitiveInputs {
    int mesh = 0;       // index into Scene::meshes
    int primitive = 0;  // within the mesh
    int material = 0;   // always valid
    bool hasNormals = false;
    bool hasTangents = false;
    bool hasTexCoords0 = false;
    bool hasTexCoords1 = false;
    ColorContent colors = ColorContent::None;
    std::uint64_t attributes = 0;  // one bit for each of MaterialModel::attributes that it has
    double expectedHits = 0.0;  // in proportion to those of other primitives; all are 0 if nothing is known
    // The file gives tangents, and they are those that shading would derive.
    bool derivesTangents = false;
    // The textures by ascending slot. A texture that is not listed has only the content of the whole
    // (TextureInfo::content).
    std::vector<SeenTexture> seen{};

    bool hasTexCoords(int set) const {
        return set == 0 ? hasTexCoords0 : set == 1 && hasTexCoords1;
    }
};

struct KeyOptions {
    package::AlphaPolicy alpha = package::AlphaPolicy::Opaque;
    // The lobes that a key may have. If a lobe is left out, inputs that only this lobe reads are left out
    // too.
    FeatureMask keptLobes = kAllFeatures;
};

// Returns whether the slot has a texture whose UV set the primitive has and Glint reads.
bool isReadable(const Material& material, const PrimitiveInputs& primitive, int texture);

// Returns the primitive as if it had every attribute.
PrimitiveInputs withEveryAttribute(PrimitiveInputs primitive);

// Returns why the primitive can't have the feature, whatever the material's values are: it lacks an attribute
// that the feature reads. Empty if it has them all.
std::string missingAttribute(const Material& material, const PrimitiveInputs& primitive,
                             const Feature& feature);

// Returns the textures and lobes that the file requests, that would change something on a primitive with
// every attribute, and that this primitive can't have, with the same reason: ascending indices into
// MaterialModel::features.
std::vector<std::pair<int, std::string>> lostInputs(const Material& material,
                                                    const PrimitiveInputs& primitive);

// Returns the content that the primitive can see of the texture, whether or not it is readable.
const TextureContent& contentOf(const Material& material, const PrimitiveInputs& primitive, int texture);

// The facts about a material on a primitive. A parameter that a readable texture scales has the interval of
// all products with numbers that the texture may hold. The objects that it refers to must outlive it.
class MaterialFacts final : public Facts {
public:
    // The use of textures. Scale: by their contents. Unknown: by any number in [0, 1], and texel() is any
    // such number. Texels: as Unknown, but texel() is known. Ignored: not at all.
    enum class Textures : std::uint8_t { Scale, Unknown, Texels, Ignored };

    // `key` holds the features that are known to be in the key.
    MaterialFacts(const Material& material, const PrimitiveInputs& primitive, const KeyOptions& options,
                  const FeatureMask& key, Textures textures = Textures::Scale);

    Channels number(int symbol) const override;
    Certainty condition(int symbol) const override;

private:
    Certainty fact(Fact fact) const;
    bool readsTexCoord(int set) const;
    bool hasTangents() const;
    // Returns whether `is` holds for a feature of the key.
    template <typename Is>
    bool anyInKey(const Is& is) const;
    // Returns whether a feature without a texture needs a frame, and no texture of the key gives it one.
    bool takesPlainFrame(const Feature& feature) const;
    const TextureInfo* plainFrameTexture() const;  // null: the first UV set
    bool turnsTangents() const;

    const Material& material_;
    const PrimitiveInputs& primitive_;
    const KeyOptions& options_;
    const FeatureMask& key_;
    Textures textures_;
};

// Found by their arguments from other namespaces.
using glint::nameOf;

}  // namespace glint::materials
