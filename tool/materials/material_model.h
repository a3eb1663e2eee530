// The parts of materials and the effects, that is, the uses of rays in a picture, as
// shaders/materials/*/*.json, shaders/effects/*/*.json and packs declare them.
#pragma once

#include "materials/expression.h"
#include "materials/value_type.h"

#include <glint/internal/package_format.h>

#include <array>
#include <bit>
#include <cassert>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::materials {

enum class Behaviour : std::uint8_t;

// The lit surfaces that call for an effect.
struct EffectCall {
    bool byAll = false;     // every surface does; otherwise those with the behaviour
    Behaviour behaviour{};  // the surface's behaviour towards light
    bool lights = false;    // only where some light shines
    std::string because{};  // of the surfaces that call for it, where all do: "is lit by the sky"
    // The reason if no surface does; {limit} stands for the roughness limit.
    std::string otherwise{};
};

// The similarity of neighbouring rays' hits (Round::coherence), on smooth surfaces and on others.
struct EffectCoherence {
    double mirror = 0.1;
    double glossy = 0.1;
};

struct EffectDeclaration {
    std::string name;         // "ambient-occlusion"
    std::string declaration;  // its file
    std::string about;        // a sentence
    package::EffectInfo::Kind kind = package::EffectInfo::Kind::Rays;
    double order = 0.0;
    bool isOfPack = false;
    EffectCall call;
    // The light that the effect refines. Pictures without the effect have this light too, so no scene calls
    // for it by itself. If empty, a scene may call for it.
    std::string refines{};
    EffectCoherence coherence{};
    std::vector<std::string> settings{};  // the settings that only change this effect
    std::string absent{};                 // why they are not worth trying without it
    // The kind Rays: the sampled direction has a density, so that samples of emissive lights share the light
    // of its lobes. `sample` then also has density…() and share…().
    bool sharesLights = false;
    // Effects of the kind Rays have these two members, for layers. `albedo` names the lobes that bring the
    // light: "diffuse", "specular" or "transmission"; all of them if it is empty. `shows` names the points
    // that surfaces show by it: "mirrored" or "refracted" ones; it is empty if they show only light.
    std::string albedo{};
    std::string shows{};
    // Names of files as an #include gives them, empty where there are none. Each has a function whose name
    // ends with function(). light: shaders/hit/ calls it. apply: changes the sky's shares. sample: makes a
    // ray and its weight. compose: weights the found light for the pixel; without it, the light is multiplied
    // by the weight. start: endsEarly(), before the ray joins the list. walk: a pass over the pixels before
    // that. hit: changes the sky's shares at a hit.
    std::string light{};
    std::string apply{};
    std::string sample{};
    std::string compose{};
    std::string start{};
    std::string walk{};
    std::string hit{};

    std::string function() const;  // "AmbientOcclusion"
    std::string macro() const;     // "AMBIENT_OCCLUSION"
    std::string file() const;      // "ambient_occlusion": part of names of modules
    std::uint32_t abilities() const;
    // Returns the file that every effect of the kind has.
    const std::string& main() const;
    std::vector<const std::string*> files() const;
};

// Returns whether an effect may have the name: words of small letters and digits, joined by hyphens.
bool isEffectName(std::string_view name);
// Returns the package's entry for an effect with that number.
package::EffectInfo infoOf(const EffectDeclaration& effect, std::size_t number);
// Returns the set of those of `effects` that `bits` has.
package::EffectSet effectSetOf(const std::vector<EffectDeclaration>& effects, std::uint32_t bits);
// Returns the bit of the effect of that name, or 0 if there is none.
package::Effect findEffect(const std::vector<EffectDeclaration>& effects, std::string_view name);

// --- Materials: parameters, textures and features ---
//
// The model is data. materials/declarations.h reads it; importing, planning, records and documents follow.

