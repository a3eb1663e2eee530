// The functions of glTF 2.0, appendix B.3, and of the material extensions, as their texts write them. Vectors
// are unit vectors in a frame whose z is the normal and whose x is the direction of anisotropy; they point
// away from the surface.
#pragma once

#include "oracle/spec/material.h"

namespace glint::spec {

// How masking and shadowing go together. Appendix B.3.2 writes the separable product of two Smith terms;
// KHR_materials_anisotropy and the sample viewer have the height-correlated form (Heitz 2014), and so does
// Glint.
enum class Masking : std::uint8_t { HeightCorrelated, Separable };

// Trowbridge-Reitz: appendix B.3.2; with two alphas: D_GGX_anisotropic of KHR_materials_anisotropy.
double distribution(const Vec3& h, const Vec2& alpha);
// G / (4 |n·l| |n·v|). Cosines count without their sign, as the transmission texts write them.
double visibility(const Vec3& l, const Vec3& v, const Vec2& alpha, Masking masking);
// Smith's masking of one direction.
double masking(const Vec3& v, const Vec2& alpha);

// (1 - |cosine|)⁵: appendix B.3.4.
double schlickWeight(double cosine);
// F0 of KHR_materials_ior, against air.
double reflectanceOfIor(double ior);
// Index of refraction of KHR_materials_dispersion for red, green and blue.
Vec3 dispersedIors(double ior, double dispersion);

// KHR_materials_iridescence, "Iridescence Fresnel": the reflectance of a film over a base of that F0.
Vec3 filmFresnel(double filmIor, const Vec3& baseF0, double thickness, double cosine);

// KHR_materials_sheen, "Sheen distribution" and "Sheen visibility"; alpha is sheenRoughness².
double sheenDistribution(double cosine, double alpha);
double sheenVisibility(double lightCosine, double viewCosine, double alpha);

double largest(const Vec3& v);

}  // namespace glint::spec
