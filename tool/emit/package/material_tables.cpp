#include "emit/package/tables.h"

#include <cstring>
#include <interop/scene.h>
#include <map>
#include <utility>

namespace glint::compiler {

using package::TextureEntry;

MaterialTables makeMaterialTables(const gltf::Scene& scene, const MaterialLayout& layout) {
    MaterialTables tables;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> indexOf;
    for (const materials::Material& material : scene.materials) {
        std::vector<std::uint8_t> record = makeMaterialRecord(material, layout);
        for (std::size_t i = 0; i < material.textures.size(); ++i) {
            const materials::TextureInfo& info = material.textures[i];
            if (info.texture < 0) {
                continue;
            }
            // A texture that no key reads is in the tables all the same, so that images keep their numbers.
            const gltf::Texture& texture = scene.textures[static_cast<std::size_t>(info.texture)];
            const TextureEntry entry{static_cast<std::uint32_t>(texture.image),
                                     material.isColor(static_cast<int>(i)) ? 1U : 0U};
            const auto [place, isNew] = indexOf.try_emplace(
                {entry.image, entry.srgb}, static_cast<std::uint32_t>(tables.textures.size()));
            if (isNew) {
                tables.textures.push_back(entry);
            }
            const int slot = layout.slotOf(static_cast<int>(i));
            if (slot < 0) {
                continue;
            }
            std::uint8_t* const target =
                &record[layout.textureOffset + static_cast<std::size_t>(slot) * sizeof(gpu::TextureRecord)];
            gpu::TextureRecord settled{};
            std::memcpy(&settled, target, sizeof settled);
            settled.textureIndex = place->second;
            settled.samplerIndex = static_cast<std::uint32_t>(texture.sampler);
            settled.texCoord = static_cast<std::uint32_t>(info.texCoord);
            std::memcpy(target, &settled, sizeof settled);
        }
        tables.materials.insert(tables.materials.end(), record.begin(), record.end());
    }
    return tables;
}

}  // namespace glint::compiler
