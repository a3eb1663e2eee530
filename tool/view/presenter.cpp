#include "view/presenter.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>
#include <optional>

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
    GLINT_TRY_DO(made->createRenderPass());
    GLINT_TRY_DO(made->createFrames());
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
    return checkCall("vkCreateRenderPass",
                     vkCreateRenderPass(context_.handles().device, &info, nullptr, &renderPass_));
}

Status Presenter::createFrames() {
    VkDevice device = context_.handles().device;
    for (InFlight& frame : inFlight_) {
        GLINT_TRY_DO(createCommands(context_, frame.pool, frame.commands));
        VkFenceCreateInfo fence{};
        fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        GLINT_TRY_DO(checkCall("vkCreateFence", vkCreateFence(device, &fence, nullptr, &frame.done)));
        GLINT_TRY_DO(
            checkCall("vkCreateSemaphore", vkCreateSemaphore(device, &semaphore, nullptr, &frame.acquired)));
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
        GLINT_TRY_DO(checkCall("vkCreateImageView", vkCreateImageView(device, &view, nullptr, &image.view)));
        VkFramebufferCreateInfo target{};
        target.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
        target.renderPass = renderPass_;
        target.attachmentCount = 1;
        target.pAttachments = &image.view;
        target.width = extent_.width;
        target.height = extent_.height;
        target.layers = 1;
        GLINT_TRY_DO(checkCall("vkCreateFramebuffer",
                               vkCreateFramebuffer(device, &target, nullptr, &image.framebuffer)));
        VkSemaphoreCreateInfo semaphore{};
        semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        GLINT_TRY_DO(
            checkCall("vkCreateSemaphore", vkCreateSemaphore(device, &semaphore, nullptr, &image.drawn)));
    }
    return okStatus();
}

Status Presenter::createSwapchain() {
    VkDevice device = context_.handles().device;
    VkSurfaceCapabilitiesKHR can{};
    GLINT_TRY_DO(checkCall(
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR",
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context_.handles().physicalDevice, surface_, &can)));
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
    const VkResult result = vkCreateSwapchainKHR(device, &info, nullptr, &made);
    vkDestroySwapchainKHR(device, swapchain_, nullptr);
    swapchain_ = made;
    GLINT_TRY_DO(checkCall("vkCreateSwapchainKHR", result));
    GLINT_TRY_DO(addImages());
    stale_ = false;
    return okStatus();
}

Result<bool> Presenter::begin(Frame& frame) {
    VkDevice device = context_.handles().device;
    InFlight& own = inFlight_[slot_];
    if (own.number > completed_) {
        GLINT_TRY_DO(checkCall("vkWaitForFences", vkWaitForFences(device, 1, &own.done, VK_TRUE, kNoLimit)));
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
    GLINT_TRY_DO(checkCall("vkEndCommandBuffer", vkEndCommandBuffer(frame.commands)));
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
    GLINT_TRY_DO(checkCall("vkQueueSubmit", vkQueueSubmit(context_.handles().queue, 1, &submit, own.done)));
    own.number = ++submitted_;
    VkPresentInfoKHR present{};
    present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    present.waitSemaphoreCount = 1;
    present.pWaitSemaphores = &images_[frame.image].drawn;
    present.swapchainCount = 1;
    present.pSwapchains = &swapchain_;
    present.pImageIndices = &frame.image;
    const VkResult result = vkQueuePresentKHR(context_.handles().queue, &present);
    slot_ = (slot_ + 1) % kFramesInFlight;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        stale_ = true;
        return okStatus();
    }
    return checkCall("vkQueuePresentKHR", result);
}

Status Presenter::waitForFrames() {
    VkDevice device = context_.handles().device;
    for (const InFlight& frame : inFlight_) {
        if (frame.number > completed_) {
            GLINT_TRY_DO(
                checkCall("vkWaitForFences", vkWaitForFences(device, 1, &frame.done, VK_TRUE, kNoLimit)));
        }
    }
    completed_ = submitted_;
    return okStatus();
}

// --- Dear ImGui ---

