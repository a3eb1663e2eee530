// Prepares the image that the window shows: linear pictures of a renderer become an image with 8 bits that is
// encoded for the display.
#pragma once

#include "image/png.h"
#include "view/vulkan.h"

#include <cstdint>
#include <memory>

namespace glint::view {

enum class Shown : std::uint32_t { First, Second, Wipe, Difference };
inline constexpr std::uint32_t kShownCount = 4;

// The layout is that of shaders/display.comp.
struct DisplayOptions {
    float scale = 1.0F;  // 2^exposure
    Shown shown = Shown::First;
    float border = 0.5F;  // with Wipe: the share of the width that shows the first picture
    float gain = 8.0F;    // with Difference: factor of the difference of encoded values
};

class Display {
public:
    static Result<std::unique_ptr<Display>> create(Context& context);
    ~Display();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    // Makes the image anew if it has another size; no frame may be in flight then. Returns whether it did.
    Result<bool> resize(std::uint32_t width, std::uint32_t height);
    // Records the pass. The views are of images of RGBA in 32-bit float, in the layout GENERAL; `second` may
    // be null unless it is shown. The pass waits for all commands before it, and all after it for the pass.
    void record(VkCommandBuffer commands, VkImageView first, VkImageView second,
                const DisplayOptions& options);
    // Keeps a picture of the host's, which is encoded for the display, for recordCopy(). No frame may be in
    // flight.
    Status keep(const image::DisplayImage& picture);
    // Records that the image shows the kept picture, with the same dependencies. Returns false, and records
    // nothing, if there is none of the image's size.
    bool recordCopy(VkCommandBuffer commands);
    const DeviceImage& image() const {
        return image_;
    }

private:
    explicit Display(Context& context) : context_(context) {}
    Status createPipeline();
    void prepare(VkCommandBuffer commands);

    // Sets are used in turn, because the sets of frames in flight must not change.
    static constexpr std::uint32_t kSets = 4;
    Context& context_;
    DeviceImage image_;
    HostBuffer kept_;
    std::uint32_t keptWidth_ = 0;  // pixels
    std::uint32_t keptHeight_ = 0;
    bool fresh_ = true;  // the image has no layout yet
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet sets_[kSets]{};
    std::uint32_t next_ = 0;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace glint::view
