#include "generated/features.glsl"
#include "generated/scene.glsl"
#include "interop/models.h"

// The own features of a model, in as many words as some model of the package needs.
#if GLINT_OWN_WORDS == 4
#define GLINT_OWN_TYPE uvec4
#define GLINT_OWN(a, b, c, d) uvec4(a, b, c, d)
#define GLINT_OWN_OF(words) (words)
#define GLINT_OWN_WORD(own, word) (own)[word]
#elif GLINT_OWN_WORDS == 3
#define GLINT_OWN_TYPE uvec3
#define GLINT_OWN(a, b, c, d) uvec3(a, b, c)
#define GLINT_OWN_OF(words) (words).xyz
#define GLINT_OWN_WORD(own, word) (own)[word]
#elif GLINT_OWN_WORDS == 2
#define GLINT_OWN_TYPE uvec2
#define GLINT_OWN(a, b, c, d) uvec2(a, b)
#define GLINT_OWN_OF(words) (words).xy
#define GLINT_OWN_WORD(own, word) (own)[word]
#else
#define GLINT_OWN_TYPE uint
#define GLINT_OWN(a, b, c, d) (a)
#define GLINT_OWN_OF(words) (words).x
#define GLINT_OWN_WORD(own, word) (own)
#endif

// The features that a case knows about its keys. Those that every model may have stand in two words, `lobes` and
// `inputs`; those of a model that a pack declares in `own`, numbered in the model. What begins with `always`,
// `sometimes` and `case` are literals of the case; the others are the key of the geometry at hand. The functions are
// written so that SPIRV-Tools folds every decided bit: a feature that no key of the case has leaves no code, and one
// that every key has leaves no branch.
struct Features {
    uint alwaysLobes;
    uint alwaysInputs;
    uint sometimesLobes;
    uint sometimesInputs;
    uint caseModel;  // interop/models.h
    GLINT_OWN_TYPE alwaysOwn;
    GLINT_OWN_TYPE sometimesOwn;
    uint lobes;
    uint inputs;
    uint model;
    GLINT_OWN_TYPE own;
};

// The members of Features that are the key of a geometry.
#if GLINT_USES_MODELS
#define GLINT_KEY(geometry)                                                                                     \
    (geometry).featureLobes, (geometry).featureInputs, (geometry).featureModel, GLINT_OWN_OF((geometry).featureOwn)
#else
#define GLINT_KEY(geometry) (geometry).featureLobes, (geometry).featureInputs, 0u, GLINT_OWN(0u, 0u, 0u, 0u)
#endif

// Whether the records of keys with that word of a model have glTF's base colour, and its alpha, which is 1 without one.
#if GLINT_USES_MODELS
#define GLINT_FILLS_BASE_COLOR(model) ((model) == 0u || ((model) & kModelBaseColor) != 0u)
#else
#define GLINT_FILLS_BASE_COLOR(model) true
#endif
#define GLINT_BASE_ALPHA(record, model)                                                                         \
    (GLINT_FILLS_BASE_COLOR(model) ? GLINT_ROLE_BASE_COLOR(record).a : 1.0)

bool lobeOfKey(Features features, uint bit) {
    return (features.alwaysLobes & bit) != 0u ||
           ((features.sometimesLobes & bit) != 0u && (features.lobes & bit) != 0u);
}

bool inputOfKey(Features features, uint bit) {
    return (features.alwaysInputs & bit) != 0u ||
           ((features.sometimesInputs & bit) != 0u && (features.inputs & bit) != 0u);
}

// The features of a case and a key without such a model.
#define GLINT_FEATURES_OF_GLTF(alwaysLobes, alwaysInputs, sometimesLobes, sometimesInputs, lobes, inputs)       \
    Features(alwaysLobes, alwaysInputs, sometimesLobes, sometimesInputs, 0u, GLINT_OWN(0u, 0u, 0u, 0u),         \
             GLINT_OWN(0u, 0u, 0u, 0u), lobes, inputs, 0u, GLINT_OWN(0u, 0u, 0u, 0u))

// Returns the word of the key's model.
uint modelOfKey(Features features) {
    return features.caseModel != kAnyModel ? features.caseModel : features.model;
}

// Returns whether the key is of the model of that number, and has one of its features, which are in one word; without
// bits, the model alone.
bool isOwnOfKey(Features features, uint model, uint always, uint sometimes, uint own, uint bits) {
    return (modelOfKey(features) & kModelNumber) == model &&
           (bits == 0u || (always & bits) != 0u || ((sometimes & bits) != 0u && (own & bits) != 0u));
}
#define ownOfKey(features, model, word, bits)                                                                   \
    isOwnOfKey(features, model, GLINT_OWN_WORD((features).alwaysOwn, word),                                     \
               GLINT_OWN_WORD((features).sometimesOwn, word), GLINT_OWN_WORD((features).own, word), bits)

// The features that all cases of the module have, and those that any has. A module that defines them before it includes
// this file compiles several times faster, because code of decided features is removed before functions are inlined.
#ifndef GLINT_MODULE_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_LOBES 0u
#define GLINT_MODULE_ALWAYS_INPUTS 0u
#define GLINT_MODULE_ANY_LOBES 0xFFFFFFFFu
#define GLINT_MODULE_ANY_INPUTS 0xFFFFFFFFu
#define GLINT_MODULE_MODEL kAnyModel
#endif