// A set of features by their bits.
//
//   bits  0..31  lobes: what light does at the surface; keys with the same lobes are one family
//   bits 32..63  inputs: where the surface's parameters are read from
//   bits 64...   features of base models that packs declare: of each model, its base and then its others
//
// If packs have more inputs than fit, these take bits from 31 downwards. A number stands for the first 64
// bits. A set may be the complement of one, and then has no end: kAllFeatures.
class FeatureMask {
public:
    FeatureMask() = default;
    FeatureMask(std::uint64_t shared) : shared_(shared) {}
    static FeatureMask ofBit(int bit);

    bool has(int bit) const {
        return (wordAt(bit / kWordBits) >> static_cast<unsigned>(bit % kWordBits) & 1U) != 0;
    }
    // Requires a set with an end, as count() does.
    bool isEmpty() const {
        return shared_ == 0 && own_.empty();
    }
    int count() const;
    // Calls use(bit) for each bit, the lowest first.
    template <typename Use>
    void forEach(const Use& use) const {
        assert(fill_ == 0);
        forEachOf({0, shared_}, use);
        for (const Word& word : own_) {
            forEachOf(word, use);
        }
    }
    // The first 64 bits.
    std::uint64_t shared() const {
        return shared_;
    }

    FeatureMask& operator&=(const FeatureMask& other);
    FeatureMask& operator|=(const FeatureMask& other);
    friend FeatureMask operator&(FeatureMask a, const FeatureMask& b) {
        return a &= b;
    }
    friend FeatureMask operator|(FeatureMask a, const FeatureMask& b) {
        return a |= b;
    }
    FeatureMask operator~() const;
    friend bool operator==(const FeatureMask& a, const FeatureMask& b) = default;
    // As numbers.
    friend std::strong_ordering operator<=>(const FeatureMask& a, const FeatureMask& b);
    friend std::string toHex(const FeatureMask& mask);

private:
    static constexpr int kWordBits = 64;
    struct Word {
        int place = 0;
        std::uint64_t bits = 0;

        bool operator==(const Word&) const = default;
    };

    template <typename Use>
    static void forEachOf(const Word& word, const Use& use) {
        for (std::uint64_t rest = word.bits; rest != 0; rest &= rest - 1) {
            use(word.place * kWordBits + std::countr_zero(rest));
        }
    }
    std::uint64_t wordAt(int place) const;
    template <typename Combine>
    void combine(const FeatureMask& other, const Combine& combine);

    std::uint64_t shared_ = 0;  // word 0
    std::uint64_t fill_ = 0;    // the further words that are not listed: 0, or all bits of a complement
    std::vector<Word> own_;     // the words that differ from it, by place
};

// Returns the set as a hexadecimal number of at least 16 digits.
std::string toHex(const FeatureMask& mask);

inline const FeatureMask kAllFeatures = ~FeatureMask();
inline constexpr int kFirstInput = 32;
inline constexpr int kFirstOfModels = 64;
inline constexpr int kOwnFeatures = package::KeyWords::Own::kBits;  // of a model, at most

// The stage at which a feature's GLSL runs.
enum class Stage : std::uint8_t {
    Attributes,   // attributes of vertices
    Coordinates,  // UVs
    Base,         // a base model, without which no hit can do
    Surface,      // base colour, normal, roughness
    Layer,        // a lobe
    Emission,
    Opacity,
};

// An object in the JSON of a material that holds parameters and textures.
struct MaterialObject {
    std::string name;  // "KHR_materials_sheen", "pbrMetallicRoughness", or empty for the material itself
    bool isExtension = false;  // below "extensions"
    // The object that a material with this one does not read, and the values that its parameters then have.
    // -1: none.
    int replaces = -1;
    struct Setting {
        int parameter = 0;
        std::vector<double> numbers{};
    };
    std::vector<Setting> settings{};
    // Indices into MaterialModel::features: the first feature that asks for it, and the first base model; -1:
    // none.
    int feature = -1;
    int base = -1;
    bool isUnlit = false;  // it asks for a feature that takes no light
    // Indices into MaterialModel::order, ascending: the features of a base model that only materials with
    // this object may have.
    std::vector<int> steps{};
    std::vector<int> asksFor{};  // indices into MaterialModel::features: those that its presence asks for
    // Ascending indices into MaterialModel::parameters and MaterialModel::textures of those that have a place
    // in it.
    std::vector<int> parameters{};
    std::vector<int> textures{};
    std::vector<int> fills{};  // indices into MaterialModel::parameters, ascending: those that its own set
    // Indices into MaterialModel::behaviours, ascending: its rules, which count only if a file gives it.
    std::vector<int> behaviours{};
};

