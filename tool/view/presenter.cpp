#include "view/presenter.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <memory>

namespace glint::view {

namespace {

constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

Diagnostic surfaceError(const std::string& message) {
    return makeError("window-surface", "", message, "use another --device, or glint render");
}

// Shaders write values that are encoded for the display, so the format does not encode them once more.
std::optional<VkSurfaceFormatKHR> chooseFormat(VkPhysicalDevice device, VkSurfaceKHR surface) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, formats.data());
    for (const VkSurfaceFormatKHR& format : formats) {
        const bool isPlain =
            format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM;
        if (isPlain && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
            return format;
        }
    }
    return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<Presenter>> Presenter::create(Context& context, GLFWwindow* window) {
    std::unique_ptr<Presenter> made(new Presenter(context, window));
    const DeviceHandles& handles = context.handles();
    if (glfwCreateWindowSurface(handles.instance, window, nullptr, &made->surface_) != VK_SUCCESS) {
        return surfaceError("the driver makes no surface for the window");
    }
    VkBool32 supported = VK_FALSE;
    vkGetPhysicalDeviceSurfaceSupportKHR(handles.physicalDevice, handles.queueFamily, made->surface_,
                                         &supported);
    const std::optional<VkSurfaceFormatKHR> format = chooseFormat(handles.physicalDevice, made->surface_);
    if (supported == VK_FALSE || !format) {
        return surfaceError(context.deviceName() + " can't show pictures in the window");
    }
    made->format_ = *format;
    for (const Status& status : {made->createRenderPass(), made->createFrames()}) {
        if (!status) {
            return status.error();
        }
    }
    return made;
}

Presenter::~Presenter() {
    VkDevice device = context_.handles().device;
    vkDeviceWaitIdle(device);
    destroySwapchain();
    vkDestroySwapchainKHR(device, swapchain_, nullptr);
    for (const InFlight& frame : inFlight_) {
        vkDestroyFence(device, frame.done, nullptr);
        vkDestroySemaphore(device, frame.acquired, nullptr);
        vkDestroyCommandPool(device, frame.pool, nullptr);
    }
    vkDestroyRenderPass(device, renderPass_, nullptr);
    vkDestroySurfaceKHR(context_.handles().instance, surface_, nullptr);
}

Status Presenter::createRenderPass() {
    VkAttachmentDescription target{};
    target.format = format_.format;
    target.samples = VK_SAMPLE_COUNT_1_BIT;
    target.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    target.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    target.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    target.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    target.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    target.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 1;
    info.pAttachments = &target;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    const VkResult result = vkCreateRenderPass(context_.handles().device, &info, nullptr, &renderPass_);
    return result == VK_SUCCESS ? okStatus() : Status(callError("vkCreateRenderPass", result));
}

Status Presenter::createFrames() {
    VkDevice device = context_.handles().device;
    for (InFlight& frame : inFlight_) {
        GLINT_TRY_DO(createCommands(context_, frame.pool, frame.commands));
        VkFenceCreateInfo fence{};
        fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        VkResult result = vkCreateFence(device, &fence, nullptr, &frame.done);
        if (result == VK_SUCCESS) {
            result = vkCreateSemaphore(device, &semaphore, nullptr, &frame.acquired);
        }
        if (result != VK_SUCCESS) {
            return callError("vkCreateFence", result);
        }
    }
    return okStatus();
}

void Presenter::destroySwapchain() {
    VkDevice device = context_.handles().device;
    for (const Image& image : images_) {
        vkDestroyFramebuffer(device, image.framebuffer, nullptr);
        vkDestroyImageView(device, image.view, nullptr);
        vkDestroySemaphore(device, image.drawn, nullptr);
    }
    images_.clear();
}

Status Presenter::addImages() {
    VkDevice device = context_.handles().device;
    std::uint32_t count = 0;
    vkGetSwapchainImagesKHR(device, swapchain_, &count, nullptr);
    std::vector<VkImage> images(count);
    vkGetSwapchainImagesKHR(device, swapchain_, &count, images.data());
    for (VkImage handle : images) {
        Image& image = images_.emplace_back();
        image.handle = handle;
        VkImageViewCreateInfo view{};
        view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        view.image = handle;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format_.format;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        VkResult result = vkCreateImageView(device, &view, nullptr, &image.view);
        if (result != VK_SUCCESS) {
            return callError("vkCreateImageView", result);
        }
        VkFramebufferCreateInfo target{};
        target.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        target.renderPass = renderPass_;
        target.attachmentCount = 1;
        target.pAttachments = &image.view;
        target.width = extent_.width;
        target.height = extent_.height;
        target.layers = 1;
        result = vkCreateFramebuffer(device, &target, nullptr, &image.framebuffer);
        if (result != VK_SUCCESS) {
            return callError("vkCreateFramebuffer", result);
        }
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        result = vkCreateSemaphore(device, &semaphore, nullptr, &image.drawn);
        if (result != VK_SUCCESS) {
            return callError("vkCreateSemaphore", result);
        }
    }
    return okStatus();
}

Status Presenter::createSwapchain() {
    VkDevice device = context_.handles().device;
    VkSurfaceCapabilitiesKHR can{};
    VkResult result =
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context_.handles().physicalDevice, surface_, &can);
    if (result != VK_SUCCESS) {
        return callError("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", result);
    }
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    extent_ = can.currentExtent;
    if (extent_.width == 0xFFFFFFFF) {
        extent_ = {
            std::clamp(static_cast<std::uint32_t>(width), can.minImageExtent.width, can.maxImageExtent.width),
            std::clamp(static_cast<std::uint32_t>(height), can.minImageExtent.height,
                       can.maxImageExtent.height)};
    }
    if (extent_.width == 0 || extent_.height == 0) {
        return okStatus();
    }
    vkDeviceWaitIdle(device);
    destroySwapchain();
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_;
    info.minImageCount = std::max(can.minImageCount, kFramesInFlight);
    info.minImageCount =
        can.maxImageCount > 0 ? std::min(info.minImageCount, can.maxImageCount) : info.minImageCount;
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    result = vkCreateSwapchainKHR(device, &info, nullptr, &made);
    vkDestroySwapchainKHR(device, swapchain_, nullptr);
    swapchain_ = made;
    if (result != VK_SUCCESS) {
        return callError("vkCreateSwapchainKHR", result);
    }
    GLINT_TRY_DO(addImages());
    stale_ = false;
    return okStatus();
}

