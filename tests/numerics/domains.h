// The inputs of each probe. Each function writes the arguments of one call, in the order in which the probe
// reads them.
#pragma once

#include "inputs.h"

namespace glint::numerics {

// domains_geometry.cpp
void fillDirection(InputSource& in);
void fillDirectionAndSide(InputSource& in);
void fillTransform(InputSource& in);
void fillBinnedDirection(InputSource& in);
void fillScreenRay(InputSource& in);
void fillCounters(InputSource& in);
void fillSumOfProduct(InputSource& in);
void fillProducts(InputSource& in);
void fillDirections(InputSource& in);
void fillVector(InputSource& in);
void fillNormalTransform(InputSource& in);
void fillPlane(InputSource& in);
void fillConeOnPlane(InputSource& in);
void fillFootprint(InputSource& in);
void fillTriangle(InputSource& in);
void fillLight(InputSource& in);
void fillSamples(InputSource& in);

// domains_bsdf.cpp
void fillIor(InputSource& in);
void fillSchlick(InputSource& in);
void fillCriticalAngle(InputSource& in);
void fillInterface(InputSource& in);
void fillLobeNormal(InputSource& in);
void fillLobeNormalAnisotropic(InputSource& in);
void fillLightViewAlpha(InputSource& in);
void fillLightViewAlphas(InputSource& in);
void fillVisibleNormal(InputSource& in);
void fillVisibleNormalPdf(InputSource& in);
void fillSheenDistribution(InputSource& in);
void fillSheenVisibility(InputSource& in);
void fillFilm(InputSource& in);
void fillRefraction(InputSource& in);
void fillRefracted(InputSource& in);
void fillThin(InputSource& in);
void fillVolume(InputSource& in);
void fillDispersion(InputSource& in);
void fillClearcoat(InputSource& in);
void fillCosineAlpha(InputSource& in);
void fillAlpha(InputSource& in);
void fillViewAlphas(InputSource& in);
void fillAlphas(InputSource& in);
void fillCosineSheenAlpha(InputSource& in);
void fillBsdf(InputSource& in);
void fillBsdfReflection(InputSource& in);
void fillBsdfWithoutSheen(InputSource& in);
void fillBsdfSample(InputSource& in);

}  // namespace glint::numerics
