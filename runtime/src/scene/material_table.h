// The textures of material records. A record is bytes that only shaders read, up to its textures.
#pragma once

#include "interop/scene.h"

#include <glint/package.h>

#include <cstring>

namespace glint {

// Returns the offset of a texture of a record, from the start of the table. Requires material < table.size()
// and slot < table.textureCount.
inline std::size_t placeOfTexture(const MaterialTable& table, std::size_t material, std::uint32_t slot) {
    return material * table.recordBytes + table.textureOffset + slot * sizeof(gpu::TextureRecord);
}

inline gpu::TextureRecord textureAt(const MaterialTable& table, std::size_t material, std::uint32_t slot) {
    gpu::TextureRecord record{};
    std::memcpy(&record, &table.bytes[placeOfTexture(table, material, slot)], sizeof record);
    return record;
}

// Returns a table of other records in the same layout.
inline MaterialTable tableWith(const MaterialTable& layout, std::span<const std::uint8_t> records) {
    return {records, layout.recordBytes, layout.textureOffset, layout.textureCount};
}

}  // namespace glint
