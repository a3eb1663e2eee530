// The word of a key that names a base model which a pack declares: its number, from 1, and what shading has to know of
// it. 0 stands for the bases of glTF.
#ifndef GLINT_INTEROP_MODELS_H
#define GLINT_INTEROP_MODELS_H

#include "interop/types.h"

GLINT_INTEROP_BEGIN

GLINT_CONSTANT(kModelNumber, 0x00FFFFFFu);        // mask
GLINT_CONSTANT(kModelUnlit, 0x01000000u);         // light does not change what the surface shows
GLINT_CONSTANT(kModelBothSides, 0x02000000u);     // it lets light through to the far side
GLINT_CONSTANT(kModelOwnCode, 0x04000000u);       // its GLSL stands in place of glTF's base (bsdf/model.glsl)
GLINT_CONSTANT(kModelSampled, 0x08000000u);       // it samples directions itself
GLINT_CONSTANT(kModelChangesAlpha, 0x10000000u);  // it has code that changes coordinates or opacity
GLINT_CONSTANT(kModelBaseColor, 0x20000000u);     // its records have glTF's base colour, whose alpha counts
// Stands for the models of a case whose keys have several, and which knows nothing about the features of each.
GLINT_CONSTANT(kAnyModel, 0xFFFFFFFFu);

GLINT_INTEROP_END
#endif