// A parameter of a material: adjacent numbers of Material::values, those of an array's elements one after the
// other.
struct Parameter {
    std::string name;      // unique in all declarations (fullName()): "toonEdge"
    std::string declared;  // in its declaration and in lists of materials: "edge"
    int object = 0;
    // The place below its object: "clearcoatFactor", "normalTexture/scale".
    std::string place;
    const ValueType* type = &kTypes[0];
    int count = 0;                     // elements of an array; 0: a single value
    std::vector<std::string> names{};  // of an enum: its values, by their numbers
    std::string unit{};
    std::string about{};
    int first = 0;                   // index into Material::values
    int numbers = 1;                 // how many there are, of all elements
    std::vector<double> fallback{};  // The numbers that a material has whose file gives none.
    // Numbers outside of the range are clamped. A parameter whose upper end is infinite may itself be
    // infinite.
    double low = 0.0;
    double high = 0.0;
    std::optional<double> also{};  // one further value that is valid
    bool isAngle = false;          // in radians; reduced to one turn
    package::Role role = package::Role::None;
    int aliasOf = -1;   // the parameter whose numbers it sets, or -1
    int scaledBy = -1;  // the texture that multiplies it by numbers in [0, 1], or -1
    // The texture's channel that multiplies each channel of the parameter, which is a vector, if the texture
    // has no other effect on it; -1: not known.
    std::array<int, 4> scaledByChannels{-1, -1, -1, -1};
    int feature = -1;  // Records have the parameter if a key has this feature; -1: always.
    bool inRecord = true;

    bool isArray() const {
        return count > 0;
    }
    // Returns whether it is a single number or vector in floating point (kVectorTypes).
    bool isVector() const {
        return !isArray() && type->isVector();
    }
    // Returns whether conditions may name it: it is neither an array nor a matrix or an address.
    bool isNamedByConditions() const {
        return !isArray() && !type->isMatrix() && !type->isAddress();
    }
    // Returns the type as people write it: "color", "enum (soft, hard)", "vec3[8]".
    std::string typeText() const;
    bool isValid(double value) const;
    // Returns a number as a material stores it: within the range, angles within half a turn, rounded to a
    // float or to a whole number.
    double hold(double value) const;
};

// A field of the record that follows from parameters.
struct DerivedField {
    std::string name;                    // unique in all declarations
    const ValueType* type = &kTypes[0];  // one of kVectorTypes
    std::string unit{};
    std::string about{};
    int feature = -1;
    std::vector<Expression> channels;  // one expression for all channels, or one for each
};

// The reads of a texture by shading. They decide about compressed formats and the making of levels.
struct TextureReads {
    std::uint32_t channels = 15;  // bit 0: red, to bit 3: alpha
    bool isNormals = false;  // red and green are the x and y of unit vectors in tangent space, z is positive
    std::uint32_t roughness =
        0;  // channels of those above with the roughness of a lobe, whose square is alpha
    std::uint32_t glossiness = 0;  // and with 1 - roughness
};

// A texture that a material can have. Two places can fill one, because there are two base models.
struct MaterialTexture {
    std::string name;  // unique in all declarations: "clearcoatTexture"
    int feature = 0;   // index into MaterialModel::features
    package::Role role = package::Role::None;
    package::TextureEntry::Dimension dimension = package::TextureEntry::Dimension::Flat;
    struct Place {
        int object = 0;
        std::string member;
        bool isColor = false;  // sRGB; alpha is linear all the same
        TextureReads reads{};
    };
    std::vector<Place> places;
};

