#include "scene.h"

namespace gallery {

glint::Status writeGallery(const std::filesystem::path& folder) {
    GltfWriter writer;
    const MaterialSet materials = addMaterials(writer);
    addRoom(writer, materials);
    addExhibits(writer, materials);
    addShowcase(writer, materials);
    addLightsAndCameras(writer);
    return writer.write(folder, "gallery");
}

}  // namespace gallery