namespace {

void setLook(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0.0F;
    style.FrameRounding = 3.0F;
    style.GrabRounding = 3.0F;
    style.TabRounding = 3.0F;
    style.WindowBorderSize = 0.0F;
    style.FramePadding = {6.0F, 3.0F};
    style.ItemSpacing = {8.0F, 5.0F};
    style.ScrollbarSize = 12.0F;
    ImVec4* const colors = style.Colors;
    const ImVec4 accent{0.20F, 0.45F, 0.70F, 1.0F};
    colors[ImGuiCol_WindowBg] = {0.13F, 0.13F, 0.14F, 1.0F};
    colors[ImGuiCol_PopupBg] = {0.16F, 0.16F, 0.17F, 0.98F};
    colors[ImGuiCol_FrameBg] = {0.21F, 0.21F, 0.23F, 1.0F};
    colors[ImGuiCol_FrameBgHovered] = {0.27F, 0.27F, 0.30F, 1.0F};
    colors[ImGuiCol_Header] = {0.20F, 0.26F, 0.32F, 1.0F};
    colors[ImGuiCol_HeaderHovered] = {0.24F, 0.33F, 0.42F, 1.0F};
    colors[ImGuiCol_HeaderActive] = accent;
    colors[ImGuiCol_Button] = {0.24F, 0.28F, 0.33F, 1.0F};
    colors[ImGuiCol_ButtonHovered] = {0.27F, 0.38F, 0.49F, 1.0F};
    colors[ImGuiCol_ButtonActive] = accent;
    colors[ImGuiCol_Tab] = {0.18F, 0.20F, 0.23F, 1.0F};
    colors[ImGuiCol_TabHovered] = {0.27F, 0.38F, 0.49F, 1.0F};
    colors[ImGuiCol_TabActive] = accent;
    colors[ImGuiCol_CheckMark] = {0.45F, 0.72F, 1.0F, 1.0F};
    colors[ImGuiCol_SliderGrab] = {0.25F, 0.44F, 0.64F, 1.0F};
    colors[ImGuiCol_SliderGrabActive] = {0.30F, 0.54F, 0.80F, 1.0F};
    style.ScaleAllSizes(scale);
    ImGui::GetIO().FontGlobalScale = scale;
}

}  // namespace

Result<std::unique_ptr<Interface>> Interface::create(Context& context, GLFWwindow* window,
                                                     const Presenter& presenter) {
    std::unique_ptr<Interface> made(new Interface(context));
    GLINT_TRY_DO(made->start(window, presenter));
    return made;
}

Status Interface::start(GLFWwindow* window, const Presenter& presenter) {
    const DeviceHandles& handles = context_.handles();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // leaves no file where it runs
    float scale = 1.0F;
    glfwGetWindowContentScale(window, &scale, nullptr);
    setLook(std::max(scale, 1.0F));
    ImGui_ImplGlfw_InitForVulkan(window, true);
    started_ = true;

    constexpr std::uint32_t kTextures = 16;  // more than Dear ImGui has fonts
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kTextures};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = kTextures;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    GLINT_TRY_DO(
        checkCall("vkCreateDescriptorPool", vkCreateDescriptorPool(handles.device, &pool, nullptr, &pool_)));

    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = handles.instance;
    info.PhysicalDevice = handles.physicalDevice;
    info.Device = handles.device;
    info.QueueFamily = handles.queueFamily;
    info.Queue = handles.queue;
    info.DescriptorPool = pool_;
    info.MinImageCount = Presenter::kFramesInFlight;
    // One set of vertex buffers for each frame that may be in flight, and one more to be safe from reuse.
    info.ImageCount = Presenter::kFramesInFlight + 1;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
#if IMGUI_VERSION_NUM >= 19080
    info.RenderPass = presenter.renderPass();
    ImGui_ImplVulkan_Init(&info);
#else
    ImGui_ImplVulkan_Init(&info, presenter.renderPass());
#endif

#if IMGUI_VERSION_NUM < 19000
    // Older backends leave the upload of the font to the program.
    GLINT_TRY(auto commands, OneTimeCommands::create(context_));
    ImGui_ImplVulkan_CreateFontsTexture(commands.handle());
    GLINT_TRY_DO(commands.submit(context_));
    vkQueueWaitIdle(handles.queue);
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
    return okStatus();
}

Interface::~Interface() {
    VkDevice device = context_.handles().device;
    vkDeviceWaitIdle(device);
    if (pool_ != VK_NULL_HANDLE) {
        ImGui_ImplVulkan_Shutdown();
    }
    if (started_) {
        ImGui_ImplGlfw_Shutdown();
    }
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(device, pool_, nullptr);
}

void Interface::begin() {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Interface::end() {
    ImGui::Render();
}

void Interface::record(VkCommandBuffer commands) {
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

}  // namespace glint::view
