// Primitives that KHR_draco_mesh_compression packs.
#pragma once

#include "gltf/accessor.h"
#include "gltf/document.h"

#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace draco {
class Mesh;
}

namespace glint::gltf {

class DracoMesh {
public:
    // Decodes what the extension object refers to, which checkCompression() passed. `pointer` is the
    // extension's. Errors: "draco-decode" (with what the decoder said), "draco-size" (a header that claims
    // more than its data can hold), "vertex-limit", those of reading the buffer view.
    static Result<DracoMesh> decode(Document& document, const Json& extension, const std::string& pointer);

    DracoMesh(DracoMesh&& other) noexcept;
    DracoMesh& operator=(DracoMesh&& other) noexcept;
    ~DracoMesh();

    std::size_t pointCount() const;
    // A triangle list; each index is below pointCount().
    const std::vector<std::uint32_t>& indices() const {
        return indices_;
    }
    // The elements of the attribute with that unique identifier, packed tightly in the format that their
    // accessor has. Error "draco-attribute": there is none, or its values have another form.
    Result<Bytes> attribute(const Document& document, std::uint32_t id, const ElementFormat& format,
                            const std::string& pointer) const;

private:
    explicit DracoMesh(std::unique_ptr<draco::Mesh> mesh);

    std::unique_ptr<draco::Mesh> mesh_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace glint::gltf
