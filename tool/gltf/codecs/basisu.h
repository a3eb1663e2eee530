// Tells whether KTX2 images (KHR_texture_basisu) can be decoded. Not every build has the sources that this
// needs.
#pragma once

namespace glint::gltf {

// Returns whether this build decodes KTX2 images, that is, whether the transcoder of Basis Universal was
// present at configuration.
bool hasBasisu();

// Tells users what to do in a build that does not.
inline constexpr const char* kBasisuHint =
    "run scripts/setup.sh, which fetches the transcoder of Basis Universal, and build Glint again; or store "
    "the image as PNG, JPEG or WebP";

}  // namespace glint::gltf
