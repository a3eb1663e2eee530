// KTX2 images (KHR_texture_basisu), which take sources that not every build has.
#pragma once

namespace glint::gltf {

// Whether this build decodes KTX2 images: whether the transcoder of Basis Universal was there when it was
// configured.
bool hasBasisu();

// What to do where it does not.
inline constexpr const char* kBasisuHint =
    "run scripts/setup.sh, which fetches the transcoder of Basis Universal, and build Glint again; or store "
    "the image as PNG, JPEG or WebP";

}  // namespace glint::gltf
