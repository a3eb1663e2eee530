// What Glint's own base does for a key. Shaders outside of materials/ ask these questions and do not know the features
// behind them. They are macros, as hasLobe() is, so that what a module decides is known before functions are inlined.

// Whether light passes the microfacets: Base::transmitted.
#define passesFacets(features) hasLobe(features, GLINT_TRANSMISSION)
#define passesFacetsOfKey(features) lobeOfKey(features, GLINT_TRANSMISSION)

// Whether a diffuse lobe sends light to the far side.
#define passesDiffusely(features) hasLobe(features, GLINT_DIFFUSE_TRANSMISSION)

// Whether the surface bounds a medium, whose index bends light: Base::eta. Without one it is a thin wall.
#define boundsMedium(features) hasLobe(features, GLINT_VOLUME)

// Whether this medium absorbs light.
#define boundsAbsorber(features) hasLobe(features, GLINT_ATTENUATION)
#define boundsAbsorberOfKey(features) lobeOfKey(features, GLINT_ATTENUATION)

// Whether red, green and blue light have indices of their own.
#define dispersesLight(features) hasLobe(features, GLINT_DISPERSION)

// Whether the microfacets have two alphas.
#define isAnisotropic(features) hasLobe(features, GLINT_ANISOTROPY)

// Whether the base is part metal, part dielectric.
#define hasBothBases(features) hasInput(features, GLINT_PARTIAL_METAL)

// The lobes that refracted rays read of an interface. Coats and sheen of inner surfaces are left out, and absorption
// counts over real distances. Inputs that have bits of the lobes' word stay.
#define GLINT_INTERFACE_LOBES                                                                                   \
    (GLINT_UNLIT_LOBES | GLINT_SPECULAR_GLOSSINESS | GLINT_IOR | GLINT_SPECULAR | GLINT_ANISOTROPY |            \
     GLINT_IRIDESCENCE | GLINT_TRANSMISSION | GLINT_DIFFUSE_TRANSMISSION | GLINT_VOLUME | GLINT_DISPERSION |    \
     ~GLINT_LOBES)