// An attribute of vertices that a feature reads beside those of glTF's core: "_WEAR".
struct VertexAttribute {
    std::string name;  // unique in all declarations, and the member of VertexAttributes in GLSL
    std::string gltf;  // its name in the attributes of a primitive
    const ValueType* type = &kTypes[0];  // one of kVectorTypes
    std::string about{};
    // The value on primitives that lack it. Without one, such primitives do not have the feature.
    std::optional<std::array<float, 4>> fallback{};
    int feature = -1;  // index into MaterialModel::features

    std::uint64_t mask(int index) const {
        return std::uint64_t{1} << static_cast<unsigned>(index);
    }
};
inline constexpr std::size_t kMostVertexAttributes = 64;

// A reason why a feature that the file asks for changes nothing.
struct NeutralReason {
    Expression when;
    std::string because;
    // The reason holds only in keys that have all of these features and lack all of those.
    FeatureMask onlyWith = 0;
    FeatureMask onlyWithout = 0;

    bool countsIn(const FeatureMask& key) const {
        return (onlyWith & ~key) == 0 && (onlyWithout & key) == 0;
    }
};

// A feature leaves others out of the keys that have it.
struct Exclusion {
    int by = 0;  // index into MaterialModel::features
    FeatureMask excluded = 0;
    std::string because;
};

struct FeatureCost {
    double instructions = 0.0;
    double fetches = 0.0;
};

struct Feature {
    int bit = 0;
    int model = -1;  // index into MaterialModel::models: only keys of this base have the feature; -1: any
    bool isLobe = false;
    std::string name;       // unique in all declarations: "baseColorTexture"
    std::string shortName;  // part of a case's name: "BaseTex"
    std::string macro;      // macro in GLSL: "GLINT_BASE_COLOR_TEXTURE"
    std::string gltf;       // its place in glTF
    std::string about{};
    Stage stage = Stage::Surface;
    package::Role role = package::Role::None;  // of the feature itself; not that of its texture
    int object = -1;                           // the extension whose presence asks for it, or -1
    std::optional<Expression> given{};  // If there is one, it says whether the file asks for the feature.
    std::vector<NeutralReason> neutral{};
    int texture = -1;  // index into MaterialModel::textures: the feature is that this is read
    int lobe = -1;     // the feature without which the texture is not read, or -1
    bool needsTangents = false;
    int needsTexCoord = -1;          // the UV set that its GLSL reads by itself, or -1
    bool hasOwnCoordinates = false;  // the texture's GLSL makes its coordinates; it needs no UV set
    bool isOfBase = false;           // Hits keep it with --hit-lobes base.
    bool isInDraft = false;          // The draft of first hits shows it.
    FeatureCost cost{};
    std::vector<int> exclusions{};  // indices into MaterialModel::exclusions of those by this feature

    // Returns the end of the macros that ask for it: "BASE_COLOR_TEXTURE".
    std::string macroEnd() const;
    FeatureMask mask() const {
        return FeatureMask::ofBit(bit);
    }
    // Returns when the feature is given but changes nothing, in words.
    std::string neutralText() const;
};

// The GLSL of a feature, in files of its folder. Its functions begin with the feature's name.
struct FeatureCode {
    std::string name;         // of the declaration: "clearcoat"
    std::string declaration;  // its file
    int feature = -1;         // Keys without this feature do not run the code; -1: all keys run it.
    FeatureMask unless = 0;   // Keys with any of these features do not run it.
    // Names of files as an #include gives them, empty where there is no such function. surface:
    // clearcoatSurface(); bsdf: clearcoatBsdf(); emission: clearcoatEmission(); coordinates:
    // clearcoatCoordinates(); opacity: clearcoatOpacity(); diffuse: the struct Clearcoat and
    // clearcoatDiffuse(); layer and model: the struct Clearcoat and the functions that
    // shaders/bsdf/layer.glsl and shaders/bsdf/model.glsl list.
    std::string surface{};
    std::string bsdf{};
    std::string layer{};
    std::string model{};
    std::string diffuse{};
    std::string emission{};
    std::string coordinates{};
    std::string opacity{};
    bool coversEmission = false;  // the layer's reflection also weakens the emission
    bool isTraced = false;        // rays may trace the layer's reflection
    bool isReciprocal = false;    // the layer or model claims that view and light may change places
    bool isSampled = false;       // the model samples directions itself; otherwise they are cosine-weighted
    bool shadesAll = false;       // the model shades the light of all lights at once
    bool isOfPack = false;        // of a user's own
    std::string gains{};          // why more light may leave the surface than reaches it; empty: none may
};