// Every module also evaluates the emission of emissive lights, whichever case they belong to. So nothing is decided for
// a module as a whole that is not decided for them.
#if GLINT_EMISSIVE_LIGHTS
#define GLINT_DECIDED_ALWAYS_LOBES GLINT_EMITTER_ALWAYS_LOBES
#define GLINT_DECIDED_ALWAYS_INPUTS GLINT_EMITTER_ALWAYS_INPUTS
#define GLINT_DECIDED_ANY_LOBES (GLINT_EMITTER_ALWAYS_LOBES | GLINT_EMITTER_SOMETIMES_LOBES)
#define GLINT_DECIDED_ANY_INPUTS (GLINT_EMITTER_ALWAYS_INPUTS | GLINT_EMITTER_SOMETIMES_INPUTS)
#define GLINT_DECIDED_MODEL GLINT_EMITTER_MODEL
#else
#define GLINT_DECIDED_ALWAYS_LOBES 0xFFFFFFFFu
#define GLINT_DECIDED_ALWAYS_INPUTS 0xFFFFFFFFu
#define GLINT_DECIDED_ANY_LOBES 0u
#define GLINT_DECIDED_ANY_INPUTS 0u
#define GLINT_DECIDED_MODEL GLINT_MODULE_MODEL
#endif

#define hasLobe(features, bit)                                                                                  \
    ((GLINT_MODULE_ALWAYS_LOBES & GLINT_DECIDED_ALWAYS_LOBES & (bit)) != 0u ||                                  \
     (((GLINT_MODULE_ANY_LOBES | GLINT_DECIDED_ANY_LOBES) & (bit)) != 0u && lobeOfKey(features, bit)))
#define hasInput(features, bit)                                                                                 \
    ((GLINT_MODULE_ALWAYS_INPUTS & GLINT_DECIDED_ALWAYS_INPUTS & (bit)) != 0u ||                                \
     (((GLINT_MODULE_ANY_INPUTS | GLINT_DECIDED_ANY_INPUTS) & (bit)) != 0u && inputOfKey(features, bit)))

// Whether all keys of the module, and those of emissive lights, have the same model.
#define GLINT_KNOWS_MODEL (GLINT_MODULE_MODEL != kAnyModel && GLINT_MODULE_MODEL == GLINT_DECIDED_MODEL)
// Whether `number` is that of a model that they may have.
#define GLINT_MAY_BE_MODEL(number)                                                                              \
    (GLINT_MODULE_MODEL == kAnyModel || GLINT_DECIDED_MODEL == kAnyModel ||                                     \
     (GLINT_MODULE_MODEL & kModelNumber) == (number) || (GLINT_DECIDED_MODEL & kModelNumber) == (number))
// Whether it is that of the one model that they have.
#define GLINT_IS_MODEL(number) (GLINT_KNOWS_MODEL && (GLINT_MODULE_MODEL & kModelNumber) == (number))
#define hasOwn(features, model, word, bits)                                                                     \
    ((GLINT_IS_MODEL(model) && (bits) == 0u) ||                                                                 \
     (GLINT_MAY_BE_MODEL(model) && ownOfKey(features, model, word, bits)))

// The word of the key's model, and whether it has all of these bits. These and what asks them below are macros, so that
// what a module decides is known before functions are inlined.
#define GLINT_MODEL_WORD(features) (GLINT_KNOWS_MODEL ? GLINT_MODULE_MODEL : modelOfKey(features))
#define GLINT_MODEL_HAS(features, bits) (GLINT_USES_MODELS != 0 && (GLINT_MODEL_WORD(features) & (bits)) == (bits))

// Whether light changes what the surface shows.
#define isLit(features) (!hasLobe(features, GLINT_UNLIT_LOBES) && !GLINT_MODEL_HAS(features, kModelUnlit))

// Whether the key has a model that a pack declares.
#define isOfPack(features) ((GLINT_MODEL_WORD(features) & kModelNumber) != 0u)

// Whether a model of a pack stands in place of Glint's own base (bsdf/model.glsl).
#define hasModel(features) GLINT_MODEL_HAS(features, kModelOwnCode)

// Whether such a model samples directions itself.
#define samplesModel(features) GLINT_MODEL_HAS(features, kModelSampled)

// Whether the base samples directions itself, as Glint's own does.
#define samplesBase(features) (!hasModel(features) || samplesModel(features))

// Whether the base sends light to the far side.
#define transmits(features)                                                                                     \
    (hasLobe(features, GLINT_BOTH_SIDES_LOBES) || GLINT_MODEL_HAS(features, kModelBothSides))

// Whether any base scatters light there: Bsdf::diffuseTransmitted.
#define scattersBehind(features)                                                                                \
    (passesDiffusely(features) || GLINT_MODEL_HAS(features, kModelOwnCode | kModelBothSides))

// The features of any key of the scene, with all lobes: for primary surfaces.
#define GLINT_PRIMARY_FEATURES(geometry) Features(GLINT_ALL, GLINT_KEY(geometry))

// Returns the features of a hit of a ray, with the lobes that hits keep: for code before the switch.
#define GLINT_HIT_FEATURES(geometry) Features(GLINT_HIT_ALL, GLINT_KEY(geometry))

#include "materials/base/queries.glsl"
