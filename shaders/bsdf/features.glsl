#include "generated/features.glsl"
#include "generated/scene.glsl"

// The features that a case knows about its keys. `always` and `sometimes` are literals of the case; `lobes` and
// `inputs` are the key of the geometry at hand. The functions are written so that SPIRV-Tools folds every decided bit:
// a feature that no key of the case has leaves no code, and one that every key has leaves no branch.
struct Features {
    uint alwaysLobes;
    uint alwaysInputs;
    uint sometimesLobes;
    uint sometimesInputs;
    uint lobes;
    uint inputs;
};

bool lobeOfKey(Features features, uint bit) {
    return (features.alwaysLobes & bit) != 0u ||
           ((features.sometimesLobes & bit) != 0u && (features.lobes & bit) != 0u);
}

bool inputOfKey(Features features, uint bit) {
    return (features.alwaysInputs & bit) != 0u ||
           ((features.sometimesInputs & bit) != 0u && (features.inputs & bit) != 0u);
}

// The features that all cases of the module have, and those that any has. A module that defines them before it includes
// this file compiles several times faster, because code of decided features is removed before functions are inlined.
#ifndef GLINT_MODULE_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_LOBES 0u
#define GLINT_MODULE_ALWAYS_INPUTS 0u
#define GLINT_MODULE_ANY_LOBES 0xFFFFFFFFu
#define GLINT_MODULE_ANY_INPUTS 0xFFFFFFFFu
#endif

// Every module also evaluates the emission of emissive lights, whichever case they belong to. So nothing is decided for
// a module as a whole that is not decided for them.
#if GLINT_EMISSIVE_LIGHTS
#define GLINT_DECIDED_ALWAYS_LOBES GLINT_EMITTER_ALWAYS_LOBES
#define GLINT_DECIDED_ALWAYS_INPUTS GLINT_EMITTER_ALWAYS_INPUTS
#define GLINT_DECIDED_ANY_LOBES (GLINT_EMITTER_ALWAYS_LOBES | GLINT_EMITTER_SOMETIMES_LOBES)
#define GLINT_DECIDED_ANY_INPUTS (GLINT_EMITTER_ALWAYS_INPUTS | GLINT_EMITTER_SOMETIMES_INPUTS)
#else
#define GLINT_DECIDED_ALWAYS_LOBES 0xFFFFFFFFu
#define GLINT_DECIDED_ALWAYS_INPUTS 0xFFFFFFFFu
#define GLINT_DECIDED_ANY_LOBES 0u
#define GLINT_DECIDED_ANY_INPUTS 0u
#endif

#define hasLobe(features, bit)                                                                                  \
    ((GLINT_MODULE_ALWAYS_LOBES & GLINT_DECIDED_ALWAYS_LOBES & (bit)) != 0u ||                                  \
     (((GLINT_MODULE_ANY_LOBES | GLINT_DECIDED_ANY_LOBES) & (bit)) != 0u && lobeOfKey(features, bit)))
#define hasInput(features, bit)                                                                                 \
    ((GLINT_MODULE_ALWAYS_INPUTS & GLINT_DECIDED_ALWAYS_INPUTS & (bit)) != 0u ||                                \
     (((GLINT_MODULE_ANY_INPUTS | GLINT_DECIDED_ANY_INPUTS) & (bit)) != 0u && inputOfKey(features, bit)))

// Returns whether light changes what the surface shows.
bool isLit(Features features) {
    return !hasLobe(features, GLINT_UNLIT_LOBES);
}

// Returns whether a model of a pack stands in place of glTF's base (bsdf/model.glsl).
bool hasModel(Features features) {
    return hasLobe(features, GLINT_MODEL_LOBES);
}

// Returns whether the base sends light to the far side.
bool transmits(Features features) {
    return hasLobe(features, GLINT_BOTH_SIDES_LOBES);
}

// Returns whether it scatters light there: Bsdf::diffuseTransmitted.
bool scattersBehind(Features features) {
    return hasLobe(features, GLINT_DIFFUSE_TRANSMISSION | (GLINT_MODEL_LOBES & GLINT_BOTH_SIDES_LOBES));
}

// The features of any key of the scene, with all lobes: for primary surfaces.
#define GLINT_PRIMARY_FEATURES(geometry)                                                                        \
    Features(GLINT_ALWAYS_LOBES, GLINT_ALWAYS_INPUTS, GLINT_SOMETIMES_LOBES, GLINT_SOMETIMES_INPUTS,            \
             (geometry).featureLobes, (geometry).featureInputs)

// Returns the features of a hit of a ray, with the lobes that hits keep: for code before the switch.
#define GLINT_HIT_FEATURES(geometry)                                                                            \
    Features(GLINT_HIT_ALWAYS_LOBES, GLINT_HIT_ALWAYS_INPUTS, GLINT_HIT_SOMETIMES_LOBES,                        \
             GLINT_HIT_SOMETIMES_INPUTS, (geometry).featureLobes, (geometry).featureInputs)