// A base model that a pack declares. Of keys, shaders see it and its features in words of their own, in which
// each model numbers its features anew (package::KeyWords).
struct BaseModel {
    std::string name;  // of the declaration
    int feature = -1;  // index into MaterialModel::features: the base itself
    int firstBit = 0;  // of its further features, which follow each other
    int bits = 0;      // how many these are, at most kOwnFeatures
    // The word by which shaders know the base: its number and what it does.
    std::uint32_t word = 0;
};

// The effects of a material on light, by which effects are chosen.
enum class Behaviour : std::uint8_t { Reflects, Transmits, Scatters, Emits };

struct BehaviourRule {
    Behaviour does = Behaviour::Reflects;
    int object = 0;  // the rule counts only if the material reads this object
    Expression when;
    std::optional<Expression> roughness{};  // of Reflects
    std::optional<Expression> value{};      // replaces {} in the text
    std::string text{};
    std::string textureText{};  // where only a texture can make it as smooth as it has to be
};

// Symbols of expressions. Parameters come first, by their index.
enum class Fact : std::uint8_t {
    Normal,
    Tangent,
    TexCoord0,
    TexCoord1,
    Color,        // a number: the least and greatest of COLOR_0
    GivesColors,  // the primitive has COLOR_0
    DoubleSided,
    Mask,
    Blend,
    RaysTestAlpha,   // the package tests alpha
    RaysBlend,       // the package shows surfaces of alphaMode BLEND by chance
    ReadsTexCoord0,  // a texture that the key reads uses the set
    ReadsTexCoord1,
    MovesTextures,    // a texture that the key reads has a transform
    GivesTransforms,  // some texture has one
    NeedsTangents,    // a feature of the key reads tangents
    DerivesTangents,  // the primitive's tangents are those that shading derives
    TurnsTangents,    // a frame that the key derives is of UVs that a transform turns or mirrors
    ChangesOpacity,   // a feature of the key has GLSL at the stage opacity
    ModelOfPack,      // the base of the key is a model that a pack declares
    Count
};

// A file of GLSL, by the name that an #include gives.
struct ModelSource {
    std::string name;
    std::string text;

    bool operator==(const ModelSource&) const = default;
};

// A file of a pack, in the state in which it was read.
struct PackFile {
    std::string path;
    std::uint64_t bytes = 0;
    std::uint64_t hash = 0;  // base::hashBytes()
    bool isDeclaration = false;

    bool operator==(const PackFile&) const = default;
};

// A feature in the order in which the features of a key are decided. A key that lacks `needs` lacks it, too.
struct FeatureStep {
    int feature = 0;  // index into MaterialModel::features
    int needs = -1;   // bit: of the base of its model
};

