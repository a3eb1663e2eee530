// Settings of an import.
#pragma once

#include "base/memo.h"
#include "materials/material_model.h"

#include <cstdint>
#include <string>

namespace glint::gltf {

struct ImportOptions {
    // Whether to decode images. The compiler needs none of them, and the renderer needs all.
    bool decodeImages = false;
    // Whether to keep the files of images (Image::file). session::loadTextures() then reads them in the
    // formats of a device, on all cores.
    bool keepImageFiles = false;
    // Whether to look at every texel, so that planning knows what textures hold (TextureInfo::content,
    // Primitive::seen), and to change the scene by it: a texture that is constant wherever its material is
    // used is multiplied into the parameters that it scales, and textures with equal texels are one. Textures
    // must then not be replaced at run time by others that hold more.
    bool trustTextures = false;
    // Keeps what was found in textures; null: they are read each time. `memoScope` is part of the keys: it
    // must differ between programs that may find other things.
    base::Memo* memo = nullptr;
    std::string memoScope{};
    int jobs = 0;  // threads that read textures; 0: one for each core
    // These limits keep hostile files from using up the machine's memory.
    std::uint64_t maxVertices = 1ULL << 28;  // over all accessors
    std::uint64_t maxFileBytes = 1ULL << 32;
    int maxImageSize = 16384;  // pixels, for width and for height
    // Refuses symbolic links that lead out of the scene's folder. They are followed by default, because build
    // systems give each action a folder of links. Set this for scenes by strangers: nothing outside the
    // folder is then read.
    bool strictPaths = false;
    // The scene of the file that is read: its number, from 0, or its name. An empty text selects the file's
    // default, which is its first scene if it names none, and all nodes if it has no scenes.
    std::string scene{};
    // The name of the variant (KHR_materials_variants) whose materials are used. An empty name selects the
    // default materials.
    std::string variant{};
    // The features of materials: loadMaterialModel() adds features of a user's own. It must outlive the
    // scene.
    const materials::MaterialModel* materialModel = &materials::builtinMaterialModel();
};

}  // namespace glint::gltf
