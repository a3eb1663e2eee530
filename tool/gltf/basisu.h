// KTX2 images (KHR_texture_basisu), which take a library that not every build has.
#pragma once

namespace glint::gltf {

// Whether this build decodes KTX2 images: whether libktx was there when it was configured.
bool hasBasisu();

// What to do where it does not.
inline constexpr const char* kBasisuHint =
    "install libktx (KTX-Software 4, https://github.com/KhronosGroup/KTX-Software/releases) and configure "
    "and "
    "build Glint again, or store the image as PNG, JPEG or WebP";

}  // namespace glint::gltf
