// Shows frames in a window: a swapchain, and two frames in flight.
#pragma once

#include "view/vulkan.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

struct GLFWwindow;

namespace glint::view {

class Presenter {
public:
    static constexpr std::uint32_t kFramesInFlight = 2;

    // `context` and `window` must outlive the presenter. Error "window-surface" if the device can't show
    // pictures in the window.
    static Result<std::unique_ptr<Presenter>> create(Context& context, GLFWwindow* window);
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    // A frame that is being recorded.
    struct Frame {
        VkCommandBuffer commands = VK_NULL_HANDLE;
        std::uint32_t image = 0;
    };
    // Waits until the frame before the last is complete and begins the next one. Returns false where there is
    // nothing to draw on: the window is minimised, or its size is just changing.
    Result<bool> begin(Frame& frame);
    // A rectangle of the window, in pixels of the framebuffer.
    struct Area {
        int x = 0;
        int y = 0;
        int width = 0;
        int height = 0;
    };
    // Clears the window, copies `picture`, which is in the layout GENERAL, to `area`, and begins to draw. It
    // may be null. The commands that write the picture have to be recorded before, with a barrier after them.
    void beginDrawing(const Frame& frame, const DeviceImage* picture, const Area& area);
    // Submits and shows the frame.
    Status end(const Frame& frame);

    // Frames that were submitted, and those that the device has completed.
    std::uint64_t submitted() const {
        return submitted_;
    }
    std::uint64_t completed() const {
        return completed_;
    }
    // Waits until all submitted frames are complete.
    Status waitForFrames();
    // Makes the next frame make the swapchain anew.
    void sizeChanged() {
        stale_ = true;
    }
    VkRenderPass renderPass() const {
        return renderPass_;
    }

private:
    Presenter(Context& context, GLFWwindow* window) : context_(context), window_(window) {}
    Status createRenderPass();
    Status createFrames();
    Status createSwapchain();
    // Adds what is drawn to for each image of the swapchain.
    Status addImages();
    void destroySwapchain();

    struct InFlight {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence done = VK_NULL_HANDLE;
        VkSemaphore acquired = VK_NULL_HANDLE;
        std::uint64_t number = 0;  // of the last frame that was submitted with it; 0: none
    };
    struct Image {
        VkImage handle = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkSemaphore drawn = VK_NULL_HANDLE;
    };

    Context& context_;
    GLFWwindow* window_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format_{};
    VkRenderPass renderPass_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
    std::array<InFlight, kFramesInFlight> inFlight_{};
    std::vector<Image> images_;
    std::uint32_t slot_ = 0;
    std::uint64_t submitted_ = 0;
    std::uint64_t completed_ = 0;
    bool stale_ = true;
};

// --- Dear ImGui in the window: its context, its look, and the draws of its panels ---

class Interface {
public:
    // Callbacks of the window that were set before are called by those of Dear ImGui. Everything given must
    // outlive it. Error "vulkan-call".
    static Result<std::unique_ptr<Interface>> create(Context& context, GLFWwindow* window,
                                                     const Presenter& presenter);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    // Begins the panels of a frame, between which ImGui's functions may be called.
    void begin();
    // Ends them. record() then draws them.
    void end();
    void record(VkCommandBuffer commands);

private:
    explicit Interface(Context& context) : context_(context) {}
    Status start(GLFWwindow* window, const Presenter& presenter);

    Context& context_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    bool started_ = false;
};

}  // namespace glint::view
