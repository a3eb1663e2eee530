// What a case knows of its keys. `always` and `sometimes` are literals of the case; `lobes` and `inputs` are the key
// of the geometry at hand. Written so that SPIRV-Tools folds every decided bit: a feature that no key of the case has
// leaves no code, one that every key has leaves no branch.
struct Features {
    uint alwaysLobes;
    uint alwaysInputs;
    uint sometimesLobes;
    uint sometimesInputs;
    uint lobes;
    uint inputs;
};

bool hasLobe(Features features, uint bit) {
    return (features.alwaysLobes & bit) != 0u ||
           ((features.sometimesLobes & bit) != 0u && (features.lobes & bit) != 0u);
}

bool hasInput(Features features, uint bit) {
    return (features.alwaysInputs & bit) != 0u ||
           ((features.sometimesInputs & bit) != 0u && (features.inputs & bit) != 0u);
}

// The features of any key of the scene: for code that runs before the switch, or for all materials.
#define GLINT_SCENE_FEATURES(geometry)                                                                          \
    Features(GLINT_ALWAYS_LOBES, GLINT_ALWAYS_INPUTS, GLINT_SOMETIMES_LOBES, GLINT_SOMETIMES_INPUTS,            \
             (geometry).featureLobes, (geometry).featureInputs)
