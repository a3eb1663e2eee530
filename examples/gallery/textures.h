// The images of the scene. Colours are sRGB-encoded; metallic-roughness images hold occlusion in red,
// roughness in green and metalness in blue.
#pragma once

#include "image.h"

namespace gallery {

// An opaque colour.
inline glm::vec4 rgb(float r, float g, float b) {
    return {r, g, b, 1.0F};
}

// Surfaces (surface_textures.cpp). All of them repeat.
Image floorColor();  // four tiles a side, chequered
Image floorMetallicRoughness();
Image brickColor();
Image brickOcclusionRoughnessMetallic();
Image brickNormal();
Image plasterColor();
Image plasterNormal();
Image woodColor();  // grain along u
Image woodMetallicRoughness();
Image marbleColor();
Image waterNormal();
Image brushedMetallicRoughness();  // strokes along u
Image brushedNormal();
Image hammeredNormal();
Image canvasNormal();

// Motifs (motif_textures.cpp): pictures with an up and a right direction.
Image vaseColor();
Image vaseMetallicRoughness();
Image globeColor();
Image globeMetallicRoughness();
Image globeEmissive();
Image screenColor();   // alpha cuts out leaves
Image lanternColor();  // alpha cuts out round holes
Image lanternEmissive();
Image lampColor();
Image signColor();
Image signEmissive();
Image paintingColor();
Image footOcclusion();  // darker towards the foot and the edges

// Textures of material extensions (layered_textures.cpp). The channels are those of the extensions.
Image carbonNormal();
Image lacquerCoat();          // factor in red, roughness in green
Image peelNormal();           // the peel of an orange
Image velvetSheen();          // colour, roughness in alpha
Image amberThickness();       // in green
Image roundelColor();         // coloured glass in lead
Image roundelTransmission();  // in red
Image oilFilm();              // factor in red, thickness in green
Image porcelainSpecular();    // colour, factor in alpha
Image turnedAnisotropy();     // direction in red and green, strength in blue
Image paperTransmission();    // colour, factor in alpha
Image celadonColor();
Image celadonSpecularGlossiness();  // specular colour, glossiness in alpha

}  // namespace gallery