Result<bool> Presenter::begin(Frame& frame) {
    VkDevice device = context_.handles().device;
    InFlight& own = inFlight_[slot_];
    if (own.number > completed_) {
        const VkResult waited = vkWaitForFences(device, 1, &own.done, VK_TRUE, kNoLimit);
        if (waited != VK_SUCCESS) {
            return callError("vkWaitForFences", waited);
        }
        completed_ = own.number;
    }
    if (stale_) {
        GLINT_TRY_DO(createSwapchain());
        if (stale_) {
            return false;
        }
    }
    const VkResult acquired =
        vkAcquireNextImageKHR(device, swapchain_, kNoLimit, own.acquired, VK_NULL_HANDLE, &frame.image);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        stale_ = true;
        return false;
    }
    if (acquired != VK_SUCCESS && acquired != VK_SUBOPTIMAL_KHR) {
        return callError("vkAcquireNextImageKHR", acquired);
    }
    stale_ = acquired == VK_SUBOPTIMAL_KHR;
    vkResetCommandPool(device, own.pool, 0);
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vkBeginCommandBuffer(own.commands, &info);
    frame.commands = own.commands;
    return true;
}

void Presenter::beginDrawing(const Frame& frame, const DeviceImage* picture, const Area& area) {
    VkImage window = images_[frame.image].handle;
    recordLayout(frame.commands, window, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkClearColorValue clear{{0.09F, 0.09F, 0.10F, 1.0F}};
    constexpr VkImageSubresourceRange kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(frame.commands, window, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &clear, 1, &kWhole);
    const int right = std::min(area.x + area.width, static_cast<int>(extent_.width));
    const int bottom = std::min(area.y + area.height, static_cast<int>(extent_.height));
    if (picture != nullptr && right > area.x && bottom > area.y) {
        recordBarrier(frame.commands);
        // While the window shrinks, the area may reach beyond it.
        const int width = (right - area.x) * static_cast<int>(picture->width) / area.width;
        const int height = (bottom - area.y) * static_cast<int>(picture->height) / area.height;
        VkImageBlit blit{};
        blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        blit.srcOffsets[1] = {std::max(width, 1), std::max(height, 1), 1};
        blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        blit.dstOffsets[0] = {area.x, area.y, 0};
        blit.dstOffsets[1] = {right, bottom, 1};
        vkCmdBlitImage(frame.commands, picture->image, VK_IMAGE_LAYOUT_GENERAL, window,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
    }
    recordLayout(frame.commands, window, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = renderPass_;
    info.framebuffer = images_[frame.image].framebuffer;
    info.renderArea.extent = extent_;
    vkCmdBeginRenderPass(frame.commands, &info, VK_SUBPASS_CONTENTS_INLINE);
}

Status Presenter::end(const Frame& frame) {
    VkDevice device = context_.handles().device;
    InFlight& own = inFlight_[slot_];
    vkCmdEndRenderPass(frame.commands);
    VkResult result = vkEndCommandBuffer(frame.commands);
    if (result != VK_SUCCESS) {
        return callError("vkEndCommandBuffer", result);
    }
    vkResetFences(device, 1, &own.done);
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.waitSemaphoreCount = 1;
    submit.pWaitSemaphores = &own.acquired;
    submit.pWaitDstStageMask = &stage;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &own.commands;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &images_[frame.image].drawn;
    result = vkQueueSubmit(context_.handles().queue, 1, &submit, own.done);
    if (result != VK_SUCCESS) {
        return callError("vkQueueSubmit", result);
    }
    own.number = ++submitted_;
    VkPresentInfoKHR present{};
    present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    present.waitSemaphoreCount = 1;
    present.pWaitSemaphores = &images_[frame.image].drawn;
    present.swapchainCount = 1;
    present.pSwapchains = &swapchain_;
    present.pImageIndices = &frame.image;
    result = vkQueuePresentKHR(context_.handles().queue, &present);
    slot_ = (slot_ + 1) % kFramesInFlight;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        stale_ = true;
        return okStatus();
    }
    return result == VK_SUCCESS ? okStatus() : Status(callError("vkQueuePresentKHR", result));
}

Status Presenter::waitForFrames() {
    VkDevice device = context_.handles().device;
    for (const InFlight& frame : inFlight_) {
        if (frame.number > completed_) {
            const VkResult result = vkWaitForFences(device, 1, &frame.done, VK_TRUE, kNoLimit);
            if (result != VK_SUCCESS) {
                return callError("vkWaitForFences", result);
            }
        }
    }
    completed_ = submitted_;
    return okStatus();
}

}  // namespace glint::view
