#include "scene.h"

namespace gallery {

glint::Status writeGallery(const std::filesystem::path& folder, TimeOfDay time) {
    GltfWriter writer;
    const MaterialSet materials = addMaterials(writer);
    addRoom(writer, materials);
    addExhibits(writer, materials);
    addShowcase(writer, materials);
    addLightsAndCameras(writer, time);
    if (time == TimeOfDay::Noon) {
        return writer.write(folder, "gallery");
    }
    const glint::Result<std::vector<std::uint8_t>> sky = encodeHdr(eveningSky());
    if (!sky) {
        return sky.error();
    }
    const glint::Status written = writer.write(folder, "evening");
    return written ? writeBytes(folder / "evening.hdr", *sky) : written;
}

}  // namespace gallery
