// Textures whose finer levels reach the device while frames are drawn. docs/textures.md, "Streaming".
#pragma once

#include <glint/result.h>

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>

namespace glint {

// Brings the levels of a scene's textures that the upload has left out (SceneView::streamsTextures), the
// coarsest first. Frames read the levels that were there when they were recorded. Nothing waits for the
// device. Textures have the numbers of PackageScene::textures, or TextureHandle::index in a scene that is
// edited.
//
// The functions may not be called at the same time as each other, SceneEditor's or Renderer::record().
class TextureStream {
public:
    ~TextureStream();
    TextureStream(const TextureStream&) = delete;
    TextureStream& operator=(const TextureStream&) = delete;

    // Records copies of about `mostBytes` bytes, and at least one row of blocks if something waits.
    // `commands` is a command buffer of the caller's, in the recording state and outside a render pass.
    // Recordings from then on read the levels that are complete. GpuScene::descriptorSet() is then another
    // one, and accumulated pictures should start anew if the result is above 0. In a scene that is edited the
    // next SceneEditor::record() takes them over. `frame` is the caller's number of the frame that the
    // commands belong to; it may not fall. The commands must be submitted, in the order of their recording.
    // Returns how many levels were completed. Has the errors of memory and Vulkan's calls, and "stream-frame"
    // (the number has fallen); nothing is then recorded.
    Result<std::uint32_t> record(VkCommandBuffer commands, std::uint64_t frame,
                                 std::uint64_t mostBytes = std::uint64_t{8} << 20);
    // Says that the device has completed all commands of frames up to `frame`, and frees the resources that
    // they alone used.
    void complete(std::uint64_t frame);

    // Leaves out levels finer than `level` of a texture, until another call asks for them. Levels that are on
    // the device stay. A number that names no texture changes nothing.
    void setFinest(std::uint32_t texture, std::uint32_t level);
    // Returns the finest level that new frames read: 0 for a texture that does not stream.
    std::uint32_t finest(std::uint32_t texture) const;

    struct Progress {
        std::uint32_t textures = 0;  // with levels that setFinest() allows and that are not there
        std::uint64_t bytes = 0;     // of these levels
    };
    Progress progress() const;
    // Returns how many bytes wait for complete().
    std::uint64_t retiredBytes() const;

    struct State;  // for the runtime's own sources
    State& state();
    explicit TextureStream(std::unique_ptr<State> state);

private:
    std::unique_ptr<State> state_;
};

}  // namespace glint