class MaterialModel {
public:
    std::vector<MaterialObject> objects;  // The first is the material itself.
    std::vector<Parameter> parameters;
    std::vector<DerivedField> derived;
    std::vector<MaterialTexture> textures;
    std::vector<VertexAttribute> attributes;  // of packs
    std::vector<Feature> features;            // by bit
    std::vector<BaseModel> models;            // of packs, by bit; their number in keys is one more
    std::vector<FeatureStep> order;           // of evaluation
    std::vector<int> commonSteps;             // indices into `order`, ascending: those of every material
    std::vector<Exclusion> exclusions;
    std::vector<BehaviourRule> behaviours;
    std::vector<int> commonBehaviours;       // indices into `behaviours`, ascending: those of no such object
    std::vector<EffectDeclaration> effects;  // by the number of their bit
    std::vector<FeatureCode> code;           // in the order in which it runs
    std::vector<ModelSource> sources;        // GLSL of packs; that of Glint's own features is embedded
    std::vector<PackFile> files;             // all files of packs, sorted by name
    std::string plainBase;                   // the declaration of the base of materials that name none
    FeatureMask unlit = 0;                   // features without light
    FeatureMask bothSides = 0;               // features that let light through to the far side
    FeatureMask ownModels = 0;               // models whose GLSL stands in place of glTF's base
    FeatureMask lobes = 0;                   // features that are lobes
    FeatureMask bases = 0;                   // base models; every hit needs one
    FeatureMask opacity = 0;                 // features with GLSL at the stage opacity
    std::vector<double> defaults;            // of the numbers of parameters, by Parameter::first
    std::vector<std::array<int, 2>> pairs;   // textures that same() compares

    // Each returns the index of that name, or -1.
    int findParameter(std::string_view name) const;
    int findTexture(std::string_view name) const;
    int findFeature(std::string_view name) const;
    int findObject(std::string_view name) const;
    int findAttribute(std::string_view name) const;
    // Each returns the index of the one that has the role, or -1. Parameters and textures that fill it count
    // as it.
    int parameterOf(package::Role role) const;
    int textureOf(package::Role role) const;
    // Makes those of the names so far fast. It is needed again, for all of them, after rows have moved.
    void indexNames();
    void indexAllNames();
    // Makes indicesOf() know the bits of all features.
    void indexBits();
    // Fills in the indices into `behaviours`.
    void indexBehaviours();
    // The same for what materials of a model of a pack mean by a name: a thing of the model, or else one that
    // all models share. `model` is an index into `models`; -1: of glTF's bases.
    int findParameter(std::string_view name, int model) const;
    int findTexture(std::string_view name, int model) const;

    // Returns the feature's bit, or 0 if there is no such feature.
    FeatureMask mask(std::string_view feature) const;
    // The same for the feature that has the role.
    FeatureMask mask(package::Role role) const;
    // The same for the feature that the texture with the role is read.
    FeatureMask textureMask(package::Role role) const;
    // Returns the features that decide about the values of the parameter and the texture with the role: those
    // that read them, and those that give and move the coordinates of the texture.
    FeatureMask featuresFor(package::Role role) const;
    // Returns the features of a set with an end, as ascending indices into `features`.
    std::vector<int> indicesOf(const FeatureMask& mask) const;
    // Returns their names in the same order.
    std::vector<std::string> names(const FeatureMask& mask) const;
    // Returns the numbers that any texture of the slot can hold: those of one that is not flat come from the
    // program alone, in any format.
    ValueInterval anyTexel(int texture) const {
        const bool isFlat =
            textures[static_cast<std::size_t>(texture)].dimension == package::TextureEntry::Dimension::Flat;
        return isFlat ? kUnitInterval : kAnything;
    }
    // Returns the base of the model of a pack whose feature this is, as an index into `features`.
    int baseOf(const Feature& feature) const {
        return models[static_cast<std::size_t>(feature.model)].feature;
    }
    // Returns the model of a pack that a key has, as an index into `models`, or -1: one of glTF's bases.
    int modelOf(const FeatureMask& key) const;
    // Returns the model that a bit from kFirstOfModels on belongs to.
    int modelOfBit(int bit) const;
    // Returns the features that keys of a model may have; -1: of glTF's bases.
    FeatureMask featuresOf(int model) const;
    // Returns whether materials of a model have a value of a parameter that belongs to no feature. They have
    // none of an object that the model replaces, unless a parameter of the model fills it.
    bool hasParameter(int model, int parameter) const;
    // Returns the set with the base of each feature of a model.
    FeatureMask withBases(const FeatureMask& mask) const;
    // Returns a key as packages and shaders have it. If `mask` has no base of a pack, its model is 0.
    package::KeyWords words(const FeatureMask& mask) const;
    // Returns the set that the words of a key stand for.
    FeatureMask maskOf(const package::KeyWords& words) const;
    // Returns what the keys of a case have, and what some of them have. Cases of several models know nothing
    // about the features of each.
    std::pair<package::KeyWords, package::KeyWords> caseWords(const FeatureMask& always,
                                                              const FeatureMask& sometimes) const;
    // Returns how many words shaders need for the own features of the models of `used`: at least 1.
    int ownWordCount(const FeatureMask& used) const;
    // Returns the word of the base of index `model`.
    std::uint32_t modelWord(int model) const {
        return models[static_cast<std::size_t>(model)].word;
    }
    // Returns "#define GLINT_BASE_COLOR_TEXTURE 0x1u" for every feature that all models share; lobes and
    // inputs are numbered within their own word. For these and for all features of the models of `used`,
    // GLINT_HAS_BASE_COLOR_TEXTURE(features) asks for it, and GLINT_KEY_HAS_BASE_COLOR_TEXTURE(features)
    // where the code runs for keys that are not the module's own. GLINT_ROLE_VERTEX_COLOR is the bit of the
    // feature with that role, and GLINT_ROLE_BASE_COLOR_TEXTURE that of the texture with that role.
    // GLINT_LOBES is the set of shared lobes; GLINT_UNLIT_LOBES and GLINT_BOTH_SIDES_LOBES are those that
    // take no light and that let light through.
    std::string featureDefines(const FeatureMask& used = kAllFeatures) const;

