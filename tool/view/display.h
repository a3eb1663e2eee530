// Prepares what the window shows: linear pictures of a renderer become an image with 8 bits that is encoded
// for the display.
#pragma once

#include "view/vulkan.h"

#include <cstdint>
#include <memory>

namespace glint::view {

enum class Shown : std::uint32_t { First, Second, Wipe, Difference, Raw };

// The layout is that of shaders/display.comp.
struct DisplayOptions {
    float scale = 1.0F;  // 2^exposure
    Shown shown = Shown::First;
    float border = 0.5F;  // with Wipe: the share of the width that shows the first picture
    float gain = 8.0F;    // with Difference: factor of the difference of encoded values
    float low = 0.0F;     // with Raw: the values that are shown as black and as white
    float high = 1.0F;
    std::uint32_t channels = 3;  // with Raw: 1 to 4; 1 is shown as grey
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
    const DeviceImage& image() const {
        return image_;
    }

private:
    explicit Display(Context& context) : context_(context) {}
    Status createPipeline();

    // Sets are used in turn, as those of frames in flight must not change.
    static constexpr std::uint32_t kSets = 4;
    Context& context_;
    DeviceImage image_;
    bool fresh_ = true;  // the image has no layout yet
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet sets_[kSets]{};
    std::uint32_t next_ = 0;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace glint::view
