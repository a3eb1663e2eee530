// A record with one value and two textures, as tests/unit/runtime/package_builder.h has it.
struct MaterialRecord {
    float roughnessFactor;
    TextureRecord textures[2];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MaterialArray { MaterialRecord data[]; };
const uint kBaseColorTexture = 0u;