    // Numbers of symbols. The kinds follow each other.
    int symbolOf(Fact fact) const;
    int symbolOfFeature(int feature) const;      // has(feature)
    int symbolOfTexture(int texture) const;      // readable(texture)
    int symbolOfTexel(int texture) const;        // texel(texture)
    int symbolOfAttribute(int attribute) const;  // attribute(name)
    int symbolOfPair(int pair) const;            // same(texture, texture)

private:
    // The first rows of a list by their names.
    struct NameIndex {
        std::map<std::string, int, std::less<>> places;
        std::size_t count = 0;

        template <typename Rows>
        int find(const Rows& rows, std::string_view name) const;
        template <typename Rows>
        void extend(const Rows& rows);
    };
    NameIndex parameterIndex_;
    NameIndex textureIndex_;
    NameIndex featureIndex_;
    NameIndex objectIndex_;
    std::array<int, kFirstOfModels> ofSharedBit_{};  // index of the feature of each bit that all models share
};

// Returns whether two models are of the same declarations. Their GLSL may differ.
bool haveSameDeclarations(const MaterialModel& a, const MaterialModel& b);

// Returns the name, unique in all declarations, of what a model of a pack declares by `name`. It begins with
// the name of the model: "toonEdge" of "edge", and also of "toonEdge". An empty `scope` stands for what all
// models share, whose names are unique by themselves.
std::string fullName(std::string_view scope, std::string_view name);
// Returns "ToonEdge" of "toonEdge".
std::string capitalized(std::string_view name);
// Returns a field's part of the names of macros: "CLEARCOAT_ROUGHNESS_FACTOR" of "clearcoatRoughnessFactor".
std::string fieldMacro(std::string_view name);

// The names of roles in declarations, by package::Role.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(package::Role::Count)> kRoleNames{
    "",
    "baseColor",
    "alphaCutoff",
    "emission",
    "emissionStrength",
    "tangentFrame",
    "alphaTest",
    "emits",
    "normals",
    "tangents",
    "texCoord0",
    "texCoord1",
    "textureTransform",
    "turnedFrames",
    "vertexColor",
    "doubleSided"};
constexpr std::string_view nameOf(package::Role role) {
    return kRoleNames[static_cast<std::size_t>(role)];
}
// Returns the beginning of the macros of a role: "GLINT_ROLE_BASE_COLOR".
std::string roleMacro(package::Role role);

// The model of glTF's core and of the extensions that Glint shades. It is read once, from the declarations
// that are embedded in the library, and lives as long as the program.
const MaterialModel& builtinMaterialModel();

}  // namespace glint::materials
