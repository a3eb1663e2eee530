#include "gltf/document/elements.h"

#include <string>
#include <utility>

namespace glint::gltf {

namespace {

ComponentType componentTypeOf(const Json& json) {
    return static_cast<ComponentType>(json["componentType"].get<std::uint16_t>());
}

std::size_t offsetOf(const Json& json) {
    return static_cast<std::size_t>(sizeMember(json, "byteOffset"));
}

Accessor::Sparse readSparse(const Json& json) {
    const Json& indices = json["indices"];
    const Json& values = json["values"];
    return {json["count"].get<std::size_t>(), indices["bufferView"].get<int>(), offsetOf(indices),
            componentTypeOf(indices),         values["bufferView"].get<int>(),  offsetOf(values)};
}

}  // namespace

std::size_t sizeOf(ComponentType type) {
    switch (type) {
        case ComponentType::Byte:
        case ComponentType::UnsignedByte:
            return 1;
        case ComponentType::Short:
        case ComponentType::UnsignedShort:
            return 2;
        default:
            return 4;
    }
}

BufferView readBufferView(const Json& json) {
    return {json["buffer"].get<int>(), sizeMember(json, "byteOffset"), sizeMember(json, "byteLength"),
            static_cast<std::size_t>(sizeMember(json, "byteStride"))};
}

Accessor readAccessor(const Json& json) {
    Accessor accessor;
    accessor.bufferView = indexMember(json, "bufferView");
    accessor.offset = offsetOf(json);
    accessor.componentType = componentTypeOf(json);
    accessor.count = json["count"].get<std::size_t>();
    // "SCALAR", "VEC3", "MAT4"
    const std::string& type = json["type"].get_ref<const std::string&>();
    const auto width = static_cast<std::size_t>(type.back() - '0');
    accessor.isMatrix = type.starts_with("MAT");
    accessor.components = type == "SCALAR" ? 1 : accessor.isMatrix ? width * width : width;
    accessor.normalized = boolMember(json, "normalized", false);
    if (const Json* const sparse = find(json, "sparse")) {
        accessor.sparse = readSparse(*sparse);
    }
    return accessor;
}

}  // namespace glint::gltf
